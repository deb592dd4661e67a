#pragma once
#include <cstdlib>
#include <optional>
#include <string>

#include "file.h"
#include "temporary_folder.h"

namespace voxref::testing {

/// The DOM after a headless browser ran a page, with a further script at its end; none without chromium. The page's
/// root element says data-state="ready" where it came through without a script error, "failed" where not.
/// @param fragment what follows # in the address: the mode that the page opens in
inline std::optional<std::string> run_in_browser(const std::string& page, const std::string& script,
                                                 const std::string& fragment) {
  if (std::system("chromium --version >/dev/null 2>&1") != 0) return std::nullopt;
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "report.html", dump = folder.path / "dom.html";
  write_text(file, page + "<script>" + script + "</script>");
  const std::string command =
      "chromium --headless --no-sandbox --disable-gpu --disable-background-networking --user-data-dir=" +
      (folder.path / "profile").string() + " --virtual-time-budget=5000 --dump-dom 'file://" + file.string() + "#" +
      fragment + "' >" + dump.string() + " 2>/dev/null";
  if (std::system(command.c_str()) != 0) return "chromium failed";
  return read_file(dump);
}

/// Presses every key that the page knows, moves wheel and pointer, and ends in mode `b`, above the middle pixel.
inline constexpr const char* use_everything = R"(
    setTimeout(() => {
      const press = (key, shiftKey = false) => document.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey }));
      for (const key of "123456 [ ]eEdDrlt+-0=") press(key);
      for (const mode of "13")
        for (const key of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"]) [press(mode), press(key), press(key, true)];
      const box = document.getElementById("canvas").getBoundingClientRect();
      const at = { clientX: box.left + box.width / 2, clientY: box.top + box.height / 2 };
      document.getElementById("canvas").dispatchEvent(new WheelEvent("wheel", { deltaY: -800, ...at }));
      for (const key of ["2", "0", "r", "e", "e", "4"]) press(key);
      document.getElementById("canvas").dispatchEvent(new PointerEvent("pointermove", at));
    }, 1000);)";

}  // namespace voxref::testing
