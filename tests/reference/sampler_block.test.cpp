#include "reference/sampler_block.h"

#include "catch.h"

using namespace voxref;

TEST_CASE("A block of samplers gives each one's own numbers, to the bit", "[sampler]") {
  // 37: whole vectors of any width, and a rest.
  std::vector<Sampler> samplers;
  SamplerBlock block;
  for (uint32_t i = 0; i < 37; ++i) {
    samplers.emplace_back(randomization_key(5, i / 4, 3, i % 3), i % 4 + (i << 20));
    block.add(samplers.back());
  }
  std::vector<uint32_t> single, x, y;
  for (const uint32_t dimension : {0u, 1u, 77u, 4'000'000'000u}) {
    block.bits_1d(dimension, single);
    block.bits_2d(dimension, x, y);
    REQUIRE(single.size() == samplers.size());
    REQUIRE(x.size() == samplers.size());
    REQUIRE(y.size() == samplers.size());
    for (size_t i = 0; i < samplers.size(); ++i) {
      CHECK(single[i] == samplers[i].bits_1d(dimension));
      CHECK(glm::uvec2(x[i], y[i]) == samplers[i].bits_2d(dimension));
    }
  }
  block.clear();
  block.bits_1d(0, single);
  CHECK(single.empty());
}
