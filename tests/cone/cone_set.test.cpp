#include "cone/cone_set.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "catch.h"
#include "error.h"
#include "scene/reflectance.h"

using namespace std::numbers;
using namespace voxref;

TEST_CASE("A set's cells share the hemisphere: solid angles 2 pi / count, cosine weights that sum to pi",
          "[cone_set]") {
  for (const int count : {1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 32, 100, 1024, 16384}) {
    CAPTURE(count);
    const std::vector<Cone> cones = partition_hemisphere(count);
    REQUIRE(cones.size() == size_t(count));
    double sum = 0.0;
    for (const Cone& cone : cones) {
      sum += cone.weight;
      CHECK(glm::length(cone.direction) == Approx(1.0f).epsilon(1e-6));
      CHECK(cone.direction.z > 0.0f);
      // One cone is held to 60 degrees, the half-angle of one.
      const double cos_half_angle = 1.0 / std::sqrt(1.0 + double(cone.tan_half_angle) * cone.tan_half_angle);
      CHECK(1.0 - cos_half_angle == Approx(1.0 / std::max(count, 2)).epsilon(1e-3));  // float cancellation at 16384
    }
    CHECK(sum == Approx(pi).epsilon(1e-5));  // of up to 16384 float weights
  }
}

TEST_CASE("Weighted mean directions of a set add up to the hemisphere's, 2 pi / 3 along the normal", "[cone_set]") {
  // The first moment of the cosine over the hemisphere: integral of cos(t) w dw = (0, 0, 2 pi / 3). Directions are
  // unit, so that a finite set is too long by the spread within its cells, which shrinks as 1 / count.
  for (const int count : {6, 32, 128, 1024}) {
    CAPTURE(count);
    glm::dvec3 sum(0.0);
    for (const Cone& cone : partition_hemisphere(count)) sum += double(cone.weight) * glm::dvec3(cone.direction);
    CHECK(std::abs(sum.x) < 1e-5);
    CHECK(std::abs(sum.y) < 1e-5);
    CHECK(sum.z >= 2.0 * pi / 3.0);
    CHECK(sum.z <= 2.0 * pi / 3.0 * (1.0 + 1.0 / count));
  }
}

TEST_CASE("Irradiance of a radiance L = cos converges to 2 pi / 3 and beats the published set at six cones",
          "[cone_set]") {
  // The published six return 1.143 of the truth (spec section 8).
  const auto ratio = [](int count) {
    double sum = 0.0;
    for (const Cone& cone : partition_hemisphere(count)) sum += double(cone.weight) * cone.direction.z;
    return sum / (2.0 * pi / 3.0);
  };
  CHECK(ratio(6) < 1.143);
  double previous = ratio(4) - 1.0;
  for (const int count : {16, 64, 256, 1024}) {
    const double error = ratio(count) - 1.0;
    CHECK(error > 0.0);
    CHECK(error <
          0.4 * previous);  // the error is that of a midpoint rule in two dimensions: 1/4 per four times as many
    previous = error;
  }
}

TEST_CASE("A set has a cell at the pole and rings of at least three", "[cone_set]") {
  for (const int count : {4, 6, 9, 16, 32, 1024}) {
    const std::vector<Cone> cones = partition_hemisphere(count);
    CHECK(cones[0].direction.z == Approx(1.0f).epsilon(1e-7));
    CHECK(cones[1].direction.z == Approx(cones[3].direction.z).epsilon(1e-6));
  }
}

TEST_CASE("Coverage of circular cones: one cone's cap is all there is, more cones overlap as much as they leave gaps",
          "[cone_set]") {
  const voxref::Coverage one = coverage({{glm::vec3(0, 0, 1), 1.0f, 1.0f}});
  CHECK(std::abs(one.covered - (1.0 - std::sqrt(0.5))) < 0.5 / 128);  // the cap of 45 degrees, by 128 rows
  CHECK(one.overlap == 0.0);
  for (const int count : {6, 32, 256}) {
    CAPTURE(count);
    const voxref::Coverage c = coverage(partition_hemisphere(count));
    // Circles have their cells' solid angle: what they leave out they cover elsewhere, twice or below the horizon.
    CHECK(c.covered > 0.8);
    CHECK(c.covered <= 1.0);
    CHECK(c.overlap < 0.2);
  }
}

TEST_CASE("A cone count out of range is refused", "[cone_set]") {
  CHECK_THROWS_AS(partition_hemisphere(0), voxref::Error);
  CHECK_THROWS_AS(partition_hemisphere(16385), voxref::Error);
}

TEST_CASE("A frame around a normal is right-handed and orthonormal, at the poles too", "[cone_set]") {
  for (const glm::vec3 direction : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 2, -3),
                                    glm::vec3(-1, 0, 1e-8f), glm::vec3(1e-4f, 1e-4f, -1), glm::vec3(0, -1, -0.0f)}) {
    const glm::vec3 n = glm::normalize(direction);
    const glm::mat3 frame = frame_around(n);
    CHECK(frame[2] == n);
    CHECK(glm::determinant(frame) == Approx(1.0f).epsilon(1e-5));
    const glm::mat3 identity = glm::transpose(frame) * frame;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) CHECK(std::abs(identity[i][j] - float(i == j)) < 1e-6f);
  }
}

