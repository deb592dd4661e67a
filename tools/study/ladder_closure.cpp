// Does the ladder close: do its rungs, added up, lead from one of its ends to the other?
#include <cmath>

#include "pipeline.h"
#include "study/ladder.h"
#include "study/truth.h"

namespace voxref {

Table closure(const StudyScene& scene, const View& view, const LadderOptions& options, const LadderClimb& climb,
              const std::vector<Region>& regions, std::vector<std::string>& warnings, const Progress& progress) {
  const Caster caster(scene.scene);
  PathOptions path;
  path.spp = options.spp * options.tries;
  path.seed = static_cast<uint64_t>(options.tries + 1);  // the rungs have those before
  const PathResult traced = trace_paths(scene.scene, caster, view, path, progress);
  if (const std::string missing = missing_paths(traced.nonfinite, traced.first_nonfinite); !missing.empty())
    warnings.push_back("closure: " + missing);
  const Measured truth = measured_path(traced.image, false),
                 cone = measured_cone(
                     cone_trace(scene.scene, caster, view, shipped_settings(options), {}, progress).image.image, false);

  Table table{"ladder_closure_" + scene.name,
              "The sum of the rungs before the goal's parameters, against their ends rendered anew, in percent of the "
              "path-traced mean of the whole image",
              {{"region", ""}, {"sum", "%"}, {"ends", "%"}, {"gap", "%"}, {"gap_stderr", "%"}, {"p", ""}}};
  const double percent = 100.0 / truth.mean();
  for (const Region& region : regions) {
    double sum = 0.0, ends = 0.0, variance = 0.0;
    for (size_t r = 1; r < climb.first_parameter; ++r)
      sum += rung_step(climb.rungs[r - 1], climb.rungs[r], region.pixels).bias.mean;
    const auto count = double(region.pixels.size());
    for (const size_t i : region.pixels) {
      ends += (cone.value[i] - truth.value[i]) / count;
      variance += truth.standard_error[i] * truth.standard_error[i] / (count * count);
    }
    const Estimate total = rung_step(climb.rungs[0], climb.rungs[climb.first_parameter - 1], region.pixels).bias;
    const Welch gap({sum, total.error, total.freedom}, {ends, std::sqrt(variance), path.randomizations - 1.0});
    table.add({region.name, percent * sum, percent * ends, percent * gap.difference, percent * gap.error, gap.p()});
  }
  return table;
}

}  // namespace voxref
