#include "voxel/voxelize.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "catch.h"
#include "parallel.h"
#include "voxel/mesh_scene.h"

using namespace voxref;

namespace {

constexpr double pi = 3.14159265358979324;

/// The occupied voxel at `index`, or nothing.
std::optional<size_t> find(const SurfaceGrid& surfaces, const glm::ivec3& index) {
  const auto found = std::find(surfaces.voxels.begin(), surfaces.voxels.end(), index);
  if (found == surfaces.voxels.end()) return std::nullopt;
  return size_t(found - surfaces.voxels.begin());
}

double total_area(const SurfaceGrid& surfaces) {
  return std::accumulate(surfaces.area.begin(), surfaces.area.end(), 0.0);
}

/// Area-weighted sum of an attribute over all voxels.
template <class Attribute>
glm::dvec3 weighted(const SurfaceGrid& surfaces, const std::vector<Attribute>& attribute) {
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < surfaces.size(); ++i) sum += double(surfaces.area[i]) * glm::dvec3(attribute[i]);
  return sum;
}

/// Random triangles in the box [2, side - 2]^3, each with a normal and a colour of its own.
Scene triangle_soup(size_t count, float side, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Scene scene;
  for (size_t i = 0; i < count; ++i) {
    const auto point = [&] {
      return glm::vec3(2.0f) + (side - 4.0f) * glm::vec3(uniform(random), uniform(random), uniform(random));
    };
    const glm::vec3 a = point(), b = glm::mix(a, point(), 0.5f), c = glm::mix(a, point(), 0.5f);
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const glm::vec3 color(uniform(random), uniform(random), uniform(random));
    add_object(scene, "triangle", {{a, b, c}, {normal, normal, normal}, {{0, 1, 2}}},
               add_material(scene, emitter("", color, 3.0f * color)));
  }
  return scene;
}

/// The same scene, its triangles in another order.
Scene shuffled(Scene scene, unsigned seed) {
  std::vector<Object> objects = scene.objects;
  std::shuffle(objects.begin(), objects.end(), std::mt19937(seed));
  Scene result = scene;
  result.objects.clear();
  result.triangles.clear();
  result.triangle_materials.clear();
  for (Object object : objects) {
    const uint32_t first = uint32_t(result.triangles.size());
    for (uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
      result.triangles.push_back(scene.triangles[t]);
      result.triangle_materials.push_back(object.material);
    }
    object.first_triangle = first;
    result.objects.push_back(object);
  }
  return result;
}

/// The same surface with every triangle cut in two across its first edge. A corner in the middle of an edge is rounded
/// to float32, so the halves do not lie in the plane to the bit.
Scene halved(const Scene& scene) {
  Scene result = scene;
  result.triangles.clear();
  result.triangle_materials.clear();
  for (Object& object : result.objects) {
    const uint32_t first = uint32_t(result.triangles.size());
    for (uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
      const glm::uvec3 corners = scene.triangles[t];
      const uint32_t middle = uint32_t(result.positions.size());
      result.positions.push_back(0.5f * (scene.positions[corners.x] + scene.positions[corners.y]));
      result.normals.push_back(scene.normals[corners.x]);
      result.triangles.push_back({corners.x, middle, corners.z});
      result.triangles.push_back({middle, corners.y, corners.z});
      result.triangle_materials.insert(result.triangle_materials.end(), 2, object.material);
    }
    object.first_triangle = first;
    object.triangle_count *= 2;
  }
  return result;
}

/// Largest difference of any attribute where both grids are occupied, each divided by its size. Voxels that only one
/// has must hold next to nothing.
double difference(const SurfaceGrid& a, const SurfaceGrid& b) {
  double worst = 0.0;
  size_t matched = 0;
  for (size_t i = 0, j = 0; i < a.size(); ++i) {
    const auto order = [](const glm::ivec3& v) { return std::tuple(v.z, v.y, v.x); };
    while (j < b.size() && order(b.voxels[j]) < order(a.voxels[i])) ++j;
    if (j == b.size() || b.voxels[j] != a.voxels[i]) continue;
    ++matched;
    // Attributes of tiny pieces are quotients of tiny numbers; they count by their area.
    const double weight = std::min<double>(1.0, a.area[i]);
    worst = std::max<double>(worst, std::abs(a.area[i] - b.area[j]));
    worst = std::max<double>(worst, weight * glm::length(a.albedo[i] - b.albedo[j]));
    worst = std::max<double>(worst, weight * glm::length(a.normal[i] - b.normal[j]));
    worst = std::max<double>(worst, weight * glm::length(a.centroid[i] - b.centroid[j]));
    worst = std::max<double>(worst, weight * glm::length(a.emission[i] - b.emission[j]));
  }
  // A few slivers at the threshold of nothing may be on one side only.
  CHECK(a.size() - matched <= a.size() / 1000);
  CHECK(b.size() - matched <= b.size() / 1000);
  return worst;
}

}  // namespace

