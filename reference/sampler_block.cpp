#include "reference/sampler_block.h"

#include "reference/lanes.h"

namespace voxref {

namespace {

VOXREF_WIDEST void fill_1d(size_t count, const uint64_t* keys, const uint32_t* reversed_indices, uint32_t dimension,
                           uint32_t* x) {
  for (size_t i = 0; i < count; ++i) x[i] = Sampler::bits_1d(keys[i], reversed_indices[i], dimension);
}

VOXREF_WIDEST void fill_2d(size_t count, const uint64_t* keys, const uint32_t* reversed_indices, uint32_t dimension,
                           uint32_t* x, uint32_t* y) {
  for (size_t i = 0; i < count; ++i) {
    const glm::uvec2 bits = Sampler::bits_2d(keys[i], reversed_indices[i], dimension);
    x[i] = bits.x;
    y[i] = bits.y;
  }
}

}  // namespace

void SamplerBlock::bits_1d(uint32_t dimension, std::vector<uint32_t>& x) const {
  x.resize(keys_.size());
  fill_1d(keys_.size(), keys_.data(), reversed_indices_.data(), dimension, x.data());
}

void SamplerBlock::bits_2d(uint32_t dimension, std::vector<uint32_t>& x, std::vector<uint32_t>& y) const {
  x.resize(keys_.size());
  y.resize(keys_.size());
  fill_2d(keys_.size(), keys_.data(), reversed_indices_.data(), dimension, x.data(), y.data());
}

}  // namespace voxref
