#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace voxref {

/// How the numbers of a picture stand for linear light.
enum class Transfer : uint8_t {
  linear,
  srgb,    ///< IEC 61966-2-1
  gamma22  ///< the power 2.2, as the published shaders write their pictures
};
/// "linear", "srgb" or "gamma22"; none: there is no such transfer.
std::optional<Transfer> transfer_called(std::string_view name);

/// Linear value of a number in [0,1], by IEC 61966-2-1; the inverse of srgb_encode.
float srgb_decode(float encoded);
/// Linear value by any transfer. The power takes the sign of what is below 0 along.
float decode(Transfer transfer, float encoded);

}  // namespace voxref
