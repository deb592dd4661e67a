#include "reference/tiles.h"

#include <algorithm>
#include <array>

#include "catch.h"

namespace voxref {

TEST_CASE("Parts share out all tiles, each once, and differ by one at most", "[tiles]") {
  const TileGrid grid(200, 100);  // 7 x 4 tiles
  REQUIRE(grid.count() == 28);
  for (const int count : {1, 2, 3, 7, 11, 28}) {
    std::vector<size_t> all;
    for (int index = 1; index <= count; ++index) {
      const std::vector<size_t> tiles = grid.tiles_of({index, count});
      CHECK(std::is_sorted(tiles.begin(), tiles.end()));
      CHECK(tiles.size() >= grid.count() / static_cast<size_t>(count));
      CHECK(tiles.size() <= grid.count() / static_cast<size_t>(count) + 1);
      all.insert(all.end(), tiles.begin(), tiles.end());
    }
    std::sort(all.begin(), all.end());
    REQUIRE(all.size() == grid.count());
    for (size_t i = 0; i < all.size(); ++i) CHECK(all[i] == i);
  }
}

TEST_CASE("Tiles cover an image whose sides they do not divide, each pixel once", "[tiles]") {
  const int width = 75, height = 40;
  const TileGrid grid(width, height);
  std::vector<int> visits(static_cast<size_t>(width * height), 0);
  for (size_t tile = 0; tile < grid.count(); ++tile)
    grid.visit_pixels(tile, [&](int x, int y) { ++visits[static_cast<size_t>(y * width + x)]; });
  CHECK(std::count(visits.begin(), visits.end(), 1) == width * height);
}

TEST_CASE("A part is spread over the image", "[tiles]") {
  // Of 32 x 32 tiles: of the 256 of each quadrant a fair share, to a quarter of it.
  const TileGrid grid(1024, 1024);
  for (const int count : {2, 4, 8, 16}) {
    std::array<int, 4> quadrants{};
    for (const size_t tile : grid.tiles_of({1, count})) ++quadrants[tile / 512 * 2 + tile % 32 / 16];
    CAPTURE(count);
    for (const int tiles : quadrants) CHECK(tiles == Approx(256.0 / count).epsilon(0.25));
  }
}

}  // namespace voxref
