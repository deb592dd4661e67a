#include "reference/pass.h"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

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

/// What a tile's waves need besides their pixels; kept from tile to tile, because
/// new memory is paid for page by page.
struct PassRenderer::Room {
  Wave wave;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::vector<PathVertex> seen;
  std::vector<PathStart> starts;  // pixel by pixel, as many samples of each
  SamplerBlock samplers;          // of the starts
  std::vector<uint32_t> x, y;     // their places in the pixels, random bits
  std::vector<PathVertex> white;  // what is seen, were it white and Lambertian
  std::vector<PixelSum> sums;     // per pixel
  std::vector<glm::dvec3> extra;  // extra layers per pixel
};

void PassCounts::add(const PassCounts& other) {
  paths.closest_rays += other.paths.closest_rays;
  paths.occlusion_rays += other.paths.occlusion_rays;
  paths.nonfinite += other.paths.nonfinite;
  first_nonfinite = std::min(first_nonfinite, other.first_nonfinite);
}

PassRenderer::PassRenderer(const Scene& scene, const Caster& caster, const View& view, const Transport& transport,
                           uint64_t seed, const ExtraLayers& extra, const Part& part)
    : view_(view),
      caster_(caster),
      rays_(view),
      surfaces_(scene),
      integrator_(scene, surfaces_, caster, view.background, transport, extra.bounces),
      extra_(extra),
      seed_(seed),
      grid_(view.width, view.height),
      tiles_(grid_.tiles_of(part)),
      batches_(static_cast<size_t>(view.width) * static_cast<size_t>(view.height)),
      extra_batches_(batches_.size() * extra.count()),
      done_(tiles_.size(), 1),
      counts_(tiles_.size()),
      finished_(tiles_.size()) {}

PassRenderer::~PassRenderer() = default;

void PassRenderer::begin(const Pass& pass) {
  assert(pass.samples >= 1 && static_cast<size_t>(pass.samples) <= Wave::most_paths);
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
  std::vector<glm::ivec2> pixels;
  grid_.visit_pixels(tile, [&](int x, int y) { pixels.emplace_back(x, y); });
  std::unique_ptr<Room> room = take_room();
  const size_t at_once = Wave::most_paths / static_cast<size_t>(pass_.samples);
  for (size_t first = 0; first < pixels.size(); first += at_once) {
    if (progress.cancelled()) return false;
    render_pixels(std::span(pixels).subspan(first, std::min(at_once, pixels.size() - first)), *room, counts);
  }
  give_back(std::move(room));
  return true;
}

std::unique_ptr<PassRenderer::Room> PassRenderer::take_room() {
  const std::lock_guard lock(idle_rooms_lock_);
  if (idle_rooms_.empty()) return std::make_unique<Room>();
  std::unique_ptr<Room> room = std::move(idle_rooms_.back());
  idle_rooms_.pop_back();
  return room;
}

void PassRenderer::give_back(std::unique_ptr<Room> room) {
  const std::lock_guard lock(idle_rooms_lock_);
  idle_rooms_.push_back(std::move(room));
}

/// One wave: all samples of some pixels.
void PassRenderer::render_pixels(std::span<const glm::ivec2> pixels, Room& room, PassCounts& counts) {
  room.sums.assign(pixels.size(), {});
  room.extra.assign(pixels.size() * extra_.count(), glm::dvec3(0.0));
  see(pixels, room, counts.paths);
  integrator_.trace(room.starts, room.wave, counts.paths);
  add_found(pixels, room, counts);
  if (extra_.irradiance) add_irradiance(pixels, room, counts);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const size_t pixel = index(pixels[i]);
    batches_[pixel] = room.sums[i].mean(pass_.samples);
    for (size_t layer = 0; layer < extra_.count(); ++layer)
      extra_batches_[pixel * extra_.count() + layer] =
          room.extra[i * extra_.count() + layer] / static_cast<double>(pass_.samples);
  }
}

