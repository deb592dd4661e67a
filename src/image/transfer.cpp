#include "image/transfer.h"

#include <cmath>

namespace voxref {

std::optional<Transfer> transfer_called(std::string_view name) {
  if (name == "linear") return Transfer::linear;
  if (name == "srgb") return Transfer::srgb;
  if (name == "gamma22") return Transfer::gamma22;
  return std::nullopt;
}

float srgb_decode(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float decode(Transfer transfer, float encoded) {
  switch (transfer) {
    case Transfer::srgb:
      return srgb_decode(encoded);
    case Transfer::gamma22:
      return std::copysign(std::pow(std::abs(encoded), 2.2f), encoded);
    default:
      return encoded;
  }
}

}  // namespace voxref
