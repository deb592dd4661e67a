#include "reference/pass.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "parallel.h"
#include "reference/sampler.h"

namespace voxref {

namespace {

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

PassRenderer::PassRenderer(const Scene& scene, const Caster& caster, const View& view, const Transport& transport,
                           uint64_t seed, const ExtraLayers& extra, const Part& part)
    : view_(view),
      rays_(view),
      surfaces_(scene),
      integrator_(scene, surfaces_, caster, view.background, transport),
      extra_(scene, surfaces_, caster, view.background, transport, extra),
      seed_(seed),
      grid_(view.width, view.height),
      tiles_(grid_.tiles_of(part)),
      batches_(static_cast<size_t>(view.width) * static_cast<size_t>(view.height)),
      extra_batches_(batches_.size() * extra.count()),
      done_(tiles_.size(), 1),
      counts_(tiles_.size()),
      finished_(tiles_.size()) {}

void PassRenderer::begin(const Pass& pass) {
  pass_ = pass;
  std::fill(done_.begin(), done_.end(), uint8_t{0});
  finished_ = 0;
}

bool PassRenderer::advance(const Progress& progress, const std::function<bool()>& pause,
                           const std::function<void(double)>& report) {
  const size_t before = finished_;
  parallel_for(tiles_.size(), 1, [&](size_t i, size_t) {
    // However often it is paused, some tile is finished each time.
    if (done_[i] || (finished_ != before && pause())) return;
    PassCounts counts;
    if (!render_tile(tiles_[i], progress, counts)) return;
    counts_[i] = counts;
    done_[i] = 1;
    report(static_cast<double>(++finished_) / static_cast<double>(tiles_.size()));
  });
  return finished();
}

PassCounts PassRenderer::counts() const {
  PassCounts sum;
  for (const PassCounts& tile : counts_) sum.add(tile);
  return sum;
}

void PassRenderer::save(StateWriter& writer) const {
  writer.value(pass_);
  writer.values(std::span(done_));
  writer.values(std::span(counts_));
  writer.values(std::span(batches_));
  writer.values(std::span(extra_batches_));
}

void PassRenderer::load(StateReader& reader) {
  reader.value(pass_);
  reader.values(std::span(done_));
  reader.values(std::span(counts_));
  reader.values(std::span(batches_));
  reader.values(std::span(extra_batches_));
  finished_ = static_cast<size_t>(std::count(done_.begin(), done_.end(), uint8_t{1}));
}

bool PassRenderer::render_tile(size_t tile, const Progress& progress, PassCounts& counts) {
  return grid_.visit_pixels(tile, [&](int x, int y) {
    if (progress.cancelled()) return false;
    render_pixel(x, y, counts);
    return true;
  });
}

void PassRenderer::render_pixel(int x, int y, PassCounts& counts) {
  const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(view_.width) + static_cast<size_t>(x);
  const uint64_t key =
      randomization_key(seed_, static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(pass_.number));
  const bool center = view_.pixel == PixelSampling::center;
  PixelSum sum;
  std::vector<glm::dvec3> extra(extra_.count(), glm::dvec3(0.0));
  std::optional<PathVertex> seen;
  for (int i = 0; i < pass_.samples; ++i) {
    const Sampler sampler(key, static_cast<uint32_t>(i));
    // All samples of a pixel's centre see the same point.
    if (i == 0 || !center)
      integrator_.cast(rays_(glm::vec2(x, y) + (center ? glm::vec2(0.5f) : sampler.get_2d(0))), seen, counts.paths);
    const uint64_t nonfinite_before = counts.paths.nonfinite;
    sum.add(integrator_.trace(seen, sampler, counts.paths));
    if (!extra.empty()) extra_.trace(seen, sampler, extra, counts.paths);
    if (seen) sum.add(seen->surface, glm::dot(seen->surface.position - rays_.eye(), rays_.forward()));
    if (counts.paths.nonfinite != nonfinite_before)
      counts.first_nonfinite = std::min(counts.first_nonfinite, SamplePlace{pixel, pass_.samples_before + i});
  }
  batches_[pixel] = sum.mean(pass_.samples);
  for (size_t i = 0; i < extra.size(); ++i)
    extra_batches_[pixel * extra.size() + i] = extra[i] / static_cast<double>(pass_.samples);
}

}  // namespace voxref
