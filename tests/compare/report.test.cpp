#include "compare/report.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "catch.h"
#include "compare/browser.h"
#include "compare/synthetic.h"
#include "file.h"
#include "image/image_file.h"
#include "temporary_folder.h"

using voxref::CheckReport;
using voxref::Image;
using voxref::testing::add_noise;
using voxref::testing::cone_image;
using voxref::testing::path_image;
using voxref::testing::run_in_browser;
using voxref::testing::use_everything;
using voxref::testing::wavy;

namespace {

CheckReport report_of(const Image& cone, const Image& path) {
  const float exposure = voxref::auto_exposure(path);
  return {
      "cornell_box_point.gltf",
      cone,
      path,
      compare(cone, path, true, exposure),
      exposure,
      0.25,
      {{"mean", {0.3, 0.2, 0.3}},
       {"seconds",
        {{"voxelize", 0.41}, {"shade", 0.02}, {"mipmap", 0.08}, {"bounce", 1.3}, {"cone_trace", 2.2}, {"total", 4.01}}},
       {"bytes", {{"surfaces", 1200000}, {"base", 2400000}, {"levels", 4100000}, {"total", 7700000}}},
       {"voxels_occupied", 31415}},
      {{"mean", {0.3, 0.2, 0.3}}, {"spp", 64}, {"seconds", 12.5}},
      {{"version", "0.1.0"},
       {"command_line", "voxref check \"scenes/<a> & 'b'.gltf\" -o out"},
       {"scene_sha256", std::string(64, 'a')},
       {"settings", {{"grid", {{"resolution", 128}}}, {"cone", {{"step", 0.5}}}}},
       {"seed", 0}}};
}

/// The start tags that nothing closes, and the end tags that nothing opened, of a page without optional ones.
std::vector<std::string> unbalanced(const std::string& html) {
  std::vector<std::string> open, wrong;
  for (size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const bool end = html[at + 1] == '/';
    const size_t first = at + (end ? 2 : 1);
    const std::string name = html.substr(first, html.find_first_of(" >\n", first) - first);
    static constexpr std::array<const char*, 3> without_end = {"meta", "input", "!DOCTYPE"};
    if (std::find(without_end.begin(), without_end.end(), name) != without_end.end()) continue;
    if (!end) {
      open.push_back(name);
      if (name == "script") at = html.find("</script", at) - 1;  // its content is no markup
    } else if (!open.empty() && open.back() == name) {
      open.pop_back();
    } else {
      wrong.push_back(name);
    }
  }
  wrong.insert(wrong.end(), open.begin(), open.end());
  return wrong;
}

}  // namespace

TEST_CASE("The result of a check holds the keys that scripts read", "[compare]") {
  const Image cone = cone_image(64, 48, wavy), path = path_image(64, 48, wavy);
  CheckReport report = report_of(cone, path);
  nlohmann::json result = check_result(report);
  for (const char* key : {"path", "cone", "metrics", "within_budget", "provenance"}) CHECK(result.contains(key));
  for (const char* key :
       {"mean_ratio", "rel_error", "rmse", "relmse", "relmse_formula", "psnr", "ssim", "flip", "noise_share"})
    CHECK(result["metrics"].contains(key));
  CHECK(result["path"]["spp"] == 64);
  CHECK(result["cone"]["voxels_occupied"] == 31415);

  CHECK(result["within_budget"] == true);
  report.metrics.rel_error = 0.26;
  CHECK(check_result(report)["within_budget"] == false);
  report.metrics.rel_error = std::numeric_limits<double>::quiet_NaN();  // an error that cannot be told is not within
  CHECK(check_result(report)["within_budget"] == false);
  report.budget.reset();
  CHECK(check_result(report)["within_budget"].is_null());
}

TEST_CASE("The report page stands alone, escapes what it shows and has balanced tags", "[compare]") {
  const Image cone = cone_image(64, 48, wavy), path = path_image(64, 48, wavy);
  CheckReport report = report_of(cone, path);
  report.title = "</title><script>alert(1)</script> {{data}}";
  const std::string page = report_page(report);
  for (const char* outside : {"http:", "https:", "src=", "@import", "url("})
    CHECK(page.find(outside) == std::string::npos);
  CHECK(page.find("<script>alert") == std::string::npos);
  CHECK(page.find("&lt;script&gt;alert(1)&lt;/script&gt; {{data}}") != std::string::npos);
  CHECK(page.find("scenes/&lt;a&gt; &amp; &#39;b&#39;.gltf") != std::string::npos);
  CHECK(unbalanced(page).empty());
}

TEST_CASE("The report page of a noisy 512x512 check stays below 3 MiB, and so does that of a larger one", "[compare]") {
  for (const int side : {512, 1100}) {
    Image cone = cone_image(side, side, wavy), path = path_image(side, side, wavy, 0.3f);
    for (const char* layer : {"", "direct", "diffuse"}) add_noise(cone, layer, 0.1f, 1);
    for (const char* layer : {"", "direct", "indirect"}) add_noise(path, layer, 0.1f, 2);
    CheckReport report = report_of(cone_image(8, 8, wavy), path_image(8, 8, wavy));
    const CheckReport noisy{
        report.title,     cone, path, report.metrics, 0.0f, report.budget, report.cone_result, report.path_result,
        report.provenance};
    const std::string page = report_page(noisy);
    CHECK(page.size() < 3 * 1024 * 1024);
    CHECK(page.find("\"name\":\"total\"") != std::string::npos);
    CHECK((page.find("shown reduced by 3") != std::string::npos) == (side == 1100));
  }
}

