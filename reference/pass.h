#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "progress.h"
#include "reference/extra_layers.h"
#include "reference/integrator.h"
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
  int samples = 1;         ///< points of it
  int samples_before = 0;  ///< taken by earlier passes
};

/// Renders an image pass by pass. A pass is one randomization of the sampler at each pixel: its samples are stratified
/// among each other and independent of all other passes and pixels. Keeps references to its arguments.
class PassRenderer {
 public:
  PassRenderer(const Scene& scene, const Caster& caster, const View& view, std::optional<int> max_depth, uint64_t seed,
               const ExtraLayers& extra);
  PassRenderer(const PassRenderer&) = delete;  // its parts refer to one another

  /// Renders one pass; the same bits whatever the number of threads. @param report takes the finished fraction, from
  /// any thread. @returns nothing when the caller cancelled: batches() are then incomplete
  std::optional<PassCounts> render(const Pass& pass, const Progress& progress,
                                   const std::function<void(double)>& report);

  /// One per pixel, row by row, of the pass that was rendered last.
  std::span<const PixelBatch> batches() const { return batches_; }
  /// The extra layers' means, as many per pixel as there are.
  std::span<const glm::vec3> extra_batches() const { return extra_batches_; }

 private:
  /// False when it was cancelled: asked at every pixel, because a tile of many samples may take a minute.
  bool render_tile(size_t tile, const Pass& pass, const Progress& progress, PassCounts& counts);
  void render_pixel(int x, int y, const Pass& pass, PassCounts& counts);

  const View& view_;
  RayGenerator rays_;
  Surfaces surfaces_;
  Integrator integrator_;
  ExtraTracer extra_;
  uint64_t seed_;
  size_t columns_, rows_;  // of tiles
  std::vector<PixelBatch> batches_;
  std::vector<glm::vec3> extra_batches_;
};

}  // namespace voxref
