// Chi-square tests of everything that draws, against its density. Each of the some 30 tests is at 0.1 %: one of them
// all would fail by chance with 3 %, and seeds are fixed. With n draws, a density that is too high by the fraction e
// where half of the draws fall, and too low by it where the others do, is found with probability 0.9 if n e^2 is 40 for
// 16 bins, 88 for 144, 115 for 256: e = 2.5 to 4.2 % for 2^16 draws. What it cannot see: what bins average out, and
// densities that are right while the values that are weighed with them are wrong.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "catch.h"
#include "reference/bsdf.h"
#include "reference/chi_square.h"
#include "reference/light_sampling.h"
#include "reference/reflectances.h"
#include "reference/sampler.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double significance = 0.001;
constexpr uint32_t draws = 1u << 16;

/// The first point of a randomization of its own: independent of all others, as the tests assume.
Sampler independent(uint32_t i, uint64_t seed) { return {randomization_key(seed, i, 0, 0), 0}; }

size_t bin_of(double x, size_t bins) {
  return std::min(static_cast<size_t>(std::max(x, 0.0) * static_cast<double>(bins)), bins - 1);
}

double turn_of(const glm::dvec3& v) { return std::atan2(v.y, v.x) / (2.0 * pi) + 0.5; }

/// Microfacet normals by how far out in the lobe's tail they are, whatever alpha: x = 1 - cos(phi) where tan(phi) is
/// the slope over alpha, and the turn. No tail is too narrow or too far out, and at grazing, where the visible normals'
/// density grows with the slope, it stays bounded.
struct FacetSquare {
  double alpha;

  glm::dvec2 of(const glm::dvec3& h) const {
    const double slope = std::hypot(h.x, h.y) / h.z;
    return {1.0 - alpha / std::hypot(alpha, slope), turn_of(h)};
  }
  glm::dvec3 normal(double x, double turn) const {
    const double slope = alpha * std::sqrt(x * (2.0 - x)) / (1.0 - x), angle = 2.0 * pi * (turn - 0.5);
    return glm::normalize(glm::dvec3(slope * std::cos(angle), slope * std::sin(angle), 1.0));
  }
  /// Solid angle of normals per area of the square: 2 pi alpha^2 / (1 - x)^3 of slopes, times cos^3.
  double solid_angle(double x, double cosine) const {
    return 2.0 * pi * alpha * alpha * std::pow(cosine / (1.0 - x), 3.0);
  }
};

struct EmissiveScene {
  Scene scene;
  std::vector<uint32_t> emissive;  // triangles
};

/// A bright triangle pair, a dim large one, and one whose radiance varies strongly over its texture.
EmissiveScene lights_of_three_kinds() {
  EmissiveScene lights;
  Scene& scene = lights.scene;
  add_quad(scene, {-0.5f, 1.0f, -0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f},
           add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(3.0f))));
  add_quad(scene, {1.0f, 0.0f, -1.0f}, {0.0f, 0.0f, 2.0f}, {0.0f, 2.0f, 0.0f},
           add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(1.0f))));
  TextureImage image;
  image.width = image.height = 2;
  image.texels8 = {255, 255, 255, 255, 20, 20, 20, 255, 120, 120, 120, 255, 255, 0, 0, 255};
  scene.images.push_back(image);
  Material textured = lambert(glm::vec3(0.0f), glm::vec3(4.0f));
  textured.emission_texture.image = 0;
  add_quad(scene, {-1.0f, 0.2f, -0.5f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, add_material(scene, textured));
  scene.uv[0].assign(scene.positions.size(), glm::vec2(0.0f));
  scene.uv[0][9] = {1.0f, 0.0f};
  scene.uv[0][10] = {1.0f, 1.0f};
  scene.uv[0][11] = {0.0f, 1.0f};
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) lights.emissive.push_back(i);
  return lights;
}

}  // namespace

