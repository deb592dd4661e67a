#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "study/study.h"
#include "study/thesis_bench.h"

namespace voxref {

// Sections of `study thesis`, in the order of the publication.

/// Bytes of all volumes by scene and resolution.
using MemoryByScene = std::map<std::pair<std::string, int>, size_t>;

/// Tables 4.3, 4.4: under a sun. @param memory gets what the volumes took
Section thesis_stage_times(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress,
                           MemoryByScene& memory);
/// Tables 4.5, 4.6: under a sun.
Section thesis_cone_times(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress);
/// Tables 4.7, 4.8: under one point light.
Section thesis_shadow_times(const std::vector<StudyScene>& lamps, const ThesisSizes& sizes, const Progress& progress);
/// Figures 4.11, 4.32.
Section thesis_apertures(const ThesisSizes& sizes, const Progress& progress);
/// Figures 4.12 to 4.27.
Section thesis_quality(const std::vector<StudyScene>& lamps, const ThesisSizes& sizes, const Progress& progress);
/// Figures 4.28 to 4.30.
Section thesis_specular(const ThesisSizes& sizes, const Progress& progress);
/// Figures 4.33 to 4.35. @param glowing without lamps
Section thesis_emission(const std::vector<StudyScene>& glowing, const ThesisSizes& sizes, const Progress& progress);
/// Table 4.9.
Section thesis_memory_use(const MemoryByScene& memory, const ThesisSizes& sizes);

/// All of them.
StudyResult thesis_study(const StudyRequest& request, const ThesisSizes& sizes);

}  // namespace voxref
