#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "parallel.h"

namespace voxref {

/// Correlates a plane [y][x] with the separable kernel along_x(x) along_y(y). Beyond its border the plane goes on with
/// its edge values. T is float, or double where differences of large sums matter.
/// @param along_x, along_y an odd number of taps each, the centre in the middle
template <class T>
std::vector<T> convolve(int width, int height, std::span<const T> plane, std::span<const T> along_x,
                        std::span<const T> along_y) {
  constexpr size_t rows_per_task = 16;
  const auto w = static_cast<size_t>(width), h = static_cast<size_t>(height);
  const size_t radius_x = along_x.size() / 2, radius_y = along_y.size() / 2;
  std::vector<T> across(w * h, T(0)), result(w * h, T(0));
  parallel_for(h, rows_per_task, [&](size_t begin, size_t end) {
    std::vector<T> padded(w + 2 * radius_x);
    for (size_t y = begin; y < end; ++y) {
      const std::span<const T> row = plane.subspan(y * w, w);
      std::fill_n(padded.begin(), radius_x, row.front());
      std::copy(row.begin(), row.end(), padded.begin() + static_cast<std::ptrdiff_t>(radius_x));
      std::fill_n(padded.rbegin(), radius_x, row.back());
      for (size_t tap = 0; tap < along_x.size(); ++tap)
        for (size_t x = 0; x < w; ++x) across[y * w + x] += along_x[tap] * padded[x + tap];
    }
  });
  parallel_for(h, rows_per_task, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y)
      for (size_t tap = 0; tap < along_y.size(); ++tap) {
        const size_t source = std::min(std::max(y + tap, radius_y) - radius_y, h - 1);
        for (size_t x = 0; x < w; ++x) result[y * w + x] += along_y[tap] * across[source * w + x];
      }
  });
  return result;
}

}  // namespace voxref