TEST_CASE("The cosine hemisphere and the uniform triangle follow their densities", "[distributions]") {
  constexpr size_t side = 16;
  const std::vector<double> expected(side * side, static_cast<double>(draws) / (side * side));
  std::vector<double> hemisphere(side * side), triangle(side * side);
  for (uint32_t i = 0; i < draws; ++i) {
    // Its squared cosine is uniform.
    const glm::dvec3 v(cosine_hemisphere(independent(i, 1).get_2d(0)));
    hemisphere[bin_of(v.z * v.z, side) * side + bin_of(turn_of(v), side)] += 1.0;
    // Cells of a grid over both halves of the square: the triangle folded out by its copy, for every other point.
    glm::dvec2 uv(uniform_triangle(independent(i, 2).get_2d(0)));
    if (i % 2) uv = 1.0 - uv;
    triangle[bin_of(uv.x, side) * side + bin_of(uv.y, side)] += 1.0;
  }
  CHECK(chi_square_p(hemisphere, expected) > significance);
  CHECK(chi_square_p(triangle, expected) > significance);
}

TEST_CASE("Reflected directions follow their pdf to the ends of the lobe's tails, narrow and grazing too",
          "[distributions]") {
  constexpr size_t side = 12;
  constexpr int parts = 24;  // integration points per bin and axis
  for (const float alpha : {0.001f, 0.02f, 0.2f, 0.6f, 1.0f})
    for (const double cosine : {1.0, 0.7, 0.2, 0.02}) {
      const SurfacePoint point = flat_point(metal(alpha));
      const glm::dvec3 out = direction(cosine, 0.5);
      const Bsdf bsdf(point, glm::vec3(out));
      const FacetSquare square{static_cast<double>(alpha)};
      // The last bin takes what is reflected below the horizon and so is not drawn.
      std::vector<double> observed(side * side + 1), expected(side * side + 1);
      for (uint32_t i = 0; i < draws; ++i) {
        const auto sample = bsdf.sample(0.0f, independent(i, 3).get_2d(0));
        size_t bin = side * side;
        if (sample) {
          const glm::dvec2 at = square.of(glm::normalize(out + glm::dvec3(sample.in)));
          bin = bin_of(at.x, side) * side + bin_of(at.y, side);
        }
        observed[bin] += 1.0;
      }
      double total = 0.0;
      constexpr double step = 1.0 / (side * parts);
      for (int i = 0; i < static_cast<int>(side) * parts; ++i)
        for (int j = 0; j < static_cast<int>(side) * parts; ++j) {
          const double x = (i + 0.5) * step, turn = (j + 0.5) * step;
          const glm::dvec3 h = square.normal(x, turn);
          const double out_h = glm::dot(out, h);
          const glm::dvec3 in = 2.0 * out_h * h - out;
          if (out_h <= 0.0 || in.z <= 0.0) continue;
          const double share = bsdf.pdf(glm::vec3(in)) * 4.0 * out_h * square.solid_angle(x, h.z) * step * step;
          expected[bin_of(x, side) * side + bin_of(turn, side)] += share * draws;
          total += share;
        }
      CAPTURE(alpha, cosine, total);
      CHECK(total < 1.0 + 1e-3);  // the quadrature's error
      expected.back() = std::max(0.0, 1.0 - total) * draws;
      CHECK(chi_square_p(observed, expected) > significance);
    }
}

