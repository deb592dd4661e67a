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

Visibility measure_visibility(const Scene& scene, const Caster& caster) {
  constexpr uint32_t rays = 4096;  // the share is known to 1.6 %
  const std::vector<double> areas = cumulated_areas(scene);
  Visibility result;
  if (areas.empty() || !(areas.back() > 0.0)) return result;
  size_t hits = 0;
  for (uint32_t i = 0; i < rays; ++i) {
    const Sampler sampler(randomization_key(0, 0, 0, 0), i);
    const double wanted = double(sampler.get_1d(0)) * areas.back();
    const auto t = static_cast<size_t>(std::upper_bound(areas.begin(), areas.end(), wanted) - areas.begin());
    const glm::uvec3 corners = scene.triangles[std::min(t, areas.size() - 1)];
    const glm::vec3 a = scene.positions[corners.x], b = scene.positions[corners.y], c = scene.positions[corners.z];
    const glm::vec2 uv = uniform_triangle(sampler.get_2d(1));
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const Ray ray = caster.leave((1.0f - uv.x - uv.y) * a + uv.x * b + uv.y * c, normal,
                                 Frame(normal).to_world(cosine_hemisphere(sampler.get_2d(2))));
    if (const Hit hit = caster.closest(ray)) {
      ++hits;
      result.mean_distance += double(hit.t);
    }
  }
  result.hit_share = double(hits) / rays;
  if (hits > 0) result.mean_distance /= double(hits);
  return result;
}

double CostModel::look_ups(double tangent, double step, double distance) {
  const double fine = 0.5 / tangent;  // how far texels are single voxels, in voxels
  if (distance <= fine) return distance / step + 1.0;
  return fine / step + std::log(distance / fine) / std::log1p(2.0 * tangent * step) + 1.0;
}

void CostModel::learn(const Settings& settings, const ConeTraceResult& result, size_t pixels, bool times) {
  Count& count = counts_[settings.grid.resolution];
  count.voxels = double(result.voxels_occupied);
  count.voxel_side = double(result.grid.voxel);
  if (!settings.bounce.count) count.auto_bounces = result.bounces;
  if (!times) return;
  const Work done = work(settings, pixels);
  const StageSeconds& s = result.seconds;
  const auto rate = [](double seconds, double units) {
    return units > 0.0 ? seconds / units : std::numeric_limits<double>::quiet_NaN();
  };
  samples_.push_back(
      {settings,
       {rate(s.voxelize, done.voxels), rate(s.shade + s.mipmap, done.voxels), rate(s.bounce, done.bounce_look_ups),
        rate(s.prepare, done.voxels), rate(s.cone_trace, done.pixel_look_ups)}});
}

CostModel::Work CostModel::work(const Settings& settings, size_t pixels) const {
  if (counts_.empty()) throw std::logic_error("cost model: nothing learned yet");
  const auto far = [&](int resolution) { return std::abs(std::log(double(resolution) / settings.grid.resolution)); };
  const auto nearest = std::min_element(counts_.begin(), counts_.end(),
                                        [&](const auto& a, const auto& b) { return far(a.first) < far(b.first); });
  const double scale = double(settings.grid.resolution) / nearest->first;
  const double step = double(settings.render.cone.step);
  const double distance = std::max(visibility_.mean_distance / nearest->second.voxel_side * scale, 1.0);
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

StageRates CostModel::rates(const Settings& wanted) const {
  // What an image's look-ups take depends on cones and step too, since each pixel costs something itself.
  const auto median = [&](double StageRates::*rate, bool image) {
    const auto unlike = [&](const Settings& s) {
      const ConeOptions &a = s.render.cone, &b = wanted.render.cone;
      return std::tuple(image ? std::abs(std::log(double(a.diffuse) / b.diffuse)) : 0.0, a.step != b.step,
                        s.storage != wanted.storage,
                        std::abs(std::log(double(s.grid.resolution) / wanted.grid.resolution)));
    };
    std::optional<decltype(unlike(wanted))> least;
    std::vector<double> values;
    for (const Sample& sample : samples_) {
      if (!std::isfinite(sample.rates.*rate)) continue;
      const auto distance = unlike(sample.settings);
      if (least && *least < distance) continue;
      if (least && distance < *least) values.clear();
      least = distance;
      values.push_back(sample.rates.*rate);
    }
    return values.empty() ? rates_.*rate : spread(values).median;
  };
  return {median(&StageRates::voxelize, false), median(&StageRates::shade, false), median(&StageRates::look_up, false),
          median(&StageRates::prepare, false), median(&StageRates::pixel_look_up, true)};
}

StageSeconds CostModel::predict(const Settings& settings, size_t pixels) const {
  const Work w = work(settings, pixels);
  const StageRates r = rates(settings);
  StageSeconds seconds;
  seconds.voxelize = r.voxelize * w.voxels;
  seconds.shade = r.shade * w.voxels;
  seconds.bounce = r.look_up * w.bounce_look_ups;
  seconds.prepare = r.prepare * w.voxels;
  seconds.cone_trace = r.pixel_look_up * w.pixel_look_ups;
  seconds.total = seconds.voxelize + seconds.shade + seconds.bounce + seconds.prepare + seconds.cone_trace;
  return seconds;
}

}  // namespace voxref