namespace {

/// Mean direction length of the lobe at normal incidence by brute force over outgoing directions, not half-vectors.
double lobe_mean_cosine(double alpha) {
  constexpr int steps = 400000;
  double lobe = 0.0, moment = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) / steps, theta = 0.5 * pi * x * x * x;  // dense near the mirror direction
    const double jacobian = 1.5 * pi * x * x * std::sin(theta);
    const float n_l = float(std::cos(theta));
    const glm::vec3 normal(0.0f, 0.0f, 1.0f), half(std::sin(0.5 * theta), 0.0, std::cos(0.5 * theta));
    const double weight = double(ggx_distribution(normal, half, float(alpha))) *
                          ggx_visibility(n_l, 1.0f, float(alpha)) * std::cos(theta) * jacobian;
    lobe += weight;
    moment += weight * std::cos(theta);
  }
  return moment / lobe;
}

}  // namespace

TEST_CASE("The specular cone has the GGX lobe's mean direction length", "[cone_set]") {
  for (const float roughness : {0.25f, 0.4f, 0.55f, 0.7f, 0.85f, 1.0f}) {
    CAPTURE(roughness);
    const float alpha = roughness * roughness, tangent = specular_tan_half_angle(alpha);
    const double uniform = 0.5 * (1.0 + 1.0 / std::sqrt(1.0 + double(tangent) * tangent));
    // 1 - m within 1 %: interpolation between 64 entries, and n.h in float for narrow lobes.
    CHECK(1.0 - uniform == Approx(1.0 - lobe_mean_cosine(alpha)).epsilon(0.01));
  }
}

TEST_CASE("The specular cone widens with roughness, from a mirror's up", "[cone_set]") {
  float previous = 0.0f;
  for (int i = 0; i <= 1000; ++i) {
    const float tangent = specular_tan_half_angle(float(i) / 1000.0f);
    CHECK(tangent >= previous);
    previous = tangent;
  }
  CHECK(specular_tan_half_angle(0.0f) == specular_tan_half_angle(voxref::Reflectance::min_alpha));
  CHECK(specular_tan_half_angle(0.0f) < 0.01f);
}

namespace {

/// Sum of weight x the mean of `cosine to the normal` over each cone, over its true value for a hemisphere of radiance
/// L = cos, 2 pi / 3.
double returned_of_cosine_light(const std::vector<Cone>& cones) {
  double sum = 0.0;
  for (const Cone& cone : cones) {
    const double cos_half_angle = 1.0 / std::hypot(1.0, double(cone.tan_half_angle));
    // The mean direction of a cone of half-angle a has the length (1 + cos a) / 2.
    sum += double(cone.weight) * double(cone.direction.z) * 0.5 * (1.0 + cos_half_angle);
  }
  return sum / (2.0 * std::numbers::pi / 3.0);
}

}  // namespace

TEST_CASE("The published cones weigh pi together, and return 1.143 and 1.189 of light that goes with the cosine",
          "[cone_set]") {
  for (const auto& [cones, returned] : {std::pair(villegas6_cones(), 1.143), std::pair(villegas4_cones(), 1.189)}) {
    double weight = 0.0;
    for (const Cone& cone : cones) {
      weight += double(cone.weight);
      CHECK(glm::length(cone.direction) == Approx(1.0f).epsilon(1e-6));
    }
    CHECK(weight == Approx(std::numbers::pi).epsilon(1e-6));
    CHECK(returned_of_cosine_light(cones) == Approx(returned).epsilon(1e-3));  // four digits
  }
  CHECK(glm::degrees(std::acos(villegas6_cones()[1].direction.z)) == Approx(40.9f).epsilon(1e-3));
  // The project's own six return it to within what cells about 60 degrees wide can.
  CHECK(returned_of_cosine_light(partition_hemisphere(6)) == Approx(1.0).epsilon(0.09));
}

TEST_CASE("The published frame is guided by +Y, and by +Z where the normal is +-Y exactly", "[cone_set]") {
  for (const glm::vec3& n : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0.6f, 0.0f, -0.8f),
                             glm::normalize(glm::vec3(1e-3f, 1.0f, 0.0f))}) {
    const glm::mat3 frame = guided_frame(n);
    const glm::vec3 guide = std::abs(n.y) == 1.0f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
    CHECK(frame[2] == n);
    CHECK(glm::dot(frame[0], n) == Approx(0.0f).margin(1e-4));  // near +Y the difference cancels but for 1e-3
    CHECK(glm::dot(frame[0], guide) > 0.0f);
    CHECK(glm::determinant(frame) == Approx(-1.0f).epsilon(1e-5));  // U = R x n
  }
  // The rule's two sides: a normal that is +Y but for rounding has R towards -x, where it leans away.
  CHECK(guided_frame(glm::normalize(glm::vec3(1e-3f, 1.0f, 0.0f)))[0].x == Approx(-1.0f).epsilon(1e-5));
}

TEST_CASE("The published specular cone takes the tangent of an angle, clamped as if it were one", "[cone_set]") {
  CHECK(published_specular_tan_half_angle(0.5f) == Approx(1.0f).epsilon(1e-5));
  CHECK(published_specular_tan_half_angle(1.0f) == 0.0174533f);
  CHECK(published_specular_tan_half_angle(0.0f) == Approx(std::numbers::pi).epsilon(1e-6));
}
