#include "study/cost_model.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "compare/statistics.h"
#include "reference/sampler.h"
#include "reference/warp.h"

namespace voxref {

namespace {

constexpr int usual_auto_bounces = 7;  // where no run has told: an albedo of about a half

/// Running sums of the triangles' areas.
std::vector<double> cumulated_areas(const Scene& scene) {
  std::vector<double> sums;
  double sum = 0.0;
  for (const glm::uvec3& t : scene.triangles) {
    const glm::dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
    sums.push_back(sum += 0.5 * glm::length(glm::cross(b - a, c - a)));
  }
  return sums;
}

double mean_tangent(const ConeSet& set) {
  double sum = 0.0;
  for (const Cone& cone : set.cones) sum += cone.tan_half_angle * cone.texel;
  return sum / static_cast<double>(set.cones.size());
}

}  // namespace

double mean_sight(const Scene& scene, const Caster& caster) {
  constexpr uint32_t points = 4096;  // where rays' lengths scatter by all of their mean, it is known to 1.6 %
  const std::vector<double> areas = cumulated_areas(scene);
  if (areas.empty() || !(areas.back() > 0.0)) return 0.0;
  size_t hits = 0;
  double sum = 0.0;
  for (uint32_t i = 0; i < points; ++i) {
    const Sampler sampler(randomization_key(0, 0, 0, 0), i);
    const double wanted = double(sampler.get_1d(0)) * areas.back();
    const auto t = static_cast<size_t>(std::upper_bound(areas.begin(), areas.end(), wanted) - areas.begin());
    const glm::uvec3 corners = scene.triangles[std::min(t, areas.size() - 1)];
    const glm::vec3 a = scene.positions[corners.x], b = scene.positions[corners.y], c = scene.positions[corners.z];
    const glm::vec2 uv = uniform_triangle(sampler.get_2d(1));
    const glm::vec3 point = (1.0f - uv.x - uv.y) * a + uv.x * b + uv.y * c;
    const glm::vec3 front = glm::normalize(glm::cross(b - a, c - a));
    for (const glm::vec3& normal : {front, -front}) {
      const glm::vec3 direction = Frame(normal).to_world(cosine_hemisphere(sampler.get_2d(2)));
      if (const Hit hit = caster.closest(caster.leave(point, normal, direction))) ++hits, sum += double(hit.t);
    }
  }
  return hits > 0 ? sum / double(hits) : 0.0;
}

double CostModel::look_ups(double tangent, double step, double distance) {
  const double fine = 0.5 / tangent;  // how far texels are single voxels, in voxels
  if (distance <= fine) return distance / step + 1.0;
  return fine / step + std::log(distance / fine) / std::log1p(2.0 * tangent * step) + 1.0;
}

void CostModel::learn_image(double seconds) { samples_.push_back({&StageRates::image, {}, seconds}); }

void CostModel::learn(const Settings& settings, const ConeTraceResult& result, size_t pixels, const StageSeconds& ran) {
  Count& count = counts_[settings.grid.resolution];
  count.voxels = double(result.voxels_occupied);
  count.voxel_side = double(result.grid.voxel);
  if (!settings.bounce.count) count.auto_bounces = result.bounces;
  const Work done = work(settings, pixels);
  const auto add = [&](Stage stage, double seconds, double units, double beside = 0.0) {
    // What took no longer than what is beside it says nothing of its units: by a rate of 0 they would be free.
    if (seconds > beside && units > 0.0) samples_.push_back({stage, settings, (seconds - beside) / units});
  };
  add(&StageRates::voxelize, ran.voxelize, done.voxels);
  add(&StageRates::shade, ran.shade + ran.mipmap, done.voxels);
  add(&StageRates::look_up, ran.bounce, done.bounce_look_ups);
  add(&StageRates::prepare, ran.prepare, done.voxels);
  add(&StageRates::pixel_look_up, ran.cone_trace, done.pixel_look_ups, rate(&StageRates::image, settings));
}

CostModel::Work CostModel::work(const Settings& settings, size_t pixels) const {
  if (counts_.empty()) throw std::logic_error("cost model: nothing learned yet");
  const auto far = [&](int resolution) { return std::abs(std::log(double(resolution) / settings.grid.resolution)); };
  const auto nearest = std::min_element(counts_.begin(), counts_.end(),
                                        [&](const auto& a, const auto& b) { return far(a.first) < far(b.first); });
  const double scale = double(settings.grid.resolution) / nearest->first;
  const double step = double(settings.render.cone.step);
  const double distance = std::max(sight_ / nearest->second.voxel_side * scale, 1.0);
  const auto cone_cost = [&](const ConeSet& set) {
    return double(set.cones.size()) * look_ups(std::max(mean_tangent(set), 1e-3), step, distance);
  };
  int bounces = settings.bounce.count.value_or(nearest->second.auto_bounces);
  if (bounces == 0 && !settings.bounce.count) {
    bounces = usual_auto_bounces;
    for (const auto& [resolution, count] : counts_)
      if (count.auto_bounces > 0) bounces = count.auto_bounces;
  }
  Work work{};
  work.voxels = nearest->second.voxels * scale * scale;  // surfaces: voxels grow with the resolution's square
  work.bounce_look_ups = work.voxels * bounces * cone_cost(voxel_cones(settings.bounce.cones));
  work.pixel_look_ups = double(pixels) * cone_cost(pixel_cones(settings.render.cone.diffuse));
  return work;
}

double CostModel::rate(Stage stage, const Settings& wanted) const {
  // What the stage's time per unit depends on, most of all first: of an image the cones, since each pixel costs
  // something itself, of a volume its resolution.
  const bool image = stage == &StageRates::pixel_look_up, marches = image || stage == &StageRates::look_up;
  const bool stores = stage != &StageRates::voxelize;
  const auto ratio = [](int a, int b) { return std::abs(std::log(double(a) / b)); };
  const auto unlike = [&](const Settings& s) {
    const ConeOptions &a = s.render.cone, &b = wanted.render.cone;
    const double finer = ratio(s.grid.resolution, wanted.grid.resolution);
    return std::tuple(image ? ratio(a.diffuse, b.diffuse) : finer, marches && a.step != b.step,
                      stores && s.storage != wanted.storage, finer);
  };
  std::optional<decltype(unlike(wanted))> least;
  std::vector<double> rates;
  for (const Sample& sample : samples_) {
    if (sample.stage != stage) continue;
    const auto distance = unlike(sample.settings);
    if (least && *least < distance) continue;
    if (least && distance < *least) rates.clear();
    least = distance;
    rates.push_back(sample.rate);
  }
  return rates.empty() ? rates_.*stage : spread(rates).median;
}

StageSeconds CostModel::predict(const Settings& settings, size_t pixels) const {
  const Work w = work(settings, pixels);
  StageSeconds seconds;
  seconds.voxelize = rate(&StageRates::voxelize, settings) * w.voxels;
  seconds.shade = rate(&StageRates::shade, settings) * w.voxels;
  seconds.bounce = rate(&StageRates::look_up, settings) * w.bounce_look_ups;
  seconds.prepare = rate(&StageRates::prepare, settings) * w.voxels;
  seconds.cone_trace =
      rate(&StageRates::image, settings) + rate(&StageRates::pixel_look_up, settings) * w.pixel_look_ups;
  seconds.total = seconds.voxelize + seconds.shade + seconds.bounce + seconds.prepare + seconds.cone_trace;
  return seconds;
}

}  // namespace voxref
