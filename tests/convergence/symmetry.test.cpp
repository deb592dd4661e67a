#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "catch.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "reference/small_scenes.h"

// A scene that is turned by 90 degrees or mirrored, camera and all, must give the same image, or its mirror image.

namespace voxref {
namespace {

/// A signed permutation of the axes.
struct Symmetry {
  const char* name;
  glm::mat3 turn;
  bool mirrors() const { return glm::determinant(turn) < 0.0f; }
};

const std::array<Symmetry, 5> symmetries = {{
    {"90 degrees around x", {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}},
    {"90 degrees around y", {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}},
    {"90 degrees around z", {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}},
    {"mirror in x", {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {"mirror in the diagonal of y and z", {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
}};

/// The mirrored camera's x axis is turned round, so that it stays a rotation: its image is the other way round.
Camera moved(Camera camera, const Symmetry& symmetry) {
  glm::mat4& frame = camera.world_from_camera;
  for (int column = 0; column < 4; ++column)
    frame[column] = glm::vec4(symmetry.turn * glm::vec3(frame[column]), frame[column].w);
  if (symmetry.mirrors()) frame[0] = -frame[0];
  return camera;
}

Scene moved(Scene scene, const Symmetry& symmetry) {
  for (glm::vec3& position : scene.positions) position = symmetry.turn * position;
  for (glm::vec3& normal : scene.normals) normal = symmetry.turn * normal;
  if (symmetry.mirrors())
    for (glm::uvec3& triangle : scene.triangles) std::swap(triangle.y, triangle.z);  // the front stays the front
  for (Light& light : scene.lights) {
    light.position = symmetry.turn * light.position;
    light.direction = symmetry.turn * light.direction;
  }
  for (Camera& camera : scene.cameras) camera = moved(camera, symmetry);
  return scene;
}

constexpr int side = 16;

Settings with_cones(int count) {
  Settings settings = profile("radiometric");
  settings.grid.resolution = 32;
  settings.render.cone.diffuse = settings.bounce.cones = count;
  settings.bounce.count = 1;
  return settings;
}

Image traced(const Scene& scene, const Settings& settings) {
  const Caster caster(scene);
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = side;
  return cone_trace(scene, caster, view, settings).image.image;
}

/// Mean difference of the colours over their mean, the moved image turned back.
double difference(const Image& image, const Image& moved, bool mirrored) {
  double sum = 0.0, total = 0.0;
  for (const char* channel : {"R", "G", "B"})
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const float a = image.channel(channel)[size_t(y * side + x)];
        const float b = moved.channel(channel)[size_t(y * side + (mirrored ? side - 1 - x : x))];
        sum += std::abs(double(a) - double(b));
        total += a;
      }
  return sum / total;
}

struct Example {
  const char* name;
  Scene scene;
  double bound;  ///< of the difference with one cone
};

// The wall's room is 14 voxels deep, no power of two: coarse texels are anchored at the minimum corner, and so lie
// elsewhere when that axis is reversed, which one of the five symmetries does (measured: 0.5 %, the others 0). The
// sphere's images differ by 0.07 % at most.
std::vector<Example> three_scenes() {
  return {{"Cornell box", cornell_box(CornellLight::point), 1e-4},
          {"red and green wall", red_green_wall(), 1e-2},
          {"sphere", sphere_furnace(0.5f, 2), 1e-3}};
}

/// Rooms of side 2 with a light away from the middle: empty, with a shelf, with a lamp and a block.
std::vector<std::pair<const char*, Scene>> cubic_rooms() {
  Scene empty;
  add_cube_interior(empty, add_material(empty, lambert({0.7f, 0.6f, 0.5f})));
  Light light;
  light.position = {0.4f, 0.5f, -0.2f};
  empty.lights.push_back(light);
  Camera camera;
  camera.world_from_camera[3] = glm::vec4(0.1f, -0.2f, 0.8f, 1.0f);  // looks along -z
  camera.yfov = 1.4f;
  empty.cameras.push_back(camera);
  Scene shelf = empty;
  add_quad(shelf, {-0.7f, -0.3f, -0.8f}, {0.0f, 0.0f, 0.9f}, {0.8f, 0.0f, 0.0f},
           add_material(shelf, lambert({0.2f, 0.6f, 0.9f})));
  Scene lamp = empty;
  lamp.lights.clear();
  add_quad(lamp, {-0.5f, 0.9f, -0.5f}, {0.6f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.4f},
           add_material(lamp, lambert(glm::vec3(0.2f), {3.0f, 2.0f, 1.0f})));
  const uint32_t red = add_material(lamp, lambert({0.8f, 0.1f, 0.1f}));
  add_quad(lamp, {0.1f, -0.4f, -0.6f}, {0.0f, 0.0f, 0.5f}, {0.6f, 0.0f, 0.0f}, red);
  add_quad(lamp, {0.1f, -1.0f, -0.1f}, {0.6f, 0.0f, 0.0f}, {0.0f, 0.6f, 0.0f}, red);
  return {{"empty", empty}, {"shelf", shelf}, {"lamp and block", lamp}};
}

}  // namespace

// One cone points along the normal, so that nothing but the scene has a direction: voxels, directional volumes, march
// and pixels are the same whichever way the scene is turned. Rings of cones are not: five around a normal look
// different when they are turned by 90 degrees, and which way they point follows the world's axes.
TEST_CASE("Turned by 90 degrees and mirrored, three scenes give the same image with one cone", "[consistency]") {
  for (const auto& [name, scene, bound] : three_scenes()) {
    const Image image = traced(scene, with_cones(1));
    for (const Symmetry& symmetry : symmetries) {
      const double found = difference(image, traced(moved(scene, symmetry), with_cones(1)), symmetry.mirrors());
      CAPTURE(name, symmetry.name, found);
      CHECK(found < bound);
    }
  }
}

// Five cones are one along the normal and four around it, a quarter turn apart: where walls face along the axes, so do
// the cones' frames, and the set is its own image. In a cube of a power of two of voxels so are the coarse texels.
TEST_CASE("Turned by 90 degrees and mirrored, cubic rooms along the axes give the same image with five cones",
          "[consistency]") {
  for (const auto& [name, scene] : cubic_rooms()) {
    Settings settings = with_cones(5);
    const auto worst = [&, &room = scene] {
      const Image image = traced(room, settings);
      double largest = 0.0;
      for (const Symmetry& symmetry : symmetries)
        largest = std::max(largest, difference(image, traced(moved(room, symmetry), settings), symmetry.mirrors()));
      return largest;
    };
    // Voxels on edges face along diagonals, around which no frame suits all symmetries, and where two walls are near an
    // apex steps aside from one after the other: 0.03, 0.03 and 0.3 % were measured.
    const double usual = worst();
    settings.bounce.count = 0;
    settings.render.cone.start = 3.0f;
    const double bare = worst();
    CAPTURE(name, usual, bare);
    CHECK(usual < 0.005);
    CHECK(bare < 1e-5);  // float32: sums over texels, steps and cones in another order
  }
}

TEST_CASE("What the direction of a ring of cones changes is bounded, and falls with more cones", "[consistency]") {
  for (const auto& [name, scene, bound] : three_scenes()) {
    const auto worst = [&, &room = scene](int cones) {
      const Image image = traced(room, with_cones(cones));
      double largest = 0.0;
      for (const Symmetry& symmetry : symmetries)
        largest =
            std::max(largest, difference(image, traced(moved(room, symmetry), with_cones(cones)), symmetry.mirrors()));
      return largest;
    };
    const double six = worst(6), many = worst(64);
    CAPTURE(name, six, many);
    // Measured with 6 cones 9.8, 3.2 and 0.1 %; with 64 cones 2.5, 0.4 and 0.0 %.
    CHECK(six < 0.12);
    CHECK(many < 0.03);
    CHECK(many < six);
  }
}

}  // namespace voxref
