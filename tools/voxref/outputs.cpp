#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>

#include "error.h"

namespace voxref {

namespace fs = std::filesystem;

namespace {

/// Absolute, without symbolic links as far as it exists, and without a slash at the end.
fs::path resolved(const fs::path& path) {
  const fs::path result = fs::weakly_canonical(fs::absolute(path));
  return result.has_filename() ? result : result.parent_path();
}

/// Whether `path` is `folder` or lies in it, at any depth.
bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path inner = resolved(path), outer = resolved(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

/// Whether a folder of volumes may write a file of that name.
bool is_volume_of(const fs::path& folder, const fs::path& file) {
  const bool named_so = file.filename() == "volumes.json" || file.extension() == ".npy";
  return named_so && same_place(fs::absolute(file).parent_path(), folder);
}

void require_kept(const fs::path& input, const std::string& what, const NamedFiles& files) {
  if (input.empty()) return;
  for (const fs::path& output : files.written)
    if (same_place(output, input)) throw Error("-o", fmt::format("'{}' is {} itself", output.string(), what));
  if (files.volumes && is_volume_of(*files.volumes, input))
    throw Error("--volumes", fmt::format("'{}', {}, might be replaced", input.string(), what));
}

}  // namespace

void require_no_clash(const NamedFiles& files) {
  require_kept(files.scene, "the scene", files);
  require_kept(files.config, "the file of --config", files);
  for (const fs::path& input : files.compared) require_kept(input, "what is compared", files);
  if (!files.volumes) return;
  for (const fs::path& output : files.written)
    if (lies_in(*files.volumes, output) || is_volume_of(*files.volumes, output))
      throw Error("--volumes",
                  fmt::format("'{}' and '{}' of -o are in each other's way", files.volumes->string(), output.string()));
}

bool same_place(const fs::path& a, const fs::path& b) {
  std::error_code error;  // one of them is not there: then names decide
  return fs::equivalent(a, b, error) || resolved(a) == resolved(b);
}

}  // namespace voxref
