#include "scene/caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "catch.h"

using namespace voxref;

namespace {

/// Random triangles in the unit cube around the origin.
Scene triangle_soup(size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  Scene scene;
  scene.materials.resize(1);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 center(uniform(random), uniform(random), uniform(random));
    for (int k = 0; k < 3; ++k)
      scene.positions.push_back(center + 0.3f * glm::vec3(uniform(random), uniform(random), uniform(random)));
    scene.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  scene.normals.assign(scene.positions.size(), {0.0f, 0.0f, 1.0f});
  scene.triangle_materials.assign(count, 0);
  scene.objects = {{"soup", 0, static_cast<uint32_t>(count), 0, false}};
  return scene;
}

/// Moeller and Trumbore 1997 in double, over all triangles: the slow second opinion.
Hit closest_by_search(const Scene& scene, const Ray& ray) {
  Hit best;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const glm::dvec3 a = scene.positions[scene.triangles[i].x];
    const glm::dvec3 e1 = glm::dvec3(scene.positions[scene.triangles[i].y]) - a;
    const glm::dvec3 e2 = glm::dvec3(scene.positions[scene.triangles[i].z]) - a;
    const glm::dvec3 d(ray.direction);
    const glm::dvec3 p = glm::cross(d, e2);
    const double det = glm::dot(e1, p);
    if (det == 0.0) continue;
    const glm::dvec3 s = glm::dvec3(ray.origin) - a;
    const double u = glm::dot(s, p) / det;
    const glm::dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(d, q) / det, t = glm::dot(e2, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t < ray.tmin || t > std::min(ray.tmax, best.t)) continue;
    best = {i, {static_cast<float>(u), static_cast<float>(v)}, static_cast<float>(t)};
  }
  return best;
}

/// A unit square in the plane z = 0 whose left half is a hole of its mask, before an opaque one at z = -1.
Scene square_with_hole() {
  Scene scene;
  for (const float z : {0.0f, -1.0f})
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
      scene.positions.emplace_back(corner, z);
      scene.uv[0].push_back(corner);
    }
  scene.normals.assign(8, {0.0f, 0.0f, 1.0f});
  scene.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  scene.triangle_materials = {0, 0, 1, 1};
  scene.objects = {{"mask", 0, 2, 0, false}, {"wall", 2, 2, 1, false}};
  scene.images.resize(1);
  scene.images[0].width = 2;
  scene.images[0].height = 1;
  scene.images[0].texels8 = {255, 255, 255, 0, 255, 255, 255, 255};
  scene.materials.resize(2);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].base_color_texture.image = 0;
  scene.materials[0].base_color_texture.nearest = true;
  return scene;
}

}  // namespace

TEST_CASE("the caster finds what a search over all triangles finds", "[caster]") {
  const Scene scene = triangle_soup(300);
  const Caster caster(scene);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  int hits = 0, different = 0;
  for (int i = 0; i < 2000; ++i) {
    Ray ray;
    ray.origin = 1.5f * glm::vec3(uniform(random), uniform(random), uniform(random));
    ray.direction = glm::vec3(uniform(random), uniform(random), uniform(random));
    const Hit fast = caster.closest(ray), slow = closest_by_search(scene, ray);
    hits += bool(slow);
    different += fast.triangle != slow.triangle;
    if (fast && fast.triangle == slow.triangle) {
      // t relative to a scene of size 1 in float32, over a direction that may be short.
      CHECK(fast.t == Approx(slow.t).epsilon(1e-4).margin(1e-4));
      CHECK(glm::distance(fast.uv, slow.uv) < 1e-3f);
    }
    CHECK(caster.occluded(ray) == bool(fast));
  }
  CHECK(hits > 200);
  // A ray through an edge within rounding may go to either triangle; none of these 2000 random ones should.
  CHECK(different <= 1);
}

