#include "study/study_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "error.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "scene/gltf.h"

namespace voxref {

namespace {

StudyScene own(const std::string& name, Scene scene) {
  StudyScene result{name, std::move(scene), {}};
  result.view.camera = result.scene.cameras.at(0);
  return result;
}

/// Where one stands in a scene whose file has neither camera nor light, metres, and what lights it: a lamp between
/// camera and target, bright enough for an irradiance of about 1 W/m^2 half-way across, or a sun through the openings.
struct Standpoint {
  const char* name;
  glm::vec3 eye, target, lamp;
  float intensity;  ///< W/sr
};
constexpr std::array standpoints = {
    Standpoint{"sponza", {-12.0f, 3.0f, 0.0f}, {12.0f, 5.0f, 0.0f}, {0.0f, 5.0f, 0.0f}, 200.0f},
    Standpoint{"sibenik", {-15.0f, -11.0f, 0.0f}, {10.0f, -9.0f, 0.0f}, {-4.0f, -8.0f, 0.0f}, 150.0f},
    Standpoint{"conference", {-3.2f, 1.7f, -3.2f}, {2.5f, 0.8f, 1.0f}, {1.0f, 2.2f, -0.8f}, 8.0f},
};

}  // namespace

StudyScene cornell_point_scene() { return own("cornell_box_point", cornell_box(CornellLight::point)); }
StudyScene light_box_scene() { return own("light_box", light_box()); }
StudyScene plane_test_scene() { return own("plane_test", plane_test()); }

std::optional<StudyScene> public_scene(const std::string& name, const std::filesystem::path& assets, bool with_sun) {
  const std::filesystem::path file = assets / "assets/scenes" / (name + ".glb");
  const auto found =
      std::find_if(standpoints.begin(), standpoints.end(), [&](const Standpoint& s) { return s.name == name; });
  if (found == standpoints.end()) throw Error("scene", name, "has no standpoint");
  if (assets.empty() || !std::filesystem::exists(file)) return std::nullopt;
  StudyScene result{name, load_gltf(file), {}};
  if (with_sun)
    result.scene.lights.push_back(sun("sun", {0.25f, -1.0f, 0.15f}, glm::vec3(10.0f)));
  else
    result.scene.lights.push_back(point_light("lamp", found->lamp, glm::vec3(found->intensity)));
  result.view.camera = look_at(found->eye, found->target, {0.0f, 1.0f, 0.0f}, glm::radians(60.0f));
  result.view.camera.aspect = 16.0f / 9.0f;
  return result;
}

View sized(View view, int width) {
  view.width = width;
  view.height = std::max(1, static_cast<int>(std::lround(static_cast<float>(width) / view.camera.aspect)));
  return view;
}

}  // namespace voxref
