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

constexpr std::array standpoints = {
    Standpoint{"sponza", {-12.0f, 3.0f, 0.0f}, {12.0f, 5.0f, 0.0f}, {0.0f, 5.0f, 0.0f}, 200.0f},
    Standpoint{"sibenik", {-15.0f, -11.0f, 0.0f}, {10.0f, -9.0f, 0.0f}, {-4.0f, -8.0f, 0.0f}, 150.0f},
    Standpoint{"conference", {-3.2f, 1.7f, -3.2f}, {2.5f, 0.8f, 1.0f}, {1.0f, 2.2f, -0.8f}, 8.0f},
};

}  // namespace

StudyScene seen_by_first_camera(const std::string& name, Scene scene) {
  StudyScene result{name, std::move(scene), {}};
  result.view.camera = result.scene.cameras.at(0);
  return result;
}

StudyScene cornell_point_scene() { return seen_by_first_camera("cornell_box_point", cornell_box(CornellLight::point)); }
StudyScene light_box_scene() { return seen_by_first_camera("light_box", light_box()); }
StudyScene plane_test_scene() { return seen_by_first_camera("plane_test", plane_test()); }

const Standpoint& standpoint(const std::string& name) {
  const auto found =
      std::find_if(standpoints.begin(), standpoints.end(), [&](const Standpoint& s) { return s.name == name; });
  if (found == standpoints.end()) throw Error("scene", name, "has no standpoint");
  return *found;
}

Light study_sun(float irradiance) { return sun("sun", {0.25f, -1.0f, 0.15f}, glm::vec3(irradiance)); }

std::optional<StudyScene> public_scene(const std::string& name, const std::filesystem::path& assets, bool with_sun) {
  const std::filesystem::path file = assets / "assets/scenes" / (name + ".glb");
  const Standpoint& place = standpoint(name);
  if (assets.empty() || !std::filesystem::exists(file)) return std::nullopt;
  StudyScene result{name, load_gltf(file), {}};
  if (with_sun)
    result.scene.lights.push_back(study_sun(10.0f));
  else
    result.scene.lights.push_back(point_light("lamp", place.lamp, glm::vec3(place.intensity)));
  result.view.camera = look_at(place.eye, place.target, {0.0f, 1.0f, 0.0f}, glm::radians(60.0f));
  result.view.camera.aspect = 16.0f / 9.0f;
  return result;
}

std::vector<StudyScene> scenes_or_own(const StudyRequest& request, std::vector<StudyScene> own, bool with_sun,
                                      std::vector<std::string>& skipped) {
  if (!request.scenes.empty()) return request.scenes;
  if (request.quick)
    skipped.emplace_back("sponza: too large for --quick");
  else if (std::optional<StudyScene> sponza = public_scene("sponza", request.assets, with_sun))
    own.push_back(std::move(*sponza));
  else
    skipped.emplace_back("sponza: not in VOXREF_ASSETS");
  return own;
}

View sized(View view, int width) {
  view.width = width;
  view.height = std::max(1, static_cast<int>(std::lround(static_cast<float>(width) / view.camera.aspect)));
  return view;
}

}  // namespace voxref
