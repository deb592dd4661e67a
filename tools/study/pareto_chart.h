#pragma once
#include <span>
#include <string>

#include "scene/camera.h"
#include "study/chart.h"
#include "study/table.h"

namespace voxref {

/// Error over time: all of the cones' settings, those on their frontier with letters and error bars, and the path
/// tracer by samples. @param view of the images @param indirect whether errors are of the indirect light alone
/// @param cones, paths tables of pareto_section() @param frontier rows of `cones`, by rising time
Chart pareto_chart(const std::string& scene, const View& view, bool indirect, const Table& cones, const Table& paths,
                   std::span<const size_t> frontier);

}  // namespace voxref