TEST_CASE("A white lobe returns what its formula returns, and so loses what facets throw at each other",
          "[distributions]") {
  // E = integral of D G2 / (4 n.v) over directions, by the papers' formulas in float64: Walter et al. 2007 eq. 33, and
  // the height-correlated G2 = 1 / (1 + L(v) + L(l)), L = (sqrt(1 + a^2 tan^2) - 1) / 2 (Heitz 2014 eq. 72, 99).
  // Three standard errors, and 1e-4 for the quadrature.
  for (const double roughness : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0})
    for (const double cosine : {1.0, 0.6, 0.2}) {
      const double alpha = roughness * roughness;
      const glm::dvec3 out = direction(cosine, 0.0);
      const FacetSquare square{alpha};
      const auto lambda = [&](double c) {
        return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 / (c * c) - 1.0)) - 1.0);
      };
      constexpr int side = 500;
      double truth = 0.0;
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          const double x = (i + 0.5) / side;
          const glm::dvec3 h = square.normal(x, (j + 0.5) / side);
          const double out_h = glm::dot(out, h), in_z = 2.0 * out_h * h.z - out.z;
          if (out_h <= 0.0 || in_z <= 0.0) continue;
          // D cos dh = 2 (1 - x) / side^2, dl = 4 (v.h) dh.
          truth += 2.0 * (1.0 - x) * out_h / (h.z * cosine * (1.0 + lambda(cosine) + lambda(in_z))) / (side * side);
        }
      const SurfacePoint point = flat_point(metal(static_cast<float>(alpha)));
      const Bsdf bsdf(point, glm::vec3(out));
      double sum = 0.0, squares = 0.0;
      for (uint32_t i = 0; i < draws; ++i) {
        const auto sample = bsdf.sample(0.0f, independent(i, 4).get_2d(0));
        const double weight = sample ? sample.weight.g : 0.0;
        sum += weight;
        squares += weight * weight;
      }
      const double mean = sum / draws, error = std::sqrt(std::max(0.0, squares / draws - mean * mean) / draws);
      CAPTURE(roughness, cosine, truth, mean, error);
      CHECK(std::abs(mean - truth) < 3.0 * error + 1e-4);
      // Known in closed form for the widest lobe seen from above.
      if (roughness == 1.0 && cosine == 1.0) CHECK(truth == Approx(1.0 - std::numbers::ln2).epsilon(1e-4));
    }
}

