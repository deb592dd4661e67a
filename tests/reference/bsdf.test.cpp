// Samples, densities and values against one another. Blind to a value that is wrong in itself, which
// distributions.test.cpp holds against the papers' formulas.
#include "reference/bsdf.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "catch.h"
#include "image/image.h"
#include "reference/chi_square.h"
#include "reference/reflectances.h"
#include "reference/sampler.h"

namespace voxref {

namespace {

Reflectance lambertian(float albedo) {
  Reflectance reflectance;
  reflectance.diffuse = glm::vec3(albedo);
  return reflectance;
}

BsdfSample draw(const Bsdf& bsdf, uint32_t i) {
  const Sampler sampler(randomization_key(7, i, 0, 0), 0);  // independent: each the first of its own randomization
  return bsdf.sample(sampler.get_1d(0), sampler.get_2d(1));
}

}  // namespace

TEST_CASE("Directions drawn from a BSDF follow its pdf", "[bsdf]") {
  // 9 tests at 0.1 % each, with bins even in (cosine, angle), so in solid angle. Directions below the horizon carry
  // nothing and are drawn by nobody; they are a bin of their own, which takes what the pdf leaves to 1.
  constexpr int side = 16, parts = 12, count = 1 << 16;
  for (const Reflectance& reflectance : {lambertian(0.5f), metal(0.3f), plastic(0.25f)})
    for (const float cosine : {0.95f, 0.5f, 0.1f}) {
      const SurfacePoint point = flat_point(reflectance);
      const Bsdf bsdf(point, direction(cosine, 0.4f));
      std::vector<double> observed(side * side + 1), expected(side * side + 1);
      for (uint32_t i = 0; i < count; ++i) {
        const BsdfSample sample = draw(bsdf, i);
        size_t bin = side * side;
        if (sample) {
          CHECK(sample.pdf == Approx(bsdf.pdf(sample.in)));
          const float turn = std::atan2(sample.in.y, sample.in.x) / (2.0f * std::numbers::pi_v<float>)+0.5f;
          bin = static_cast<size_t>(std::min(static_cast<int>(sample.in.z * side), side - 1) * side +
                                    std::min(static_cast<int>(turn * side), side - 1));
        }
        observed[bin] += 1.0;
      }
      double total = 0.0;
      for (int i = 0; i < side * parts; ++i)
        for (int j = 0; j < side * parts; ++j) {
          const float turn = (static_cast<float>(j) + 0.5f) / (side * parts) - 0.5f;
          const glm::vec3 in =
              direction((static_cast<float>(i) + 0.5f) / (side * parts), 2.0f * std::numbers::pi_v<float> * turn);
          const double share = bsdf.pdf(in) * 2.0 * std::numbers::pi / (side * parts * side * parts);
          expected[static_cast<size_t>(i / parts * side + j / parts)] += share * count;
          total += share;
        }
      CAPTURE(cosine, reflectance.alpha);
      CHECK(total < 1.0 + 1e-3);  // the quadrature's error
      expected.back() = std::max(0.0, 1.0 - total) * count;
      CHECK(chi_square_p(observed, expected) > 0.001);
    }
}

TEST_CASE("Sample weights average to the directional albedo, which for a metal never exceeds one", "[bsdf]") {
  // White furnace: light 1 from everywhere. The lobe alone loses what facets throw at each other; the tables of the
  // shared specular_albedo() hold the same integral by another method, to 0.002.
  constexpr uint32_t count = 1 << 15;
  for (const float alpha : {0.001f, 0.05f, 0.3f, 1.0f})
    for (const float cosine : {1.0f, 0.6f, 0.2f}) {
      for (const Reflectance& reflectance : {metal(alpha), plastic(alpha)}) {
        const SurfacePoint point = flat_point(reflectance);
        const Bsdf bsdf(point, direction(cosine, 1.0f));
        double sum = 0.0, squares = 0.0;
        for (uint32_t i = 0; i < count; ++i) {
          const BsdfSample sample = draw(bsdf, i);
          const double weight = sample ? sample.weight.g : 0.0;
          sum += weight;
          squares += weight * weight;
        }
        const double mean = sum / count;
        const double error = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
        const double expected = specular_albedo(reflectance, cosine).g + diffuse_albedo(reflectance, cosine).g;
        CAPTURE(alpha, cosine, reflectance.diffuse.g);
        // Four standard errors, the table's 0.002 for each of its two parts, and float32's resolution of the narrowest
        // lobe.
        CHECK(std::abs(mean - expected) < 4.0 * error + 0.004);
        // glTF's layer takes from its base by the angle to the half vector, which at grazing is less than what the lobe
        // reflects: white plastic gives back up to 1.2. That is the model's, so only the lobe alone is held to 1.
        if (!reflectance.has_diffuse()) CHECK(mean < 1.0 + 4.0 * error + 1e-5);
      }
    }
}

TEST_CASE("The value is evaluate() times the cosine, for a Lambertian surface too", "[bsdf]") {
  for (const Reflectance& reflectance : {lambertian(0.5f), metal(0.3f), plastic(0.25f)}) {
    const SurfacePoint point = flat_point(reflectance);
    const glm::vec3 out = direction(0.8f, 0.0f), in = direction(0.3f, 2.0f);
    const glm::vec3 expected = 0.3f * evaluate(reflectance, point.shading_normal, out, in);
    CHECK(Bsdf(point, out).value(in).g == Approx(expected.g).epsilon(1e-6));
  }
}

TEST_CASE("A direction behind the geometric surface carries nothing", "[bsdf]") {
  SurfacePoint point = flat_point(plastic(0.3f));
  point.shading_normal = glm::normalize(glm::vec3(0.6f, 0.0f, 0.8f));
  const Bsdf bsdf(point, direction(0.9f, 0.0f));
  const glm::vec3 behind = glm::normalize(glm::vec3(0.9f, 0.0f, -0.1f));
  REQUIRE(glm::dot(point.shading_normal, behind) > 0.0f);
  CHECK(bsdf.value(behind) == glm::vec3(0.0f));
  CHECK(bsdf.value(direction(0.5f, 0.0f)) != glm::vec3(0.0f));
  for (uint32_t i = 0; i < 1000; ++i)
    if (const BsdfSample sample = draw(bsdf, i)) CHECK(sample.in.z > 0.0f);
}

}  // namespace voxref
