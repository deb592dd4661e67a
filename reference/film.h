#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "image/image.h"
#include "reference/pass.h"

namespace voxref {

/// Joins the passes of a render. All sums are float64: at a million samples they are still right.
///
/// Samples within a pass are not independent, so the error bar comes from the scatter of the passes. With n_i samples
/// and mean m_i of pass i, N = sum n_i and m = sum n_i m_i / N,
///
///   standard error^2 = sum n_i^2 (m_i - m)^2 / (N^2 - sum n_i^2),
///
/// the ratio estimator of cluster sampling (Cochran 1977, Sampling Techniques). With equal n_i it is the textbook
/// variance of a mean of means; with unequal ones it is right but for terms of relative order 1 / passes, however a
/// pass's variance falls with its number of samples.
class Film {
 public:
  Film(int width, int height, const ExtraLayers& extra = {});

  /// @param batches one per pixel, row by row @param samples that each is the mean of
  /// @param extra the extra layers, as many per pixel as there are
  void add(std::span<const PixelBatch> batches, int samples, std::span<const glm::vec3> extra = {});

  int samples() const { return samples_; }  ///< per pixel
  int passes() const { return passes_; }

  /// Mean standard error / mean value, as luminance over the image; 0 for a black image.
  double noise() const;
  /// Of R,G,B over the image; pixels are independent.
  glm::vec3 mean() const;
  glm::vec3 mean_stderr() const;
  /// The layers of `path`: R,G,B = direct + indirect + emission exactly (summed in that order in float32), standard
  /// errors, and what the camera sees, as means over the samples that hit a surface; then the extra layers.
  Image image() const;

  /// All sums, for a checkpoint.
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  enum Quantity { red, green, blue, total_y, indirect_y, quantity_count };
  struct Moments {
    double sum = 0.0, weighted_sum = 0.0, square_sum = 0.0;  // of n_i m_i, n_i^2 m_i, (n_i m_i)^2
  };
  struct Pixel {
    std::array<Moments, quantity_count> moments;
    glm::dvec3 emission{0.0}, direct{0.0}, indirect{0.0};
    glm::dvec3 albedo{0.0}, normal{0.0};
    double depth = 0.0, hits = 0.0;
  };
  double mean(const Moments& moments) const { return moments.sum / samples_; }
  double variance(const Moments& moments) const;
  void add_extra_layers(Image& image) const;

  int width_, height_;
  int samples_ = 0, passes_ = 0;
  double square_samples_ = 0.0;  // sum n_i^2
  std::vector<Pixel> pixels_;
  ExtraLayers extra_layers_;
  std::vector<glm::dvec3> extra_;  // sums of n_i m_i, extra_layers_.count() per pixel
};

}  // namespace voxref
