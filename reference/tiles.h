#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace voxref {

/// One of several renders that make up an image together: each takes some of its tiles, with all their samples.
///
/// Cutting the image rather than the samples keeps the bits: each pixel is summed in one place in one order, whoever
/// renders it, so that joining parts is copying pixels, in any order. (Sums over samples taken apart would have to be
/// added exactly to be the same in any order.) The parts' files are together as large as the image, each pixel of a
/// part is final and has its final error bar, and there may be as many parts as tiles, whatever the number of samples.
struct Part {
  int index = 1;  ///< 1 to count
  int count = 1;
  bool operator==(const Part&) const = default;
};

/// An image cut in squares, row by row. Tiles keep neighbouring rays, which meet the same triangles, on one core; with
/// 32 x 32 pixels they fill a wave of paths even where each pixel has a single sample.
class TileGrid {
 public:
  static constexpr int side = 32;

  TileGrid(int width, int height)
      : width_(width), height_(height), columns_((width + side - 1) / side), rows_((height + side - 1) / side) {}

  size_t count() const { return static_cast<size_t>(columns_) * static_cast<size_t>(rows_); }

  /// Calls visit(x, y) for the tile's pixels, row by row.
  template <class Visit>
  void visit_pixels(size_t tile, const Visit& visit) const {
    const int left = static_cast<int>(tile % static_cast<size_t>(columns_)) * side;
    const int top = static_cast<int>(tile / static_cast<size_t>(columns_)) * side;
    for (int y = top; y < std::min(top + side, height_); ++y)
      for (int x = left; x < std::min(left + side, width_); ++x) visit(x, y);
  }

  /// The tiles of a part, in rising order; each tile is in one part, and parts differ by one tile at most.
  std::vector<size_t> tiles_of(const Part& part) const {
    // Ordered by the fractional parts of multiples of the golden ratio, any run of tiles is spread evenly over the
    // image (Kronecker's sequence), and so is the work; every n-th tile would be a column where n divides the columns.
    std::vector<size_t> order(count());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [](size_t a, size_t b) { return a * golden < b * golden; });
    const auto begin_of = [&](int index) {
      return order.begin() +
             static_cast<std::ptrdiff_t>(count() * static_cast<size_t>(index) / static_cast<size_t>(part.count));
    };
    std::vector<size_t> tiles(begin_of(part.index - 1), begin_of(part.index));
    std::sort(tiles.begin(), tiles.end());
    return tiles;
  }

 private:
  static constexpr size_t golden = 0x9e3779b97f4a7c15u;  // 2^64 / golden ratio, odd: multiples modulo 2^64 are distinct
  int width_, height_, columns_, rows_;
};

}  // namespace voxref