TEST_CASE("A check leaves its images, pictures, result and page in the folder", "[compare]") {
  const TemporaryFolder folder;
  const Image cone = cone_image(64, 48, wavy), path = path_image(64, 48, wavy, 0.01f);
  write_check(folder.path / "new" / "folder", report_of(cone, path));
  for (const char* name : {"cone.exr", "path.exr", "cone.png", "path.png", "difference.png", "relative_error.png",
                           "noise.png", "comparison.png", "result.json", "report.html"})
    CHECK(std::filesystem::exists(folder.path / "new" / "folder" / name));
  const Image read = voxref::read_image(folder.path / "new" / "folder" / "cone.exr");
  CHECK(read.channel("specular.G")[100] == cone.channel("specular.G")[100]);
  const auto result = nlohmann::json::parse(voxref::read_file(folder.path / "new" / "folder" / "result.json"));
  CHECK(result["metrics"]["mean_ratio"] == Approx(1.0).epsilon(1e-6));  // the parts of the sum are floats
}

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("The page runs in a browser and shows the values of the middle pixel", "[compare]") {
  // 0.78125 = 200/256 and 0.1953125 survive the page's 8-bit mantissas. Odd sides: exponent rows are not full.
  Image cone = cone_image(
      31, 21, [](int x, int y) { return x == 15 && y == 10 ? glm::vec3(0.78125f, 0.1953125f, 0.0f) : wavy(x, y); });
  const Image path = path_image(31, 21, wavy);
  cone.channel("R")[0] = std::numeric_limits<float>::quiet_NaN();
  const std::optional<std::string> dom = run_in_browser(report_page(report_of(cone, path)), "", "difference");
  if (!dom) VOXREF_SKIP("chromium is not installed");
  CHECK(contains(*dom, "data-state=\"ready\""));
  CHECK(contains(*dom, "pixel (15, 10)"));
  CHECK(contains(*dom,
                 "<tr id=\"readout-a\"><th scope=\"row\">cone</th><td>0.781</td><td>0.195</td><td>0</td>"
                 "<td>0.306</td></tr>"));
  CHECK(contains(*dom, "cone darker"));
}

TEST_CASE("Every key, the wheel and the pointer work on the page without a script error", "[compare]") {
  const Image cone = cone_image(64, 48, wavy),
              path = path_image(64, 48, [](int x, int y) { return 1.1f * wavy(x, y); });
  // A script error would turn the state to "failed". The last keys leave: path (mode 4), half a stop up, layer 2.
  const std::optional<std::string> dom = run_in_browser(report_page(report_of(cone, path)), use_everything, "error");
  if (!dom) VOXREF_SKIP("chromium is not installed");
  CHECK(contains(*dom, "data-state=\"ready\""));
  CHECK(contains(*dom, "data-mode=\"b\" aria-checked=\"true\""));
  CHECK(contains(*dom, "pixel (32, 24)"));
  CHECK(contains(*dom, "stops</output>"));
}

TEST_CASE("The page shows differences far smaller than the rounding of its images", "[compare]") {
  // 0.1 % at a value of 0.75: a page that took the difference of its 8-bit images would show 0.
  Image cone = cone_image(32, 24, [](int, int) { return glm::vec3(0.75f * 1.001f, 0.75f, 0.75f * 0.999f); });
  const Image path = path_image(32, 24, [](int, int) { return glm::vec3(0.75f); });
  const std::optional<std::string> dom = run_in_browser(report_page(report_of(cone, path)), "", "difference");
  if (!dom) VOXREF_SKIP("chromium is not installed");
  CHECK(contains(*dom, "data-state=\"ready\""));
  const size_t row = dom->find("<tr id=\"readout-difference\">");
  REQUIRE(row != std::string::npos);
  const std::string cells = dom->substr(row, dom->find("</tr>", row) - row);
  INFO(cells);
  // 0.00075 to the 0.8 % of seven bits, in three digits.
  CHECK((contains(cells, "<td>0.00075") || contains(cells, "<td>0.00074")));
  CHECK((contains(cells, "<td>−0.00075") || contains(cells, "<td>−0.00074")));
  CHECK(contains(cells, "<td>0</td>"));
}

TEST_CASE("The page's map of relative errors is right where the reference is black, and Space unfolds what is folded",
          "[compare]") {
  const Image cone = cone_image(32, 24, [](int, int) { return glm::vec3(0.5f); });
  const Image black = path_image(32, 24, [](int, int) { return glm::vec3(0.0f); });
  // The colour left of the marked pixel, in the page's title; and what Space does to the folded keys.
  const std::optional<std::string> dom = run_in_browser(report_page(report_of(cone, black)), R"(
    setTimeout(() => {
      const canvas = document.getElementById("canvas");
      const pixel = canvas.getContext("2d").getImageData(canvas.width / 4, canvas.height / 2, 1, 1).data;
      const summary = document.querySelector("summary");
      const taken = !summary.dispatchEvent(new KeyboardEvent("keydown", { key: " ", bubbles: true, cancelable: true }));
      document.title = [...pixel.slice(0, 3)].join(",") + (taken ? " taken" : " left to the browser");
    }, 1000);)",
                                                        "error");
  if (!dom) VOXREF_SKIP("chromium is not installed");
  CHECK(contains(*dom, "data-state=\"ready\""));
  CHECK(contains(*dom, "<title>252,255,164 left to the browser</title>"));  // inferno's last colour: a full error
}