void PassRenderer::add_found(std::span<const glm::ivec2> pixels, Room& room, PassCounts& counts) const {
  for (size_t path = 0; path < room.starts.size(); ++path) {
    const size_t pixel = path / static_cast<size_t>(pass_.samples);
    room.sums[pixel].add(room.wave.samples()[path].layers);
    if (const PathVertex* seen = room.starts[path].seen)
      room.sums[pixel].add(seen->surface, glm::dot(seen->surface.position - rays_.eye(), rays_.forward()));
    for (size_t bounce = 0; bounce < static_cast<size_t>(extra_.bounces); ++bounce)
      room.extra[pixel * extra_.count() + bounce] += glm::dvec3(room.wave.bounces(path)[bounce]);
  }
  place_nonfinite(pixels, room, counts);
}

/// Of the wave that was traced last.
void PassRenderer::place_nonfinite(std::span<const glm::ivec2> pixels, const Room& room, PassCounts& counts) const {
  const auto samples = static_cast<size_t>(pass_.samples);
  for (size_t path = 0; path < room.starts.size(); ++path)
    if (room.wave.samples()[path].nonfinite > 0)
      counts.first_nonfinite =
          std::min(counts.first_nonfinite,
                   SamplePlace{index(pixels[path / samples]), pass_.samples_before + static_cast<int>(path % samples)});
}

/// The camera's rays. All samples of a pixel's centre see the same point, and there is one ray for all of them.
void PassRenderer::aim(std::span<const glm::ivec2> pixels, Room& room) const {
  room.rays.clear();
  if (view_.pixel == PixelSampling::center) {
    for (const glm::ivec2& pixel : pixels) room.rays.push_back(rays_(glm::vec2(pixel) + 0.5f));
    return;
  }
  room.samplers.clear();
  for (const PathStart& start : room.starts) room.samplers.add(start.sampler);
  room.samplers.bits_2d(0, room.x, room.y);
  for (size_t i = 0; i < room.starts.size(); ++i)
    room.rays.push_back(
        rays_(glm::vec2(pixels[i / static_cast<size_t>(pass_.samples)]) + unit_floats({room.x[i], room.y[i]})));
}

/// Begins paths at what the camera sees.
void PassRenderer::see(std::span<const glm::ivec2> pixels, Room& room, PathCounts& counts) const {
  room.starts.clear();
  for (const glm::ivec2& pixel : pixels) {
    const uint64_t key = randomization_key(seed_, static_cast<uint32_t>(pixel.x), static_cast<uint32_t>(pixel.y),
                                           static_cast<uint32_t>(pass_.number));
    for (int sample = 0; sample < pass_.samples; ++sample)
      room.starts.push_back({nullptr, Sampler(key, static_cast<uint32_t>(sample))});
  }
  aim(pixels, room);
  room.hits.resize(room.rays.size());
  caster_.closest(room.rays, room.hits);
  counts.closest_rays += room.rays.size();

  room.seen.clear();
  room.seen.reserve(room.rays.size());  // starts point into it
  const size_t starts_per_ray = room.starts.size() / room.rays.size();
  for (size_t i = 0; i < room.rays.size(); ++i) {
    if (!room.hits[i]) continue;
    room.seen.emplace_back(surfaces_, room.hits[i], room.rays[i]);
    for (PathStart& start : std::span(room.starts).subspan(i * starts_per_ray, starts_per_ray))
      start.seen = &room.seen.back();
  }
}

/// Irradiance is pi times what the surface would scatter if it were white and Lambertian, whose BSDF is 1 / pi: a
/// second path with the same random numbers, which leaves the first as it is without.
void PassRenderer::add_irradiance(std::span<const glm::ivec2> pixels, Room& room, PassCounts& counts) const {
  room.white = room.seen;
  for (PathVertex& vertex : room.white) {
    vertex.surface.reflectance = Reflectance{};
    vertex.surface.reflectance.diffuse = glm::vec3(1.0f);
  }
  for (PathStart& start : room.starts)
    if (start.seen) start.seen = &room.white[static_cast<size_t>(start.seen - room.seen.data())];
  integrator_.trace(room.starts, room.wave, counts.paths);
  place_nonfinite(pixels, room, counts);
  for (size_t path = 0; path < room.starts.size(); ++path) {
    if (!room.starts[path].seen) continue;
    const Layers& scattered = room.wave.samples()[path].layers;
    room.extra[(path / static_cast<size_t>(pass_.samples) + 1) * extra_.count() - 1] +=
        std::numbers::pi * (glm::dvec3(scattered.direct) + glm::dvec3(scattered.indirect));
  }
}

}  // namespace voxref
