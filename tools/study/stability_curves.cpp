#include "study/stability_curves.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "image/image.h"
#include "voxel/mipmap.h"

namespace voxref {

Series curve(const Table& table, const std::string& x, const std::string& y, const std::string& title,
             ChartStyle style) {
  Series series{title, style, {}};
  for (size_t i = 0; i < table.rows.size(); ++i)
    series.points.push_back({table.number(i, x), table.number(i, y), 0.0, "", 0.0});
  return series;
}

Medium glowing_medium(const Scene& scene, const GridOptions& grid) {
  const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), grid), {});
  std::vector<glm::vec3> radiance = surfaces.emission;
  radiance.resize(surfaces.size());
  return make_medium(mipmap(surfaces, radiance, {}));
}

double gathered(const Medium& medium, const glm::vec3& position, const glm::vec3& normal, int cones,
                const ConeOptions& options) {
  const GatherPoint point{position, normal, normal, {}};
  const DiffuseGather light = gather_diffuse(medium, pixel_cones(cones), point, options, {}, glm::vec3(0.0f));
  return double(luminance(light.irradiance)) / std::numbers::pi;
}

double ripple(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n, middle = 0.5 * (n - 1.0);
  double slope = 0.0, squares = 0.0;
  for (size_t i = 0; i < values.size(); ++i) {
    slope += (double(i) - middle) * values[i];
    squares += (double(i) - middle) * (double(i) - middle);
  }
  slope /= squares;
  double low = 0.0, high = 0.0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double left = values[i] - mean - slope * (double(i) - middle);
    low = std::min(low, left);
    high = std::max(high, left);
  }
  return (high - low) / mean;
}

}  // namespace voxref
