#include "voxel/brick_volume.h"

#include "catch.h"

using namespace voxref;

TEST_CASE("absent bricks read as empty and take no texels", "[brick_volume]") {
  BrickVolume<float> volume({20, 9, 8});
  CHECK(volume.brick_grid() == glm::ivec3(3, 2, 1));
  CHECK(volume.brick_count() == 0);
  CHECK(std::as_const(volume)({19, 8, 7}) == 0.0f);
  CHECK(std::as_const(volume)({20, 0, 0}) == 0.0f);
  CHECK(std::as_const(volume)({-1, 0, 0}) == 0.0f);

  const std::vector<glm::ivec3> bricks = {{2, 1, 0}, {0, 0, 0}};
  volume.allocate(bricks);
  CHECK(volume.brick_count() == 2);
  CHECK(volume.slot({2, 1, 0}) == 0);
  CHECK(volume.slot({1, 1, 0}) == volume.absent);
  CHECK(volume.bytes() >= 2 * 512 * sizeof(float) + 6 * sizeof(uint32_t));
}

TEST_CASE("texels keep their place", "[brick_volume]") {
  BrickVolume<int> volume({16, 16, 16});
  const std::vector<glm::ivec3> bricks = {{1, 0, 0}, {1, 1, 1}};
  volume.allocate(bricks);
  int next = 0;
  for (const glm::ivec3& b : bricks)
    for (int i = 0; i < 512; ++i) volume(8 * b + glm::ivec3(i % 8, i / 8 % 8, i / 64)) = ++next;
  // x fastest, then y, then z, brick after brick.
  for (size_t i = 0; i < volume.texels().size(); ++i) CHECK(volume.texels()[i] == int(i) + 1);
  CHECK(volume.brick(1)[0] == 513);
  CHECK(std::as_const(volume)({9, 2, 3}) == 1 + 1 + 8 * 2 + 64 * 3);
}