TEST_CASE("an axis-aligned cube at voxel centres occupies its shell, each voxel with its share", "[voxelize]") {
  // Faces from 2.5 to 10.5: 9^3 voxels less the 7^3 inside.
  const SurfaceGrid surfaces =
      voxelize(scene_of(box(glm::vec3(2.5f), glm::vec3(10.5f))), unit_grid(glm::ivec3(13)), {});
  CHECK(surfaces.size() == 9 * 9 * 9 - 7 * 7 * 7);
  CHECK(total_area(surfaces) == 6.0 * 64.0);
  CHECK(std::is_sorted(surfaces.voxels.begin(), surfaces.voxels.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.z, a.y, a.x) < std::tuple(b.z, b.y, b.x);
  }));

  const size_t face = find(surfaces, {5, 6, 10}).value();
  CHECK(surfaces.area[face] == 1.0f);
  CHECK(surfaces.normal[face] == glm::vec3(0, 0, 1));
  CHECK(glm::length(surfaces.centroid[face] - glm::vec3(5.5f, 6.5f, 10.5f)) < 1e-6f);  // one rounding of 10.5
  CHECK(surfaces.albedo[face] == glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));

  const size_t edge = find(surfaces, {2, 6, 10}).value();  // two strips of 1/2 x 1
  CHECK(surfaces.area[edge] == 1.0f);
  CHECK(glm::length(surfaces.normal[edge] - glm::vec3(-0.5f, 0.0f, 0.5f)) < 1e-7f);
  CHECK(glm::length(surfaces.centroid[edge] - glm::vec3(2.625f, 6.5f, 10.375f)) < 2e-6f);

  const size_t corner = find(surfaces, {10, 10, 10}).value();  // three squares of 1/2 x 1/2
  CHECK(surfaces.area[corner] == 0.75f);
  CHECK(glm::length(surfaces.normal[corner] - glm::vec3(1.0f / 3.0f)) < 1e-7f);
  CHECK(surfaces.emission.empty());
}

TEST_CASE("area on a face shared by two voxels counts half to each", "[voxelize]") {
  const Mesh wall = quad({8, 2, 2}, {8, 6, 2}, {8, 6, 6}, {8, 2, 6});  // between voxels 7 and 8, and between two bricks
  const SurfaceGrid surfaces = voxelize(scene_of(wall), unit_grid(glm::ivec3(16)), {});
  REQUIRE(surfaces.size() == 2 * 16);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    CHECK((surfaces.voxels[i].x == 7 || surfaces.voxels[i].x == 8));
    CHECK(surfaces.area[i] == 0.5f);
    CHECK(surfaces.centroid[i].x == 8.0f);
  }
}

TEST_CASE("a wall that rounding puts beside a face is in the face all the same", "[voxelize]") {
  const float beside = std::nextafter(8.0f, 9.0f);
  const Mesh wall = quad({beside, 2, 2}, {beside, 6, 2}, {beside, 6, 6}, {beside, 2, 6});
  CHECK(voxelize(scene_of(wall), unit_grid(glm::ivec3(16)), {}).size() == 2 * 16);
  // And one that is cut off a rounding beyond a face occupies nothing there.
  const Mesh floor = quad({2, 2.5f, 2}, {2, 2.5f, beside}, {beside, 2.5f, beside}, {beside, 2.5f, 2});
  CHECK(voxelize(scene_of(floor), unit_grid(glm::ivec3(16)), {}).size() == 6 * 6);
}

TEST_CASE("a diagonal cut of a square occupies only voxels that it reaches into", "[voxelize]") {
  const glm::vec3 up(0, 0, 1);
  const Mesh half = {{{1, 1, 2.5f}, {9, 1, 2.5f}, {9, 9, 2.5f}}, {up, up, up}, {{0, 1, 2}}};
  const SurfaceGrid surfaces = voxelize(scene_of(half), unit_grid(glm::ivec3(16)), {});
  CHECK(surfaces.size() == 8 * 9 / 2);  // the diagonal's voxels and those below, none that it only touches
  CHECK(total_area(surfaces) == 32.0);
  // An edge of slope 1/n passes through a corner every n voxels; where it is cut there, rounding leaves slivers.
  for (const int n : {3, 5, 6, 7, 9, 11, 13}) {
    const float width = float(n * 4);
    const Mesh ramp = {{{1, 1, 2.5f}, {1 + width, 1, 2.5f}, {1 + width, 5, 2.5f}}, {up, up, up}, {{0, 1, 2}}};
    CHECK(voxelize(scene_of(ramp), unit_grid({64, 8, 8}), {}).size() == size_t(n * (1 + 2 + 3 + 4)));
  }
}

