#include "reference/light_sampling.h"

#include <cmath>
#include <vector>

#include "catch.h"
#include "reference/sampler.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

Light point_light(const glm::vec3& position, float intensity) {
  Light light;
  light.position = position;
  light.intensity = glm::vec3(intensity);
  return light;
}

/// Solid angle of a triangle seen from the origin: Van Oosterom and Strackee 1983.
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  return 2.0 * std::atan2(numerator, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

}  // namespace

TEST_CASE("The chosen punctual light's irradiance over its probability averages to the sum over all",
          "[light_sampling]") {
  for (const int count : {1, 3, 40}) {  // alone, few and many
    Scene scene;
    add_floor(scene, 5.0f, add_material(scene, lambert(glm::vec3(0.5f))));
    for (int i = 0; i < count; ++i) {
      const auto x = static_cast<float>(i);
      scene.lights.push_back(point_light({std::sin(x), 1.0f + 0.1f * x, std::cos(x)}, 1.0f + x));
      if (i % 5 == 1) scene.lights.back().type = LightType::directional;
      if (i % 5 == 2) scene.lights.back().type = LightType::spot;
      scene.lights.back().direction = glm::normalize(glm::vec3(0.1f * std::sin(3.0f * x), -1.0f, 0.2f));
    }
    const glm::vec3 point(0.2f, 0.0f, 0.1f), normal(0.0f, 1.0f, 0.0f);
    double expected = 0.0;
    for (const Light& light : scene.lights) {
      const Illumination seen = illuminate(light, point);
      expected += seen.irradiance.g * std::max(glm::dot(normal, seen.to_light), 0.0f);
    }
    const Materials materials(scene);
    const LightSampler lights(scene, materials);
    constexpr uint32_t steps = 1u << 16;
    double sum = 0.0;
    for (uint32_t i = 0; i < steps; ++i) {
      const auto sample = lights.sample_punctual({point, normal}, i * 65536u + 32768u);
      if (sample) sum += sample->irradiance.g * std::max(glm::dot(normal, sample->to_light), 0.0f);
    }
    // A midpoint rule over a step function of at most 41 pieces: each end is off by one of 65536 at most, of values
    // within ten times the mean.
    CHECK(sum / steps == Approx(expected).epsilon(count == 1 ? 1e-5 : 1e-2 * count / 40 + 1e-4));
  }
}

TEST_CASE("Emissive triangles are sampled with the stated density", "[light_sampling]") {
  Scene scene;
  const uint32_t bright = add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(9.0f)));
  const uint32_t dim = add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(1.0f)));
  add_quad(scene, {-0.5f, 1.0f, -0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, bright);
  add_quad(scene, {1.0f, 0.0f, -1.0f}, {0.0f, 0.0f, 2.0f}, {0.0f, 2.0f, 0.0f}, dim);
  const Materials materials(scene);
  const LightSampler lights(scene, materials);
  const Receiver receiver = {{0.0f, 0.0f, 0.0f}, glm::normalize(glm::vec3(0.7f, 0.7f, 0.0f))};  // sees both whole
  double expected = 0.0;  // the solid angle of all, in double
  for (const glm::uvec3& t : scene.triangles)
    expected += solid_angle(scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]);
  // The mean of 1 / pdf over samples that follow the pdf is the measure of what they cover.
  constexpr uint32_t count = 1u << 16;
  double sum = 0.0, squares = 0.0;
  for (uint32_t i = 0; i < count; ++i) {
    const Sampler sampler(randomization_key(5, i, 0, 0), 0);
    const auto sample = lights.sample_emitter(receiver, sampler.bits_2d(1));
    REQUIRE(sample);
    const double weight = 1.0 / sample->pdf;
    sum += weight;
    squares += weight * weight;
    const uint32_t triangle = sample->radiance.g == 9.0f ? 0 : 2;  // both triangles of a quad have the same density
    CHECK(lights.emitter_pdf(receiver, triangle, sample->to_light, glm::length(sample->position)) ==
          Approx(sample->pdf).epsilon(1e-5));
  }
  const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
  CHECK(std::abs(mean - expected) < 4.0 * error);
  CHECK(error < 0.01 * expected);
}

TEST_CASE("Emission leaves the front only, unless the material is double-sided", "[light_sampling]") {
  for (const bool double_sided : {false, true}) {
    Scene scene;
    Material material = lambert(glm::vec3(0.0f), glm::vec3(1.0f));
    material.double_sided = double_sided;
    add_floor(scene, 1.0f, add_material(scene, material));
    const Materials materials(scene);
    const LightSampler lights(scene, materials);
    CHECK(lights.sample_emitter({{0.0f, 1.0f, 0.0f}, {0.0f, -1.0f, 0.0f}}, {1u << 30, 3u << 30}).has_value());
    const auto below = lights.sample_emitter({{0.0f, -1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}, {1u << 30, 3u << 30});
    CHECK(below.has_value() == double_sided);
    if (below) CHECK(below->normal.y < 0.0f);
  }
}

}  // namespace voxref
