#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

namespace voxref {

/// The running average of the published voxelization: four bytes, of which the last counts what was averaged, so that
/// one atomic exchange on the GPU writes them all. Spec section 2 (raster), step 6.
struct RunningAverage8 {
  std::array<uint8_t, 3> value{};
  uint8_t count = 0;  ///< modulo 256: the 256th fragment makes the voxel read as empty

  /// Averages `color` (1 is 255) in: c = floor((c k + V) / (k + 1)). Every step rounds down, so that the result depends
  /// on the order; what lies above 255 loses its upper bits and wraps.
  void add(const glm::vec3& color) {
    if (count == 0) {  // as below, but most voxels get one fragment, and no division
      value = {low_byte(color.x * 255.0f), low_byte(color.y * 255.0f), low_byte(color.z * 255.0f)};
      count = 1;
      return;
    }
    const float before = float(count), after = before + 1.0f;
    for (int channel = 0; channel < 3; ++channel) {
      const float sum = float(value[size_t(channel)]) * before + color[channel] * 255.0f;
      value[size_t(channel)] = low_byte(sum / after);
    }
    ++count;
  }
  bool empty() const { return count == 0; }
  bool operator==(const RunningAverage8&) const = default;

 private:
  /// The last 8 bits of the integer part; 0 where it has none (NaN, out of range).
  static uint8_t low_byte(float x) {
    constexpr float limit = 4294967296.0f;  // 2^32: the shader converts to 32 bits
    return x >= 0.0f && x < limit ? uint8_t(uint32_t(x)) : uint8_t(0);
  }
};

}  // namespace voxref
