#include <utility>

#include "study/thesis_scenes.h"
#include "study/thesis_sections.h"

namespace voxref {

StudyResult thesis_study(const StudyRequest& request, const ThesisSizes& sizes) {
  StudyResult result{"thesis", "the thesis's tables, measured again"};
  const Progress& progress = request.progress;
  std::vector<StudyScene> scenes = thesis_scenes(request, result.skipped);
  const auto add = [&](Section section) { result.sections.push_back(std::move(section)); };

  light_scenes(scenes, ThesisLight::sun);
  MemoryByScene memory;
  add(thesis_stage_times(scenes, sizes, progress, memory));
  add(thesis_cone_times(scenes, sizes, progress));
  light_scenes(scenes, ThesisLight::point);
  add(thesis_shadow_times(scenes, sizes, progress));
  add(thesis_apertures(sizes, progress));
  std::vector<StudyScene> glowing = glowing_scenes(scenes);
  add(thesis_quality(scenes, sizes, progress));
  add(thesis_specular(sizes, progress));
  scenes.clear();  // hundreds of megabytes
  add(thesis_emission(glowing, sizes, progress));
  result.skipped.emplace_back("figures 4.7 to 4.10 and 4.31: what they show is not described to this study");
  add(thesis_memory_use(memory, sizes));
  return result;
}

StudyResult run_thesis(const StudyRequest& request) {
  ThesisSizes sizes{{64, 128, 256, 512}};
  if (request.quick) sizes = {{32, 64, 128}, 64, 160, 240, 160, 128, 64};
  return thesis_study(request, sizes);
}

}  // namespace voxref