TEST_CASE("area, centroid and normals of a sphere are the mesh's", "[voxelize]") {
  const Mesh mesh = moved(scaled(icosphere(3), 5.0f), {8.1f, 7.9f, 8.3f});
  for (const float voxel : {1.0f, 0.25f}) {
    Grid grid = unit_grid(glm::ivec3(int(16.0f / voxel)));
    grid.voxel = voxel;
    const SurfaceGrid surfaces = voxelize(scene_of(mesh), grid, {});
    CHECK(total_area(surfaces) == Approx(area(mesh)).epsilon(1e-6));  // float32 areas of some thousand voxels
    CHECK(area(mesh) == Approx(4.0 * pi * 25.0).epsilon(0.01));       // 1280 facets
    const glm::dvec3 centroid = weighted(surfaces, surfaces.centroid) / total_area(surfaces);
    CHECK(glm::length(centroid - glm::dvec3(8.1, 7.9, 8.3)) < 1e-4);  // as symmetric as float32 corners are
    CHECK(glm::length(weighted(surfaces, surfaces.normal)) / total_area(surfaces) < 1e-5);  // closed
    for (size_t i = 0; i < surfaces.size(); ++i) {
      REQUIRE(glm::length(surfaces.normal[i]) <= 1.0f + 1e-6f);
      REQUIRE(glm::length(surfaces.normal[i]) > 0.5f);
      REQUIRE(glm::dot(surfaces.normal[i], surfaces.centroid[i] - glm::vec3(8.1f, 7.9f, 8.3f)) > 0.0f);
      const glm::vec3 inside = (surfaces.centroid[i] - grid.center(surfaces.voxels[i])) / voxel;
      REQUIRE(std::max({std::abs(inside.x), std::abs(inside.y), std::abs(inside.z)}) < 0.5f + 1e-4f);
    }
  }
}

// The second algorithm: points spread over every triangle, each counted in the voxel that it lies in.
TEST_CASE("clipping agrees with dense point sampling of the triangles", "[voxelize]") {
  const Scene scene = triangle_soup(30, 20.0f);
  const SurfaceGrid surfaces = voxelize(scene, unit_grid(glm::ivec3(20)), {});
  constexpr int side = 400;  // points per triangle: 400 x 400 / 2
  struct Sum {
    double area = 0.0;
    glm::dvec3 albedo{0.0}, normal{0.0}, centroid{0.0};
  };
  std::vector<Sum> sums(20 * 20 * 20);
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::dvec3 a = scene.positions[3 * t], b = scene.positions[3 * t + 1], c = scene.positions[3 * t + 2];
    const double share = 0.5 * glm::length(glm::cross(b - a, c - a)) / (side * side);
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        double u = (i + 0.5) / side, v = (j + 0.5) / side;
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const glm::dvec3 point = a + u * (b - a) + v * (c - a);
        const glm::ivec3 voxel(point);
        Sum& sum = sums[voxel.x + 20 * (voxel.y + 20 * voxel.z)];
        sum.area += share;
        sum.albedo += share * glm::dvec3(scene.materials[t].base_color);
        sum.normal += share * glm::dvec3(scene.normals[3 * t]);
        sum.centroid += share * point;
      }
  }
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const glm::ivec3 v = surfaces.voxels[i];
    Sum& sum = sums[v.x + 20 * (v.y + 20 * v.z)];
    // Points are up to 0.035 voxels apart: one row of them too many or too few along the 1.5 voxels of a piece's side
    // is 0.05, and the two ends of a row partly cancel.
    REQUIRE(std::abs(surfaces.area[i] - sum.area) < 0.03);
    if (surfaces.area[i] > 0.1f) {
      REQUIRE(glm::length(glm::dvec3(surfaces.albedo[i]) - sum.albedo / sum.area) < 0.03);
      REQUIRE(glm::length(glm::dvec3(surfaces.normal[i]) - sum.normal / sum.area) < 0.03);
      REQUIRE(glm::length(glm::dvec3(surfaces.centroid[i]) - sum.centroid / sum.area) < 0.03);
    }
    sum.area = 0.0;
  }
  for (const Sum& sum : sums) REQUIRE(sum.area == 0.0);  // no voxel is missing
}

