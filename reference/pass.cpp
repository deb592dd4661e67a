#include "reference/pass.h"

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>

#include "parallel.h"
#include "reference/sampler.h"

namespace voxref {

namespace {

// Tiles of 16 x 16 pixels keep neighbouring rays, which meet the same triangles, on one core.
constexpr int tile_side = 16;

/// Sums over a pass's samples, in float64 because a pass may hold many.
struct PixelSum {
  glm::dvec3 emission{0.0}, direct{0.0}, indirect{0.0}, albedo{0.0}, normal{0.0};
  double depth = 0.0, hits = 0.0;

  void add(const Layers& layers) {
    emission += glm::dvec3(layers.emission);
    direct += glm::dvec3(layers.direct);
    indirect += glm::dvec3(layers.indirect);
  }
  void add(const SurfacePoint& seen, float seen_depth) {
    const Reflectance& reflectance = seen.reflectance;
    albedo += glm::dvec3(reflectance.diffuse * (1.0f - reflectance.layer_f0) + reflectance.specular_f0);
    normal += glm::dvec3(seen.shading_normal);
    depth += seen_depth;
    hits += 1.0;
  }
  PixelBatch mean(int samples) const {
    const double n = samples;
    PixelBatch batch;
    batch.layers = {emission / n, direct / n, indirect / n};
    batch.hit_share = static_cast<float>(hits / n);
    batch.albedo = albedo / n;
    batch.normal = normal / n;
    batch.depth = static_cast<float>(depth / n);
    return batch;
  }
};

}  // namespace

void PassCounts::add(const PassCounts& other) {
  paths.closest_rays += other.paths.closest_rays;
  paths.occlusion_rays += other.paths.occlusion_rays;
  paths.nonfinite += other.paths.nonfinite;
  first_nonfinite = std::min(first_nonfinite, other.first_nonfinite);
}

PassRenderer::PassRenderer(const Scene& scene, const Caster& caster, const View& view, std::optional<int> max_depth,
                           uint64_t seed, const ExtraLayers& extra)
    : view_(view),
      rays_(view),
      surfaces_(scene),
      integrator_(scene, surfaces_, caster, view.background, max_depth),
      extra_(scene, surfaces_, caster, view.background, max_depth, extra),
      seed_(seed),
      columns_(static_cast<size_t>((view.width + tile_side - 1) / tile_side)),
      rows_(static_cast<size_t>((view.height + tile_side - 1) / tile_side)),
      batches_(static_cast<size_t>(view.width) * static_cast<size_t>(view.height)),
      extra_batches_(batches_.size() * extra.count()) {}

std::optional<PassCounts> PassRenderer::render(const Pass& pass, const Progress& progress,
                                               const std::function<void(double)>& report) {
  std::vector<PassCounts> counts(columns_ * rows_);
  std::atomic<size_t> finished = 0;
  parallel_for(counts.size(), 1, [&](size_t tile, size_t) {
    if (!render_tile(tile, pass, progress, counts[tile])) return;
    report(static_cast<double>(++finished) / static_cast<double>(counts.size()));
  });
  if (finished != counts.size()) return std::nullopt;
  PassCounts sum;
  for (const PassCounts& tile : counts) sum.add(tile);
  return sum;
}

bool PassRenderer::render_tile(size_t tile, const Pass& pass, const Progress& progress, PassCounts& counts) {
  const int left = static_cast<int>(tile % columns_) * tile_side;
  const int top = static_cast<int>(tile / columns_) * tile_side;
  for (int y = top; y < std::min(top + tile_side, view_.height); ++y)
    for (int x = left; x < std::min(left + tile_side, view_.width); ++x) {
      if (progress.cancelled()) return false;
      render_pixel(x, y, pass, counts);
    }
  return true;
}

void PassRenderer::render_pixel(int x, int y, const Pass& pass, PassCounts& counts) {
  const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(view_.width) + static_cast<size_t>(x);
  const uint64_t key =
      randomization_key(seed_, static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(pass.number));
  const bool center = view_.pixel == PixelSampling::center;
  PixelSum sum;
  std::vector<glm::dvec3> extra(extra_.count(), glm::dvec3(0.0));
  std::optional<PathVertex> seen;
  for (int i = 0; i < pass.samples; ++i) {
    const Sampler sampler(key, static_cast<uint32_t>(i));
    // All samples of a pixel's centre see the same point.
    if (i == 0 || !center)
      integrator_.cast(rays_(glm::vec2(x, y) + (center ? glm::vec2(0.5f) : sampler.get_2d(0))), seen, counts.paths);
    const uint64_t nonfinite_before = counts.paths.nonfinite;
    sum.add(integrator_.trace(seen, sampler, counts.paths));
    if (!extra.empty()) extra_.trace(seen, sampler, extra, counts.paths);
    if (seen) sum.add(seen->surface, glm::dot(seen->surface.position - rays_.eye(), rays_.forward()));
    if (counts.paths.nonfinite != nonfinite_before)
      counts.first_nonfinite = std::min(counts.first_nonfinite, SamplePlace{pixel, pass.samples_before + i});
  }
  batches_[pixel] = sum.mean(pass.samples);
  for (size_t i = 0; i < extra.size(); ++i)
    extra_batches_[pixel * extra.size() + i] = extra[i] / static_cast<double>(pass.samples);
}

}  // namespace voxref
