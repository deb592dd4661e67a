#include "study/thesis_scenes.h"

#include <glm/geometric.hpp>

#include "catch.h"
#include "cone/cone_set.h"
#include "study/thesis_data.h"

using namespace voxref;

TEST_CASE("The thesis's scenes and objects that are absent are named, once each", "[study]") {
  std::vector<std::string> skipped;
  const std::vector<StudyScene> scenes = thesis_scenes({}, ThesisLight::sun, skipped);
  thesis_scenes({}, ThesisLight::point, skipped);
  REQUIRE(scenes.size() == 1);
  CHECK(scenes[0].name == "cornell_box");
  CHECK(skipped == std::vector<std::string>{"happy_buddha_100k", "stanford_dragon_100k", "stanford_bunny", "sibenik",
                                            "conference", "sponza"});
}

TEST_CASE("The thesis's objects stand in its scenes as dynamic ones", "[study]") {
  const auto bunny = shared_file("assets/objects/stanford_bunny.glb");
  if (!bunny) VOXREF_SKIP("the Stanford bunny is absent");
  StudyRequest request;
  request.assets = bunny->parent_path().parent_path().parent_path();
  std::vector<std::string> skipped;
  const std::vector<StudyScene> scenes = thesis_scenes(request, ThesisLight::point, skipped);
  for (const StudyScene& scene : scenes) {
    CAPTURE(scene.name);
    CHECK_NOTHROW(validate(scene.scene));
    CHECK(scene.scene.lights.size() == 1);
    CHECK(std::count_if(scene.scene.objects.begin(), scene.scene.objects.end(),
                        [](const Object& object) { return object.dynamic; }) >= 1);
  }
}

TEST_CASE("A specular ball's cone has the half-angle that was asked for", "[study]") {
  for (const float degrees : {5.0f, 20.0f, 45.0f}) {
    const Material& material = specular_ball(degrees).scene.materials.back();
    const float half_angle = std::atan(published_specular_tan_half_angle(material.glossiness));
    // The published factor 1.57079 and the clamping of glossiness are good to a thousandth.
    CHECK(half_angle * 57.29578f == Approx(degrees).epsilon(1e-3));
  }
}

TEST_CASE("Every published row belongs to a scene and resolution of its own", "[study]") {
  for (size_t i = 0; i < thesis_stages.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      CHECK((thesis_stages[i].scene != thesis_stages[j].scene || thesis_stages[i].voxels != thesis_stages[j].voxels));
}
