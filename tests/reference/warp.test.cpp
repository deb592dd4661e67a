#include "reference/warp.h"

#include <vector>

#include "catch.h"
#include "reference/chi_square.h"
#include "reference/sampler.h"

namespace voxref {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Direction at the centre of cell (i,j) of a grid over (cosine, angle), which has equal solid angles.
glm::vec3 hemisphere_direction(float cosine, float angle) {
  const float sine = std::sqrt(1.0f - cosine * cosine);
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

float angle_of(const glm::vec3& v) {
  const float angle = std::atan2(v.y, v.x);
  return angle < 0.0f ? angle + 2.0f * pi : angle;
}

/// Masking and distribution as the papers print them, apart from the code under test.
double ggx_masking(double cosine, double alpha) {
  const double tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
  return 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * tangent2));
}
double ggx_density(double cosine, double alpha) {
  const double tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
  const double cosine4 = cosine * cosine * cosine * cosine;
  const double term = alpha * alpha + tangent2;
  return alpha * alpha / (std::numbers::pi * cosine4 * term * term);
}

}  // namespace

TEST_CASE("Cosine and sine of a turn are those of the C library in double", "[warp]") {
  double worst = 0.0;
  constexpr int steps = 100000;  // 0, 1 and the borders between quarters are among them
  for (int i = 0; i <= steps; ++i) {
    const float turns = static_cast<float>(i) / steps;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(turns);
    const glm::vec2 pair = cos_sin_of_turns(turns);
    worst = std::max({worst, std::abs(pair.x - std::cos(angle)), std::abs(pair.y - std::sin(angle))});
  }
  CHECK(worst < 1e-7);  // as promised; half a unit in the last place just below 1 is 3e-8
}

TEST_CASE("A frame is orthonormal and right-handed for normals all around", "[warp]") {
  for (uint32_t i = 0; i < 1000; ++i) {
    const glm::vec2 u = Sampler(1, i).get_2d(0);
    const float z = i == 0 ? 1.0f : i == 1 ? -1.0f : 2.0f * u.x - 1.0f;
    const float radius = std::sqrt(1.0f - z * z);
    const glm::vec3 normal(radius * std::cos(2.0f * pi * u.y), radius * std::sin(2.0f * pi * u.y), z);
    const Frame frame(normal);
    // A few roundings of numbers up to 1.
    CHECK(glm::length(glm::cross(frame.x, frame.y) - frame.z) < 1e-6f);
    CHECK(std::abs(glm::dot(frame.x, frame.y)) < 1e-6f);
    const glm::vec3 local(0.3f, -0.5f, 0.7f);
    CHECK(glm::length(frame.to_local(frame.to_world(local)) - local) < 1e-6f);
  }
}

TEST_CASE("Inverse warps return what was warped", "[warp]") {
  for (uint32_t i = 0; i < 1000; ++i) {
    const glm::vec2 u = Sampler(2, i).get_2d(0);
    const glm::vec3 cosine = cosine_hemisphere(u);
    CHECK(glm::length(cosine) == Approx(1.0f).epsilon(1e-6));
    const glm::vec2 from_cosine(1.0f - cosine.z * cosine.z, angle_of(cosine) / (2.0f * pi));
    CHECK(glm::length(from_cosine - u) < 1e-5f);  // 1 - z^2 cancels where u.x is small, to a few 1e-7

    const glm::vec2 uv = uniform_triangle(u);
    CHECK((uv.x >= 0.0f && uv.y >= 0.0f && uv.x + uv.y <= 1.0f + 1e-6f));
    const float root = uv.x + uv.y;
    // u.y is a quotient by the root, which amplifies rounding near the corner.
    CHECK(std::abs(root * root - u.x) < 1e-6f);
    CHECK(std::abs(uv.y - root * u.y) < 1e-6f);
  }
}

TEST_CASE("Visible GGX normals follow their density", "[warp]") {
  // 12 tests at 0.1 % each. The bins' expectation is integrated numerically, 64 x 64 points per bin. 2^17 samples in
  // 256 bins see a density that is wrong by 6 % in most of them.
  constexpr int side = 16, parts = 64, count = 1 << 17;
  for (const float alpha : {0.15f, 0.4f, 1.0f})
    for (const float cosine : {1.0f, 0.7f, 0.3f, 0.05f}) {
      const glm::vec3 out = hemisphere_direction(cosine, 0.8f);
      std::vector<double> observed(side * side), expected(side * side);
      for (uint32_t i = 0; i < count; ++i) {
        // Independent samples, as the test assumes: each the first of its own randomization.
        const glm::vec3 h = visible_ggx_normal(out, alpha, Sampler(randomization_key(3, i, 0, 0), 0).get_2d(0));
        REQUIRE(glm::length(h) == Approx(1.0f).epsilon(1e-5));
        const int row = std::min(static_cast<int>(h.z * side), side - 1);
        const int column = std::min(static_cast<int>(angle_of(h) / (2.0f * pi) * side), side - 1);
        observed[static_cast<size_t>(row * side + column)] += 1.0;
      }
      for (int i = 0; i < side * parts; ++i)
        for (int j = 0; j < side * parts; ++j) {
          const float z = (static_cast<float>(i) + 0.5f) / (side * parts);
          const glm::vec3 h = hemisphere_direction(z, 2.0f * pi * (static_cast<float>(j) + 0.5f) / (side * parts));
          const double density =
              ggx_masking(out.z, alpha) * ggx_density(z, alpha) * std::max(glm::dot(out, h), 0.0f) / out.z;
          expected[static_cast<size_t>(i / parts * side + j / parts)] +=
              density * 2.0 * std::numbers::pi / (side * parts * side * parts) * count;
        }
      CAPTURE(alpha, cosine);
      CHECK(chi_square_p(observed, expected) > 0.001);
    }
}

}  // namespace voxref
