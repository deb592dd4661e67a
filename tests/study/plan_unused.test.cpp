#include "study/plan_unused.h"

#include "catch.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"

using namespace voxref;

namespace {

View view_of(const Scene& scene) {
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = 48;
  return view;
}

bool sees(const Scene& scene, const View& view) { return view_sees_surfaces(scene, Caster(scene), view); }

}  // namespace

TEST_CASE("A plan drops what the scene does not use", "[plan]") {
  const Scene open = point_light_over_plane();
  SettingSpace space;
  CHECK(drop_unused(space, open, false, glm::vec3(0.0f)).size() == 3);
  CHECK(space.bounces == std::vector<std::optional<int>>{0});
  CHECK(space.cones.size() == 1);
  const Scene room = cornell_box(CornellLight::area);
  SettingSpace all;
  CHECK(drop_unused(all, room, true, glm::vec3(0.0f)).size() == 1);  // not specular
  CHECK(all.bounces.size() == SettingSpace{}.bounces.size());
  Scene shiny = room;
  shiny.materials[0].metallic = 1.0f;
  CHECK(drop_unused(all, shiny, true, glm::vec3(0.0f)).empty());
  // What somebody fixed stays.
  SettingSpace fixed;
  fixed.bounces = {2};
  drop_unused(fixed, open, false, glm::vec3(0.0f));
  CHECK(fixed.bounces == std::vector<std::optional<int>>{2});
}

TEST_CASE("A plane alone sees no surface, nor does a ball from outside, nor the void", "[plan]") {
  const Scene ground = point_light_over_plane();
  CHECK(!sees(ground, view_of(ground)));
  View away = view_of(ground);
  away.camera = look_at({0.0f, 1.0f, 0.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, 0.8f);
  CHECK(!sees(ground, away));
  const Scene closed = furnace(0.5f);
  View outside = away;
  outside.camera = look_at({3.0f, 4.0f, 5.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0.8f);
  CHECK(!sees(closed, outside));
}

TEST_CASE("A room whose triangles face outward sees itself", "[plan]") {
  Scene room = cornell_box(CornellLight::point);
  CHECK(sees(room, view_of(room)));
  for (glm::uvec3& triangle : room.triangles) std::swap(triangle.x, triangle.y);
  CHECK(sees(room, view_of(room)));
}

TEST_CASE("A small block in view on a wide ground keeps its bounces", "[plan]") {
  // 0.3 of 100 m: of rays that leave the ground anywhere, one in 10^5 would meet it, and of 4096 probably none.
  Scene scene;
  const uint32_t material = add_material(scene, lambertian("grey", glm::vec3(0.5f)));
  add_object(scene, "ground", plane(100.0f), material);
  add_object(scene, "block", box({-0.15f, 0.0f, -0.15f}, {0.15f, 0.3f, 0.15f}), material);
  View view;
  view.camera = look_at({0.6f, 0.6f, 1.2f}, {0.0f, 0.1f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0.8f);
  CHECK(sees(scene, view));
}