TEST_CASE("packets of rays find what single rays find", "[caster]") {
  // Small and large scenes and lists of rays take different ways, and so do rays from one point.
  const Scene large = triangle_soup(300), small = triangle_soup(200), mask = square_with_hole();
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  const auto in_cube = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
  for (const Scene* scene : {&large, &small, &mask})
    for (const size_t count : {37, 2500})  // 37: two whole packets, and one with room left
      for (const bool one_origin : {false, true}) {
        CAPTURE(scene->triangles.size(), count, one_origin);
        const Caster caster(*scene);
        std::vector<Ray> rays(count);
        for (size_t i = 0; i < count; ++i) {
          rays[i].origin = one_origin && i > 0 ? rays[0].origin : 1.5f * in_cube();
          rays[i].direction = scene->bounds().center() - rays[i].origin + 0.5f * in_cube();
          if (i % 3 == 0) rays[i].tmax = 0.4f;  // a segment that ends early
        }
        std::vector<Hit> hits(count);
        std::vector<uint8_t> blocked(count);
        caster.closest(rays, hits);
        caster.occluded(rays, blocked);
        size_t found = 0, different = 0;
        for (size_t i = 0; i < count; ++i) {
          const Hit single = caster.closest(rays[i]);
          different += hits[i].triangle != single.triangle || bool(blocked[i]) != bool(single);
          // Other instructions, other rounding.
          if (single && hits[i].triangle == single.triangle) CHECK(hits[i].t == Approx(single.t).epsilon(1e-5));
          found += bool(single);
        }
        CHECK(different <= count / 1000);  // a ray through an edge within rounding may go to either triangle
        CHECK(found > count / 20);
        CHECK(found < count);
        caster.closest(std::span<const Ray>(), std::span<Hit>());
      }
}

TEST_CASE("a segment's ends bound what occludes it", "[caster]") {
  const Scene scene = square_with_hole();
  const Caster caster(scene);
  CHECK(caster.occluded({{0.75f, 0.5f, 1.0f}, {0, 0, -1}, 0.0f, 1.5f}));
  CHECK_FALSE(caster.occluded({{0.75f, 0.5f, 1.0f}, {0, 0, -1}, 0.0f, 0.5f}));
  CHECK_FALSE(caster.occluded({{0.75f, 0.5f, 1.0f}, {0, 0, -1}, 1.5f, 1.9f}));
  CHECK_FALSE(caster.visible({0.75f, 0.5f, 1.0f}, {0.75f, 0.5f, -0.5f}));
  CHECK(caster.visible({0.75f, 0.5f, -0.1f}, {0.25f, 0.5f, -0.9f}));
}

TEST_CASE("rays pass the holes of a mask and hit what lies behind", "[caster]") {
  const Scene scene = square_with_hole();
  const Caster caster(scene);
  const auto down = [&](float x) { return Ray{{x, 0.3f, 1.0f}, {0, 0, -1}}; };
  CHECK(caster.closest(down(0.75f)).t == 1.0f);
  CHECK(caster.closest(down(0.25f)).t == 2.0f);
  CHECK(caster.closest(down(0.25f)).triangle >= 2);
  CHECK(caster.visible({0.25f, 0.3f, 1.0f}, {0.25f, 0.3f, -0.5f}));
}

TEST_CASE("a ray that leaves a surface does not meet it again", "[caster]") {
  const Scene scene = triangle_soup(300);
  const Caster caster(scene);
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (uint32_t i = 0; i < 300; ++i) {
    const glm::vec3 a = scene.positions[3 * i], b = scene.positions[3 * i + 1], c = scene.positions[3 * i + 2];
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const float u = 0.5f * uniform(random), v = 0.5f * uniform(random);
    const glm::vec3 grazing = glm::normalize(b - a) + 0.01f * normal;
    CHECK(caster.closest(caster.leave((1.0f - u - v) * a + u * b + v * c, normal, grazing)).triangle != i);
  }
}

TEST_CASE("a scene without triangles has nothing to hit", "[caster]") {
  const Scene scene;
  const Caster caster(scene);
  CHECK_FALSE(caster.closest({{0, 0, 0}, {0, 0, 1}}));
  CHECK_FALSE(caster.occluded({{0, 0, 0}, {0, 0, 1}}));
}
