#include "cone/clearance.h"

#include "catch.h"
#include "reference/small_scenes.h"

using namespace voxref;

namespace {

/// A floor y = 0 and a wall x = -0.5 that stands on it and faces +x.
Scene floor_and_wall() {
  Scene scene;
  const uint32_t grey = add_material(scene, lambert(glm::vec3(0.5f)));
  add_floor(scene, 1.0f, grey);
  add_quad(scene, {-0.5f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 2.0f}, grey);
  return scene;
}

constexpr float voxel = 0.02f;
const glm::vec3 up(0.0f, 1.0f, 0.0f);

}  // namespace

TEST_CASE("Beside a wall the apex moves off it, as far as it stands off the floor", "[clearance]") {
  const Scene scene = floor_and_wall();
  const Caster caster(scene);
  for (const float distance : {0.001f, 0.01f, 0.02f, 0.029f}) {
    CAPTURE(distance);
    // Either side of the sheet: the nearer face is cleared, whichever way it is wound.
    for (const float side : {-1.0f, 1.0f}) {
      const glm::vec3 move = clearance(scene, caster, {-0.5f + side * distance, 0.0f, 0.3f}, up, {}, voxel);
      CHECK(side * move.x + distance == Approx(1.5f * voxel).epsilon(1e-4));
      CHECK(move.y == 0.0f);
      CHECK(move.z == Approx(0.0f).margin(1e-6));
    }
  }
}

TEST_CASE("Away from all else the apex stays over its point", "[clearance]") {
  const Scene scene = floor_and_wall();
  const Caster caster(scene);
  for (const float x : {-0.531f, -0.469f, 0.0f, 0.9f})
    CHECK(clearance(scene, caster, {x, 0.0f, 0.3f}, up, {}, voxel) == glm::vec3(0.0f));
}

TEST_CASE("In a corner of a room the apex clears both walls", "[clearance]") {
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert(glm::vec3(0.5f))));
  const Caster caster(scene);
  const glm::vec3 move = clearance(scene, caster, {0.99f, -1.0f, -0.995f}, up, {}, voxel);
  CHECK(move.x == Approx(0.01f - 1.5f * voxel).epsilon(1e-3));
  CHECK(move.z == Approx(1.5f * voxel - 0.005f).epsilon(1e-3));
}
