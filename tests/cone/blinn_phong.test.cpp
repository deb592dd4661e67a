#include "cone/blinn_phong.h"

#include <cmath>
#include <functional>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "catch.h"
#include "scene/reflectance.h"

using namespace voxref;

namespace {

constexpr float pi = std::numbers::pi_v<float>;
const glm::vec3 up(0.0f, 0.0f, 1.0f);

glm::vec3 direction(float polar_degrees, float azimuth_degrees) {
  const float t = glm::radians(polar_degrees), p = glm::radians(azimuth_degrees);
  return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}

/// A model of reflection: value for light from `in` that leaves towards `out`, without the cosine, 1/sr.
using Model = std::function<float(const glm::vec3& out, const glm::vec3& in)>;

/// Largest relative difference of f(a, b) and f(b, a) over pairs of directions (thesis eq. 1.5 asks for none).
float asymmetry(const Model& model) {
  float largest = 0.0f;
  for (const float a : {10.0f, 35.0f, 60.0f, 80.0f})
    for (const float b : {20.0f, 50.0f, 75.0f})
      for (const float azimuth : {0.0f, 90.0f, 170.0f, 180.0f}) {
        const glm::vec3 x = direction(a, 0.0f), y = direction(b, azimuth);
        const float f = model(x, y), g = model(y, x);
        largest = std::max(largest, std::abs(f - g) / std::max({f, g, 1e-6f}));
      }
  return largest;
}

/// Share of a light beam that is sent back, the greatest over its angles (thesis eq. 1.6 asks for at most 1), by
/// quadrature over the hemisphere: 256 x 512 directions of equal projected solid angle, error below 1 %.
float largest_albedo(const Model& model) {
  constexpr int rows = 256, columns = 512;
  float largest = 0.0f;
  for (const float angle : {0.0f, 30.0f, 60.0f, 80.0f, 88.0f}) {
    const glm::vec3 in = direction(angle, 0.0f);
    double sum = 0.0;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const float r2 = (float(row) + 0.5f) / rows, phi = 2.0f * pi * (float(column) + 0.5f) / columns;
        const float r = std::sqrt(r2);
        sum += model({r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - r2)}, in);
      }
    largest = std::max(largest, float(sum * pi / (rows * columns)));
  }
  return largest;
}

/// Light reflected by plain Phong (thesis eq. 1.10), Kd (n.l) + Ks (r.v)^p, as a BRDF: over n.l.
float plain_phong(const glm::vec3& out, const glm::vec3& in, float kd, float ks, float power) {
  const glm::vec3 mirrored = glm::reflect(-in, up);
  return kd + ks * std::pow(std::max(glm::dot(mirrored, out), 0.0f), power) / in.z;
}

Model blinn_phong(const PhongMaterial& material, const BlinnPhongOptions& options) {
  return [=](const glm::vec3& out, const glm::vec3& in) { return evaluate(material, up, out, in, options).r; };
}

PhongMaterial material(float kd, float ks, float s) { return {glm::vec3(kd), glm::vec3(ks), s, glm::vec3(0.0f)}; }

}  // namespace

TEST_CASE("Lambert, GGX and Blinn-Phong are reciprocal, plain Phong is not", "[blinn_phong]") {
  Reflectance glossy;
  glossy.diffuse = glm::vec3(0.5f);
  glossy.specular_f0 = glm::vec3(0.3f), glossy.specular_f1 = glm::vec3(0.7f);
  glossy.alpha = 0.3f;
  const Model ggx = [&](const glm::vec3& out, const glm::vec3& in) { return evaluate(glossy, up, out, in).r; };
  constexpr float rounding = 1e-4f;  // of float32 powers up to 2^8
  CHECK(asymmetry([](const glm::vec3&, const glm::vec3&) { return 0.5f / pi; }) == 0.0f);
  CHECK(asymmetry(ggx) < rounding);
  CHECK(asymmetry(blinn_phong(material(0.5f, 0.3f, 0.6f), {})) < rounding);
  CHECK(asymmetry(blinn_phong(material(0.5f, 0.3f, 0.6f), {false, 2.2f, true})) < rounding);  // the published one too
  CHECK(asymmetry([](const glm::vec3& out, const glm::vec3& in) { return plain_phong(out, in, 0.2f, 0.5f, 20.0f); }) >
        0.3f);
}

