#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <tuple>
#include <vector>

#include "progress.h"
#include "reference/checkpoint.h"
#include "reference/extra_layers.h"
#include "reference/integrator.h"
#include "reference/tiles.h"
#include "scene/camera.h"

namespace voxref {

/// One pixel's means over the samples of one pass. What the camera sees counts as zero for samples that miss the scene.
struct PixelBatch {
  Layers layers;
  float hit_share = 0.0f;  ///< of the samples that saw a surface
  glm::vec3 albedo{0.0f};  ///< reflectance at normal incidence
  glm::vec3 normal{0.0f};  ///< shading normal
  float depth = 0.0f;      ///< along the view axis, world units
};

/// A sample of an image; the first is the upper left pixel's first.
struct SamplePlace {
  size_t pixel = std::numeric_limits<size_t>::max();  ///< row by row; the largest number: nowhere
  int sample = 0;
  bool operator<(const SamplePlace& other) const {
    return std::tie(pixel, sample) < std::tie(other.pixel, other.sample);
  }
};

/// What a pass found on the side.
struct PassCounts {
  PathCounts paths;
  SamplePlace first_nonfinite;

  void add(const PassCounts& other);
};

/// Which samples a pass takes at every pixel.
struct Pass {
  int number = 0;          ///< of the randomization
  int samples = 1;         ///< points of it, at most Wave::most_paths
  int samples_before = 0;  ///< taken by earlier passes
};

/// Renders an image, or a part of one, pass by pass. A pass is one randomization of the sampler at each pixel: its
/// samples are stratified among each other and independent of all other passes and pixels. Keeps references to its
/// arguments.
class PassRenderer {
 public:
  PassRenderer(const Scene& scene, const Caster& caster, const View& view, const Transport& transport, uint64_t seed,
               const ExtraLayers& extra = {}, const Part& part = {});
  PassRenderer(const PassRenderer&) = delete;  // its parts refer to one another
  ~PassRenderer();

  void begin(const Pass& pass);
  /// Renders what is left of the pass; the same bits whatever the number of threads, and however often it is called.
  /// @param pause asked between tiles, from any thread: whether to return soon @param report takes the finished
  /// fraction, from any thread. @returns whether the pass is finished; false when it was paused or cancelled
  bool advance(const Progress& progress, const std::function<bool()>& pause, const std::function<void(double)>& report);
  bool finished() const { return finished_ == tiles_.size(); }

  // Of the pass that was finished last.
  const Pass& pass() const { return pass_; }
  PassCounts counts() const;
  /// One per pixel, row by row; zero outside the part.
  std::span<const PixelBatch> batches() const { return batches_; }
  /// The extra layers' means, as many per pixel as there are.
  std::span<const glm::vec3> extra_batches() const { return extra_batches_; }

  /// The pass under way, for a checkpoint.
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  struct Room;
  std::unique_ptr<Room> take_room();
  void give_back(std::unique_ptr<Room> room);
  /// False when it was cancelled: asked before every wave, because a tile of many samples takes seconds.
  bool render_tile(size_t tile, const Progress& progress, PassCounts& counts);
  void render_pixels(std::span<const glm::ivec2> pixels, Room& room, PassCounts& counts);
  void add_found(std::span<const glm::ivec2> pixels, Room& room, PassCounts& counts) const;
  void aim(std::span<const glm::ivec2> pixels, Room& room) const;
  void see(std::span<const glm::ivec2> pixels, Room& room, PathCounts& counts) const;
  void add_irradiance(std::span<const glm::ivec2> pixels, Room& room, PassCounts& counts) const;
  void place_nonfinite(std::span<const glm::ivec2> pixels, const Room& room, PassCounts& counts) const;
  size_t index(const glm::ivec2& pixel) const {
    return static_cast<size_t>(pixel.y) * static_cast<size_t>(view_.width) + static_cast<size_t>(pixel.x);
  }

  const View& view_;
  const Caster& caster_;
  RayGenerator rays_;
  Surfaces surfaces_;
  Integrator integrator_;
  ExtraLayers extra_;
  uint64_t seed_;
  TileGrid grid_;
  std::vector<size_t> tiles_;  // of the part
  std::vector<PixelBatch> batches_;
  std::vector<glm::vec3> extra_batches_;

  Pass pass_;
  std::vector<uint8_t> done_;       // per tile of the part
  std::vector<PassCounts> counts_;  // per tile of the part
  std::atomic<size_t> finished_;    // number of tiles

  std::mutex idle_rooms_lock_;
  std::vector<std::unique_ptr<Room>> idle_rooms_;
};

}  // namespace voxref