TEST_CASE("BSDFs are reciprocal for any two directions", "[distributions]") {
  Reflectance half = metal(0.1f);
  half.diffuse = glm::vec3(0.4f);
  for (const Reflectance& reflectance : {plastic(0.3f, {0.9f, 0.5f, 0.1f}), half, metal(1.0f)}) {
    const SurfacePoint point = flat_point(reflectance);
    double worst = 0.0;
    for (uint32_t i = 0; i < 4096; ++i) {
      const Sampler sampler = independent(i, 5);
      const glm::vec3 a = cosine_hemisphere(sampler.get_2d(0)), b = cosine_hemisphere(sampler.get_2d(1));
      if (std::min(a.z, b.z) < 1e-3f) continue;
      const double there = Bsdf(point, a).value(b).g / b.z, back = Bsdf(point, b).value(a).g / a.z;
      worst = std::max(worst, std::abs(there / back - 1.0));
    }
    // Roundings of the half vector, which the lobe of width 0.1 amplifies by some 1 / alpha.
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("Points of emissive triangles, textured ones too, follow their density", "[distributions]") {
  // 6 triangles, each in 4 like parts: 24 bins. The density is integrated over each part's area.
  const EmissiveScene lights = lights_of_three_kinds();
  const Scene& scene = lights.scene;
  const Materials materials(scene);
  const LightSampler sampler(scene, materials);
  for (const glm::vec3& position : {glm::vec3(0.0f), glm::vec3(0.7f, 0.3f, 0.4f)}) {
    const Receiver receiver = {position, glm::normalize(glm::vec3(0.3f, 1.0f, -0.2f))};
    std::vector<double> observed(4 * lights.emissive.size() + 1), expected = observed;
    const auto part_of = [](const glm::dvec2& uv) {
      return uv.x + uv.y < 0.5 ? 0 : uv.x > 0.5 ? 1 : uv.y > 0.5 ? 2 : 3;
    };
    for (uint32_t i = 0; i < draws; ++i) {
      const auto sample = sampler.sample_emitter(receiver, independent(i, 6).bits_2d(0));
      size_t bin = observed.size() - 1;  // seen from behind: nothing drawn
      for (size_t k = 0; sample && k < lights.emissive.size(); ++k) {
        const glm::uvec3 t = scene.triangles[lights.emissive[k]];
        const glm::dvec3 a = scene.positions[t.x], u = glm::dvec3(scene.positions[t.y]) - a,
                         v = glm::dvec3(scene.positions[t.z]) - a, p = glm::dvec3(sample->position) - a;
        const glm::dvec3 normal = glm::cross(u, v);
        const double area2 = glm::dot(normal, normal);
        const glm::dvec2 uv(glm::dot(glm::cross(p, v), normal) / area2, glm::dot(glm::cross(u, p), normal) / area2);
        const bool inside = std::min(uv.x, uv.y) > -1e-5 && uv.x + uv.y < 1.0 + 1e-5;
        if (inside && std::abs(glm::dot(p, normal)) < 1e-5) bin = 4 * k + static_cast<size_t>(part_of(uv));
      }
      observed[bin] += 1.0;
    }
    double total = 0.0;
    constexpr int side = 64;
    for (size_t k = 0; k < lights.emissive.size(); ++k) {
      const glm::uvec3 t = scene.triangles[lights.emissive[k]];
      const glm::dvec3 a = scene.positions[t.x], u = glm::dvec3(scene.positions[t.y]) - a,
                       v = glm::dvec3(scene.positions[t.z]) - a;
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          glm::dvec2 uv((i + 1.0 / 3.0) / side, (j + 1.0 / 3.0) / side);  // centres of the cells' lower halves ...
          if (i + j >= side) uv = 1.0 - uv;                               // ... and of the upper ones
          const glm::dvec3 offset = a + uv.x * u + uv.y * v - glm::dvec3(position);
          const double distance = glm::length(offset), cosine = -glm::dot(offset, glm::normalize(glm::cross(u, v)));
          if (cosine <= 0.0) continue;
          const double density = sampler.emitter_pdf(receiver, lights.emissive[k], glm::vec3(offset / distance),
                                                     static_cast<float>(distance));
          const double solid_angle =
              glm::length(glm::cross(u, v)) / 2.0 / (side * side) * cosine / (distance * distance * distance);
          expected[4 * k + static_cast<size_t>(part_of(uv))] += density * solid_angle * draws;
          total += density * solid_angle;
        }
    }
    CAPTURE(total);
    CHECK(total < 1.0 + 1e-3);
    expected.back() = std::max(0.0, 1.0 - total) * draws;
    CHECK(chi_square_p(observed, expected) > significance);
  }
}

TEST_CASE("Punctual lights are chosen as often as what is divided by says", "[distributions]") {
  for (const int count : {3, 40}) {  // few and many
    Scene scene;
    add_floor(scene, 5.0f, add_material(scene, lambert(glm::vec3(0.5f))));
    for (int i = 0; i < count; ++i) {
      const auto x = static_cast<float>(i);
      Light light;
      light.position = {2.0f * std::sin(x), 1.0f + 0.02f * x, 2.0f * std::cos(x)};
      light.intensity = glm::vec3(1.0f + 0.3f * x);
      scene.lights.push_back(light);
    }
    const glm::vec3 point(0.2f, 0.0f, 0.1f), normal(0.0f, 1.0f, 0.0f);
    const Materials materials(scene);
    const LightSampler sampler(scene, materials);
    std::vector<double> observed(scene.lights.size()), probability(scene.lights.size());
    for (uint32_t i = 0; i < draws; ++i) {
      const auto sample = sampler.sample_punctual({point, normal}, independent(i, 7).bits_1d(0));
      REQUIRE(sample);
      size_t nearest = 0;
      for (size_t k = 1; k < scene.lights.size(); ++k)
        if (glm::dot(illuminate(scene.lights[k], point).to_light, sample->to_light) >
            glm::dot(illuminate(scene.lights[nearest], point).to_light, sample->to_light))
          nearest = k;
      observed[nearest] += 1.0;
      probability[nearest] = illuminate(scene.lights[nearest], point).irradiance.g / sample->irradiance.g;
    }
    double total = 0.0;
    for (double& p : probability) {
      total += p;
      p *= draws;
    }
    CAPTURE(count, total);
    CHECK(total == Approx(1.0).epsilon(1e-5));  // every light was drawn, and the shares are those of one choice
    CHECK(chi_square_p(observed, probability) > significance);
  }
}

}  // namespace voxref
