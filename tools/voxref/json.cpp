#include "json.h"

#include <fmt/format.h>

namespace voxref {

nlohmann::json to_json(const glm::vec3& v) {
  nlohmann::json list = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) list.push_back(std::stod(fmt::format("{}", v[i])));
  return list;
}

nlohmann::json to_json(const PathResult& result) {
  return {{"mean", to_json(result.mean)},
          {"mean_stderr", to_json(result.mean_stderr)},
          {"spp", result.spp},
          {"seconds", result.seconds},
          {"rays", result.rays},
          {"rays_per_second", result.seconds > 0 ? static_cast<double>(result.rays) / result.seconds : 0.0},
          {"nonfinite", result.nonfinite},
          {"interrupted", result.interrupted}};
}

nlohmann::json to_json(const StageSeconds& seconds) {
  return {{"voxelize", seconds.voxelize}, {"shade", seconds.shade},     {"mipmap", seconds.mipmap},
          {"bounce", seconds.bounce},     {"prepare", seconds.prepare}, {"cone_trace", seconds.cone_trace},
          {"total", seconds.total}};
}

nlohmann::json to_json(const ConeTraceResult& result) {
  return {{"mean", to_json(result.mean)},
          {"seconds", to_json(result.seconds)},
          {"bytes", result.bytes},
          {"voxels_occupied", result.voxels_occupied},
          {"grid", {result.grid.size.x, result.grid.size.y, result.grid.size.z}},
          {"bounces", result.bounces},
          {"gain", result.gain},
          {"clamped_voxels", {{"shade", result.clamped_shade.voxels}, {"bounce", result.clamped_bounce.voxels}}},
          {"nonfinite_voxels", result.nonfinite_voxels.count},
          {"nonfinite", result.image.nonfinite}};
}

}  // namespace voxref