TEST_CASE("means do not depend on the order of triangles or on their cutting", "[voxelize]") {
  const Scene scene = triangle_soup(200, 30.0f);
  const Grid grid = unit_grid(glm::ivec3(30));
  const SurfaceGrid surfaces = voxelize(scene, grid, {});
  CHECK(total_area(surfaces) > 1000.0);
  // Sums of doubles in another order: what is left is the rounding to float32 of values up to 30.
  CHECK(difference(surfaces, voxelize(shuffled(scene, 2), grid, {})) < 4e-6);
  // Corners rounded to float32 in the middle of edges: 2e-6 voxels, times edges of a piece, a few per voxel.
  CHECK(difference(surfaces, voxelize(halved(scene), grid, {})) < 5e-5);
}

TEST_CASE("voxels have the same bits on one thread and on two", "[voxelize]") {
  const Scene scene = triangle_soup(300, 60.0f);
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return voxelize(scene, unit_grid(glm::ivec3(60)), {.opacity = VoxelOpacity::coverage});
  };
  const SurfaceGrid one = with(1), two = with(2);
  CHECK(one.voxels == two.voxels);
  CHECK(one.area == two.area);
  CHECK(one.albedo == two.albedo);
  CHECK(one.normal == two.normal);
  CHECK(one.centroid == two.centroid);
  CHECK(one.emission == two.emission);
}

TEST_CASE("whole-voxel translation moves dyadic surfaces to the bit", "[voxelize]") {
  const Mesh mesh = {
      {{1.5f, 1.25f, 2.0f}, {6.5f, 2.5f, 3.75f}, {3.0f, 6.75f, 5.5f}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 2}}};
  const SurfaceGrid here = voxelize(scene_of(mesh), unit_grid(glm::ivec3(16)), {});
  Grid grid = unit_grid(glm::ivec3(16));
  grid.min = glm::vec3(-7, 64, 3);
  const SurfaceGrid there = voxelize(scene_of(moved(mesh, grid.min)), grid, {});
  CHECK(here.voxels == there.voxels);
  CHECK(here.area == there.area);
  CHECK(here.normal == there.normal);
}

TEST_CASE("opposite sides of a thin sheet cancel to a normal of length zero, and nothing is divided by it",
          "[voxelize]") {
  Mesh sheet = quad({2, 4.5f, 2}, {2, 4.5f, 10}, {10, 4.5f, 10}, {10, 4.5f, 2});
  append(sheet, flipped(sheet));
  for (const VoxelOpacity opacity : {VoxelOpacity::occupied, VoxelOpacity::coverage}) {
    const SurfaceGrid surfaces = voxelize(scene_of(sheet), unit_grid(glm::ivec3(12)), {.opacity = opacity});
    REQUIRE(surfaces.size() == 64);
    for (size_t i = 0; i < surfaces.size(); ++i) {
      CHECK(surfaces.normal[i] == glm::vec3(0));
      CHECK(surfaces.area[i] == 2.0f);
      // Mean projection of the two sheets, 2 x 1/2, over the cube's, 3/2.
      CHECK(surfaces.albedo[i].a == Approx(opacity == VoxelOpacity::occupied ? 1.0 : 2.0 / 3.0));
    }
  }
}

TEST_CASE("coverage is the projected area over the voxel's, along the mean normal", "[voxelize]") {
  const auto opacity = [](const Mesh& mesh, const glm::ivec3& voxel) {
    const SurfaceGrid surfaces =
        voxelize(scene_of(mesh), unit_grid(glm::ivec3(8)), {.opacity = VoxelOpacity::coverage});
    return surfaces.albedo[find(surfaces, voxel).value()].a;
  };
  // A floor that ends at 3.25: a quarter of voxel 3.
  const Mesh floor = quad({1, 2.5f, 1}, {1, 2.5f, 5}, {3.25f, 2.5f, 5}, {3.25f, 2.5f, 1});
  CHECK(opacity(floor, {3, 2, 2}) == Approx(0.25));
  CHECK(opacity(floor, {2, 2, 2}) == Approx(1.0));
  // The plane x + y = 6 through the edges of voxels (2,3) and (3,2): 1 x sqrt 2 over the cube's projection 1 x sqrt 2.
  const Mesh slope = quad({1, 5, 1}, {5, 1, 1}, {5, 1, 5}, {1, 5, 5});
  CHECK(opacity(slope, {2, 3, 2}) == Approx(1.0));
  // Three sheets behind each other are not more than opaque.
  Mesh stack = floor;
  append(stack, moved(floor, {0, 0.25f, 0}));
  append(stack, moved(floor, {0, -0.25f, 0}));
  CHECK(opacity(stack, {2, 2, 2}) == 1.0f);
  CHECK(opacity(stack, {3, 2, 2}) == Approx(0.75));
}