TEST_CASE("Lambert and GGX conserve energy; plain Phong and the published shaders' Blinn-Phong do not",
          "[blinn_phong]") {
  constexpr float quadrature = 0.01f;
  Reflectance mirror;
  mirror.specular_f0 = glm::vec3(1.0f);
  mirror.alpha = 0.3f;
  CHECK(largest_albedo([](const glm::vec3&, const glm::vec3&) { return 1.0f / pi; }) <= 1.0f + quadrature);
  CHECK(largest_albedo([&](const glm::vec3& out, const glm::vec3& in) { return evaluate(mirror, up, out, in).r; }) <=
        1.0f + quadrature);
  // The lobe alone conserves within what (P + 8) / (8 pi) is above the exact (P + 2)(P + 4) / (8 pi (P + 2^(-P/2))): 6
  // % at P = 20. A white floor without 1/pi sends back pi times what it gets.
  CHECK(largest_albedo(blinn_phong(material(0.0f, 1.0f, 0.3f), {})) <= 1.06f + quadrature);
  CHECK(largest_albedo(blinn_phong(material(1.0f, 0.0f, 0.3f), {false, 1.0f, true})) == Approx(pi).epsilon(quadrature));
  // Kd + Ks <= 1 does not help plain Phong: at grazing angles its lobe is divided by a cosine near 0.
  CHECK(largest_albedo([](const glm::vec3& out, const glm::vec3& in) {
          return plain_phong(out, in, 0.3f / pi, 0.7f, 4.0f);
        }) > 2.0f);
}

TEST_CASE("Without 1/pi the diffuse part is pi times Lambert's; the lobe stays", "[blinn_phong]") {
  const glm::vec3 out = direction(30.0f, 0.0f), in = direction(50.0f, 100.0f);
  const PhongMaterial matt{{0.2f, 0.4f, 0.8f}, glm::vec3(0.0f), 0.0f, glm::vec3(0.0f)};
  BlinnPhongOptions options;
  options.specular_twice = true;  // so that a black Ks has no lobe
  const glm::vec3 lambert = evaluate(matt, up, out, in, options);
  options.divide_by_pi = false;
  const glm::vec3 published = evaluate(matt, up, out, in, options);
  for (int c = 0; c < 3; ++c) {
    CHECK(lambert[c] == Approx(matt.diffuse[c] / pi).epsilon(1e-6));
    CHECK(published[c] == matt.diffuse[c]);
  }
}

TEST_CASE("The albedo's power decodes it for direct light alone", "[blinn_phong]") {
  PhongMaterial matt = material(0.5f, 0.0f, 0.0f);
  BlinnPhongOptions options{false, 2.2f, true};
  CHECK(evaluate(matt, up, up, up, options).r == Approx(std::pow(0.5f, 2.2f)).epsilon(1e-6));
}

TEST_CASE("Ks enters the lobe twice where that is asked for, which a black Ks shows best", "[blinn_phong]") {
  const glm::vec3 out = direction(30.0f, 0.0f), in = direction(25.0f, 180.0f);
  for (const float ks : {0.0f, 0.3f, 0.8f}) {
    const PhongMaterial glossy = material(0.0f, ks, 0.5f);
    const float once = evaluate(glossy, up, out, in, {true, 1.0f, false}).r;
    const float twice = evaluate(glossy, up, out, in, {true, 1.0f, true}).r;
    CHECK(twice == Approx(ks * once).epsilon(1e-6));
    CHECK(once > 0.0f);  // Schlick's term is above 0 even for a black Ks
  }
}

TEST_CASE("The lobe's power is 2^(11 s + 1), its peak (P + 8) / (8 pi) to four digits", "[blinn_phong]") {
  for (const float s : {0.0f, 0.4f, 1.0f}) {
    const float power = std::exp2(11.0f * s + 1.0f);
    const PhongMaterial glossy = material(0.0f, 1.0f, s);
    const float peak = evaluate(glossy, up, up, up, {}).r;
    CHECK(peak == Approx((power + 8.0f) / (8.0f * pi)).epsilon(3e-3));  // the shader's constants have four digits
    // At the half-vector's angle h the lobe has fallen to cos^P h.
    const glm::vec3 out = direction(10.0f, 0.0f), in = out;
    CHECK(evaluate(glossy, up, out, in, {}).r == Approx(peak * std::pow(out.z, power)).epsilon(1e-3));
  }
}
