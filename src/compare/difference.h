#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

namespace voxref {

/// A value a under test agrees with its reference b when |a - b| <= absolute + relative |b|. NaN and infinity agree
/// with nothing.
struct Tolerance {
  double absolute = 1e-5, relative = 1e-3;

  bool accepts(float a, float b) const;
};

/// A place in an image (z = 0) or a volume, and the two values there. a is the one under test.
struct Mismatch {
  glm::ivec3 at{0};
  int channel = 0;
  float a = 0.0f, b = 0.0f;
};

/// What is different between two arrays of one shape. Values that are not finite on either side count as differing, and
/// in no mean.
struct Difference {
  /// Decades of |a - b| from 1e-8 upward; the first bin holds what is below, the last what is above 1e4.
  static constexpr int first_decade = -8, last_decade = 4;
  static constexpr size_t bins = last_decade - first_decade + 2;
  static constexpr size_t most_worst = 8;

  uint64_t values = 0;     ///< compared
  uint64_t differing = 0;  ///< over the tolerance, or not finite
  uint64_t nonfinite_a = 0, nonfinite_b = 0;
  std::optional<Mismatch> first_nonfinite;  ///< in the order of the file
  std::optional<Mismatch> first;            ///< over the tolerance, in the order of the file
  std::vector<Mismatch> worst;              ///< at most most_worst, those with the largest |a - b| first
  std::array<uint64_t, bins> histogram{};   ///< of |a - b|, see first_decade; equal values are in none
  double max_abs = 0.0;                     ///< |a - b|
  double peak = 0.0;                        ///< |b|
  double sum_a = 0.0, sum_b = 0.0;
  double sum_squares = 0.0;   ///< (a - b)^2
  double sum_relative = 0.0;  ///< (a - b)^2 / (b^2 + 0.01)

  uint64_t finite() const { return values - nonfinite; }
  double mean_signed() const { return mean(sum_a - sum_b); }
  double rmse() const;
  double relmse() const { return mean(sum_relative); }
  /// 20 log10(peak / rmse), dB; infinite where all is equal, NaN where there is nothing but 0 to be equal to.
  double psnr() const;
  double fraction() const { return values ? double(differing) / double(values) : 0.0; }
  double mean(double sum) const { return finite() ? sum / double(finite()) : 0.0; }

  uint64_t nonfinite = 0;  ///< places where either side is not finite

  /// Takes in what was found in other places, in any order.
  void append(const Difference& other);
};

/// Where a row of values begins, and how many channels in turn belong to one place.
struct Row {
  glm::ivec3 at{0};
  int channel = 0;   ///< of the first value
  int channels = 1;  ///< to a place
};
void compare_row(Difference& difference, std::span<const float> a, std::span<const float> b, const Row& row,
                 const Tolerance& tolerance);

/// JSON knows neither NaN nor infinity: null stands for both.
nlohmann::json finite_or_null(double value);
/// {place [x,y,z,channel] or [x,y,channel], a, b}; a value that is not finite is a string: "nan", "inf", "-inf".
nlohmann::json to_json(const Mismatch& mismatch, bool volume);
/// The keys of cli.md that are the same for images and volumes: nonfinite_a, nonfinite_b, first_nonfinite, max_abs,
/// mean_signed, rmse, relmse, relmse_formula, worst, worst_places, first, differing, histogram; of volumes also psnr
/// and psnr_formula, for it is no display's.
nlohmann::json to_json(const Difference& difference, bool volume);

}  // namespace voxref