TEST_CASE("degenerate triangles contribute nothing", "[voxelize]") {
  const Mesh wall = quad({2, 2, 4.5f}, {6, 2, 4.5f}, {6, 6, 4.5f}, {2, 6, 4.5f});
  Mesh mesh = wall;
  append(mesh, {{{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 2}}});  // a point
  append(mesh, {{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 2}}});  // an edge
  append(mesh, {{{1, 1, 1}, {1, 1, 1 + 1e-30f}, {1, 1e-38f + 1, 1}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 2}}});
  const SurfaceGrid clean = voxelize(scene_of(wall), unit_grid(glm::ivec3(8)), {}),
                    dirty = voxelize(scene_of(mesh), unit_grid(glm::ivec3(8)), {});
  CHECK(dirty.voxels == clean.voxels);
  CHECK(dirty.area == clean.area);
  CHECK(dirty.normal == clean.normal);
}

TEST_CASE("small triangles count, and those outside the grid are left out", "[voxelize]") {
  const auto triangle_at = [](const glm::vec3& corner, float size) {
    return Mesh{{corner, corner + glm::vec3(size, 0, 0), corner + glm::vec3(0, size, 0)},
                {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                {{0, 1, 2}}};
  };
  CHECK(voxelize(scene_of(triangle_at({3.5f, 3.5f, 3.5f}, 1e-3f)), unit_grid(glm::ivec3(8)), {}).size() == 1);
  CHECK(voxelize(scene_of(triangle_at({30, 3, 3}, 4.0f)), unit_grid(glm::ivec3(8)), {}).size() == 0);
  const SurfaceGrid partly = voxelize(scene_of(box(glm::vec3(-4.5f), glm::vec3(4.5f))), unit_grid(glm::ivec3(8)), {});
  CHECK(total_area(partly) == 3.0 * 4.5 * 4.5);
  CHECK(voxelize(Scene{}, unit_grid(glm::ivec3(4)), {}).size() == 0);
}

TEST_CASE("a normal without a length gives way to the triangle's, and one on the wrong side is turned", "[voxelize]") {
  Mesh mesh = quad({2, 2, 4.5f}, {6, 2, 4.5f}, {6, 6, 4.5f}, {2, 6, 4.5f});
  for (const glm::vec3& normal : {glm::vec3(0), glm::vec3(0, 0, -1), glm::vec3(0, 0, 1)}) {
    mesh.normals.assign(4, normal);
    for (const glm::vec3& mean : voxelize(scene_of(mesh), unit_grid(glm::ivec3(8)), {}).normal)
      CHECK(mean == glm::vec3(0, 0, 1));
  }
}

TEST_CASE("emission is kept where something emits, and its mean is weighted by area", "[voxelize]") {
  const Mesh square = quad({2, 2, 2.5f}, {3, 2, 2.5f}, {3, 3, 2.5f}, {2, 3, 2.5f});
  Scene scene = scene_of(square, emitter("lamp", glm::vec3(0), glm::vec3(4, 8, 12)));
  Mesh large = moved(square, {0, 0, 0.25f});
  append(large, moved(square, {0, 0, -0.25f}));
  append(large, moved(square, {0, 0, -0.125f}));
  add_object(scene, "dark", large, add_material(scene, lambertian("dark", glm::vec3(0.5f))));
  const SurfaceGrid surfaces = voxelize(scene, unit_grid(glm::ivec3(5)), {});
  REQUIRE(surfaces.size() == 1);
  CHECK(surfaces.emission[0] == glm::vec3(1, 2, 3));
  CHECK(surfaces.albedo[0] == glm::vec4(0.375f, 0.375f, 0.375f, 1.0f));
}

TEST_CASE("bytes counts what the arrays hold", "[voxelize]") {
  const SurfaceGrid surfaces = voxelize(triangle_soup(10, 20.0f), unit_grid(glm::ivec3(20)), {});
  const size_t per_voxel = sizeof(glm::ivec3) + sizeof(float) + sizeof(glm::vec4) + 3 * sizeof(glm::vec3);
  CHECK(surfaces.bytes() == surfaces.size() * per_voxel);
}
