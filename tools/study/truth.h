#pragma once
#include <cstdint>
#include <string>

#include "compare/measured.h"
#include "reference/path.h"

namespace voxref {

/// path_trace() of all the samples that were asked for. @throws Interrupted when it was stopped before
PathResult trace_paths(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options,
                       const Progress& progress);

/// What path tracing had to leave out, in a sentence; empty where nothing is missing. @param nonfinite and
/// @param first_nonfinite as PathResult's
std::string missing_paths(uint64_t nonfinite, const std::string& first_nonfinite);

/// What cone-traced images are held against.
struct Truth {
  Measured light;
  bool indirect = false;        ///< whether that is the indirect light alone, see has_indirect_to_compare
  double seconds = 0;           ///< that it took
  uint64_t nonfinite = 0;       ///< as PathResult's: paths that are missing in it
  std::string first_nonfinite;  ///< as PathResult's

  std::string missing() const { return missing_paths(nonfinite, first_nonfinite); }
};
/// @throws Interrupted
Truth trace_truth(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options,
                  const Progress& progress);

/// Whether studies and plans compare the indirect light: as compares_indirect, but all light where paths found none
/// that is indirect. @param path of the scene from there
bool has_indirect_to_compare(const Scene& scene, const View& view, const Image& path);

}  // namespace voxref
