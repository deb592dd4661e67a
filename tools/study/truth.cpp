#include "study/truth.h"

#include <fmt/format.h>

namespace voxref {

PathResult trace_paths(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options,
                       const Progress& progress) {
  PathResult result = path_trace(scene, caster, view, options, progress);
  if (result.interrupted) throw Interrupted();
  return result;
}

Truth trace_truth(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options,
                  const Progress& progress) {
  const PathResult paths = trace_paths(scene, caster, view, options, progress);
  const bool indirect = has_indirect_to_compare(scene, view, paths.image);
  return {measured_path(paths.image, indirect), indirect, paths.seconds, paths.nonfinite, paths.first_nonfinite};
}

std::string missing_paths(uint64_t nonfinite, const std::string& first_nonfinite) {
  if (nonfinite == 0) return {};
  return fmt::format("{} contributions of the path tracer are NaN or infinite and left out, the first at {}", nonfinite,
                     first_nonfinite);
}

bool has_indirect_to_compare(const Scene& scene, const View& view, const Image& path) {
  return compares_indirect(scene, view) && measured_path(path, true).mean() > 0.0;
}

}  // namespace voxref
