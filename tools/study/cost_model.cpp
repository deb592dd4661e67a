#include "study/cost_model.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>

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
  voxels_ = double(result.voxels_occupied);
  voxel_side_ = double(result.grid.voxel);
  resolution_ = settings.grid.resolution;
  if (!settings.bounce.count) auto_bounces_ = result.bounces;
  if (!times) return;
  const Work done = work(settings, pixels);
  rates_.voxelize = result.seconds.voxelize / done.voxels;
  rates_.shade = (result.seconds.shade + result.seconds.mipmap) / done.voxels;
  if (done.bounce_look_ups > 0.0) rates_.look_up = result.seconds.bounce / done.bounce_look_ups;
  rates_.pixel_look_up = result.seconds.cone_trace / done.pixel_look_ups;
}

CostModel::Work CostModel::work(const Settings& settings, size_t pixels) const {
  if (resolution_ == 0) throw std::logic_error("cost model: nothing learned yet");
  const double scale = double(settings.grid.resolution) / resolution_;  // surfaces: voxels grow with its square
  const double distance = visibility_.mean_distance / voxel_side_ * scale, step = double(settings.render.cone.step);
  const auto cone_cost = [&](const ConeSet& set) {
    return double(set.cones.size()) * look_ups(std::max(mean_tangent(set), 1e-3), step, std::max(distance, 1.0));
  };
  const int bounces = settings.bounce.count.value_or(auto_bounces_ > 0 ? auto_bounces_ : usual_auto_bounces);
  Work work{};
  work.voxels = voxels_ * scale * scale;
  work.bounce_look_ups = work.voxels * bounces * cone_cost(voxel_cones(settings.bounce.cones));
  work.pixel_look_ups = double(pixels) * cone_cost(pixel_cones(settings.render.cone.diffuse));
  return work;
}

StageSeconds CostModel::predict(const Settings& settings, size_t pixels) const {
  const Work w = work(settings, pixels);
  StageSeconds seconds;
  seconds.voxelize = rates_.voxelize * w.voxels;
  seconds.shade = rates_.shade * w.voxels;
  seconds.bounce = rates_.look_up * w.bounce_look_ups;
  seconds.cone_trace = rates_.pixel_look_up * w.pixel_look_ups;
  seconds.total = seconds.voxelize + seconds.shade + seconds.bounce + seconds.cone_trace;
  return seconds;
}

}  // namespace voxref
