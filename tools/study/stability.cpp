#include "study/stability.h"

#include <stdexcept>
#include <utility>

namespace voxref {

std::vector<Failure (*)()> failures() {
  return {leak_by_level, leak_between_rooms, contact_gap, step_dependence, step_bands, cone_bands, emitter_growth,
          flicker,       camera_flicker,     rotation,    scale,           distance,   clamping,   opposite_normals,
          specular_blur, feedback_gain,      cone_gaps,   odd_scenes};
}

namespace {

std::string direction(Worse worse) {
  switch (worse) {
    case Worse::larger:
      return "larger";
    case Worse::smaller:
      return "smaller";
    case Worse::either:
      return "either way";
  }
  throw std::logic_error("no such direction");
}

}  // namespace

// A curve takes a second: there is nothing to leave out under --quick.
StudyResult run_stability(const StudyRequest& request) {
  StudyResult result{"stability", "where the method breaks"};
  Table thresholds{"stability_thresholds",
                   "What regression tests hold",
                   {{"threshold", ""}, {"value", ""}, {"unit", ""}, {"worse", ""}, {"meaning", ""}}};
  for (const auto& measure : failures()) {
    request.progress.check();
    result.sections.push_back(timed_section("", [&](Section& section) {
      Failure failure = measure();
      section.title = failure.title;
      section.text = failure.text;
      for (const Threshold& t : failure.thresholds)
        thresholds.add({t.name, t.value, t.unit, direction(t.worse), t.meaning});
      section.charts = std::move(failure.charts);
      section.warnings = std::move(failure.warnings);
      section.tables.push_back(std::move(failure.table));
    }));
  }
  Section all{"Thresholds", "tests/stability holds each of them to a limit: none may get worse.", {thresholds}, {}};
  for (const Section& section : result.sections) all.seconds += section.seconds;  // they come from there
  result.sections.push_back(std::move(all));
  return result;
}

}  // namespace voxref
