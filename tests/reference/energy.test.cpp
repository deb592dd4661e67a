// What rough surfaces lose to single scattering, and that compensation gives it back.
#include <array>
#include <cmath>
#include <numbers>

#include "catch.h"
#include "reference/bsdf.h"
#include "reference/sampler.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

struct Mean {
  double value = 0.0, error = 0.0;
};

/// What the lobe of a white metal scatters of uniform light 1: the mean weight of the sampler's directions.
/// @param cosine of the viewer; 0: cosine-distributed, the mean over all viewers
Mean white_furnace(float roughness, float cosine, bool compensated) {
  constexpr uint32_t count = 1 << 14;
  double sum = 0.0, squares = 0.0;
  for (uint32_t i = 0; i < count; ++i) {
    const Sampler sampler(randomization_key(11, i, 0, 0), 0);
    const float z = cosine > 0.0f ? cosine : std::sqrt(1.0f - sampler.get_1d(2));
    SurfacePoint point;
    point.geometric_normal = point.shading_normal = {0.0f, 0.0f, 1.0f};
    point.reflectance.specular_f0 = glm::vec3(1.0f);
    point.reflectance.alpha = roughness * roughness;
    if (compensated) compensate_energy(point.reflectance, z);
    const Bsdf bsdf(point, {std::sqrt(1.0f - z * z), 0.0f, z});
    const BsdfSample sample = bsdf.sample(0.0f, sampler.get_2d(0));
    const double weight = sample ? sample.weight.g : 0.0;
    sum += weight;
    squares += weight * weight;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

}  // namespace

TEST_CASE("A white metal loses energy to single scattering, by roughness as the README says", "[energy]") {
  // Mean over the cosine-weighted hemisphere for roughness 0.1, 0.2 ... 1.
  constexpr std::array<double, 10> loss = {0.0003, 0.004, 0.022, 0.059, 0.118, 0.197, 0.293, 0.396, 0.498, 0.591};
  for (int i = 0; i < 10; ++i) {
    const Mean kept = white_furnace(0.1f * static_cast<float>(i + 1), 0.0f, false);
    CAPTURE(i, kept.value, kept.error);
    // Four standard errors, and the digits of the table; a bias of 1.5 % of the energy would stay unseen where the lobe
    // is widest (error 0.003), 0.1 % where it is narrow.
    CHECK(std::abs(1.0 - kept.value - loss[static_cast<size_t>(i)]) < 4.0 * kept.error + 0.001);
  }
}

TEST_CASE("With compensation a white metal gives back all light, at every roughness and from everywhere", "[energy]") {
  for (int i = 1; i <= 10; ++i)
    for (const float cosine : {0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
      const Mean kept = white_furnace(0.1f * static_cast<float>(i), cosine, true);
      CAPTURE(i, cosine, kept.value, kept.error);
      // The table of directional albedos is right to 0.002, and they are 0.3 at least.
      CHECK(std::abs(kept.value - 1.0) < 4.0 * kept.error + 0.002 / 0.3);
    }
}

TEST_CASE("Compensation is the path tracer's on request, and leaves the albedo layer as it is", "[energy]") {
  Scene scene;
  Material metal;
  metal.base_color = glm::vec4(1.0f);
  metal.metallic = 1.0f;
  metal.roughness = 1.0f;
  add_floor(scene, 10.0f, add_material(scene, metal));
  View view = view_from({0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 4, 4, 0.1f);
  view.background = glm::vec3(1.0f);
  const Caster caster(scene);
  PathOptions options;
  options.spp = 4096;
  const PathResult single = path_trace(scene, caster, view, options);
  options.energy_compensation = true;
  const PathResult all = path_trace(scene, caster, view, options);
  // Straight above a lobe of width 1 the single scattering of a white metal is 1 - ln 2.
  CHECK(std::abs(single.mean.g - (1.0 - std::numbers::ln2)) < 4.0f * single.mean_stderr.g + 1e-3f);
  CHECK(std::abs(all.mean.g - 1.0f) < 4.0f * all.mean_stderr.g + 0.007f);
  for (size_t i = 0; i < all.image.pixel_count(); ++i)
    CHECK(all.image.channel("albedo.G")[i] == single.image.channel("albedo.G")[i]);
}

}  // namespace voxref
