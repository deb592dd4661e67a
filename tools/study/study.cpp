#include "study/study.h"

#include <array>
#include <chrono>
#include <string_view>

namespace voxref {

Progress inside(const Progress& whole, const std::string& part) {
  Progress progress = whole;
  if (whole.report)
    progress.report = [report = whole.report, part](std::string_view stage, double fraction) {
      report(part + ", " + std::string(stage), fraction);
    };
  return progress;
}

Section timed_section(const std::string& title, const std::function<void(Section&)>& make) {
  const auto start = std::chrono::steady_clock::now();
  Section section;
  section.title = title;
  make(section);
  section.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return section;
}

std::span<const Study> studies() {
  static const std::array list = {
      Study{"pareto", "error of the indirect light against time, for many settings and for the path tracer", run_pareto,
            true},
      Study{"ladder", "from the path tracer to the shipped settings, one approximation at a time", run_ladder, true,
            true},
      Study{"thesis", "the tables of Villegas 2016 with this program's numbers beside them", run_thesis},
      Study{"stability", "a curve for each way in which the method fails, with theory's beside it", run_stability},
  };
  return list;
}

}  // namespace voxref
