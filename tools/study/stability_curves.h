#pragma once
#include <string>
#include <vector>

#include "cone/gather.h"
#include "study/stability.h"

namespace voxref {

/// The rows of a table as a series; both columns hold numbers.
Series curve(const Table& table, const std::string& x, const std::string& y, const std::string& title,
             ChartStyle style = ChartStyle::line_points);

/// The volume of a scene whose voxels show their emission and nothing else.
Medium glowing_medium(const Scene& scene, const GridOptions& grid);

/// Mean radiance over the hemisphere, as luminance: irradiance / pi, gathered with `cones` cones.
double gathered(const Medium& medium, const glm::vec3& position, const glm::vec3& normal, int cones,
                const ConeOptions& options = {});

/// Largest less smallest of what is left of `values` after its best straight line is taken off, over its mean.
double ripple(const std::vector<double>& values);

}  // namespace voxref
