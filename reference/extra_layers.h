#pragma once
#include <string>
#include <vector>

namespace voxref {

/// Layers on request.
struct ExtraLayers {
  int bounces = 0;          ///< bounce.1 ... bounce.N: the indirect light by its number of bounces, W/(sr m^2)
  bool irradiance = false;  ///< what arrives at the first hit, on the shading normal's side, W/m^2; costs a path more

  size_t count() const { return static_cast<size_t>(bounces) + (irradiance ? 1 : 0); }
  /// count() of them; irradiance is the last.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (int k = 1; k <= bounces; ++k) names.push_back("bounce." + std::to_string(k));
    if (irradiance) names.emplace_back("irradiance");
    return names;
  }
};

}  // namespace voxref
