#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline.h"
#include "reference/path.h"
#include "scene/scene.h"
#include "settings.h"

namespace voxref {

enum class GoldenKind : uint8_t {
  path,    ///< a path-traced image with its standard errors: DIR/NAME.exr
  cone,    ///< a cone-traced image: DIR/NAME.exr
  volumes  ///< every volume of the cone tracer: DIR/NAME/
};

/// One thing that the golden set remembers. Small, so that all of them are rendered again in CI.
struct GoldenCase {
  std::string name;
  GoldenKind kind = GoldenKind::path;
  std::string scene;  ///< file in the folder of scenes
  std::string profile = "radiometric";
  std::vector<std::string> assignments{};  ///< key=value on top of the profile
  int side = 96;                           ///< pixels of the square image
  std::optional<int> max_depth{};          ///< path: none: unlimited

  View view(const Scene& loaded) const;
  Settings settings() const;
  PathOptions path(uint64_t seed, int spp) const;
};

/// All cases, in the order in which they are made.
const std::vector<GoldenCase>& golden_cases();

/// Samples per pixel of a path-traced golden, and of the render that is held against it.
inline constexpr int golden_spp = 2048, verified_spp = 512;
inline constexpr uint64_t golden_seed = 20161;

std::string_view kind_name(GoldenKind kind);
/// What the index of the set says of a case: kind, scene and its SHA-256, settings or seed and samples, size.
nlohmann::json describe(const GoldenCase& golden, const Scene& scene);
/// "x86-64, AVX2, FMA": what the processor that runs this offers.
std::string instruction_set();

}  // namespace voxref
