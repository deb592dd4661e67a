#include <filesystem>
#include <vector>

#include "catch.h"
#include "reference/small_scenes.h"
#include "scene/gltf.h"

// A value that is finite may still be wrong: this says only that no material, texture, normal or degenerate triangle of
// these files makes NaN or infinity on the paths that a small image tries.
namespace voxref {

namespace {

/// Renders a file small, lit by its own lights, by a sun and by a background, so that all kinds of light meet all of
/// its surfaces.
void expect_finite(const std::filesystem::path& file) {
  INFO(file.string());
  Scene scene = load_gltf(file);
  Light sun;
  sun.type = LightType::directional;
  sun.direction = glm::normalize(glm::vec3(-0.3f, -1.0f, -0.5f));
  scene.lights.push_back(sun);
  View view;
  view.camera = scene.cameras.empty() ? framing_camera(scene) : scene.cameras[0];
  view.width = view.height = 48;
  view.pixel = PixelSampling::box;
  view.background = glm::vec3(0.5f);
  const PathResult result = render(scene, view, 8);
  CHECK(result.nonfinite == 0);
  CHECK(result.first_nonfinite.empty());
  CHECK(result.mean.g > 0.0f);
}

/// All files below a folder that are no larger than `most` bytes, or no smaller; but those that must be refused.
std::vector<std::filesystem::path> scene_files(const std::filesystem::path& folder, bool large) {
  constexpr uintmax_t most = 2'500'000;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if ((path.extension() == ".glb" || path.extension() == ".gltf") && path.stem() != "Duck" &&
        (entry.file_size() > most) == large)
      files.push_back(path);
  }
  return files;
}

}  // namespace

TEST_CASE("No sample is not finite on any scene of the project", "[finite]") {
  const auto files = scene_files(std::filesystem::path(VOXREF_SOURCE_DIR) / "scenes", false);
  CHECK(files.size() >= 22);
  for (const auto& file : files) expect_finite(file);
}

TEST_CASE("No sample is not finite on any of the shared assets but the largest", "[finite]") {
  const auto folder = shared_file("assets");
  if (!folder) VOXREF_SKIP("the shared assets are absent");
  for (const auto& file : scene_files(*folder, false)) expect_finite(file);
}

TEST_CASE("No sample is not finite on the largest of the shared assets", "[finite][.long]") {
  const auto folder = shared_file("assets");
  if (!folder) VOXREF_SKIP("the shared assets are absent");
  for (const auto& file : scene_files(*folder, true)) expect_finite(file);
}

}  // namespace voxref
