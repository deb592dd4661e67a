// Surfaces that face apart and share a voxel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "make_scenes/assemble.h"
#include "make_scenes/shapes.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

constexpr int resolution = 32, placements = 16;
constexpr float albedo = 0.5f;

/// A slab under a sun from above whose upper side sends radiance `albedo`.
Scene sunlit_slab(float bottom, float thickness) {
  Scene scene;
  add_object(scene, "slab", box({-0.9f, bottom, -0.9f}, {0.9f, bottom + thickness, 0.9f}),
             add_material(scene, lambertian("grey", glm::vec3(albedo))));
  scene.lights.push_back(sun("sun", {0.0f, -1.0f, 0.0f}, glm::vec3(std::numbers::pi_v<float>)));
  return scene;
}

/// What the slab's sides look like in its middle, over the true radiance of the lit one.
struct Sides {
  double cancelled = 0.0;  ///< share of the columns whose upper voxel has no normal
  double lit = 0.0, dark = 0.0;
};

Sides sides_of(const Scene& scene, const Settings& settings) {
  const Caster caster(scene);
  const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize);
  const std::vector<glm::vec3> radiance = shade(scene, &caster, surfaces, settings.light, settings.shade).radiance;
  constexpr int middle = resolution / 2;
  int low = resolution, high = -1;
  Sides sides;
  for (size_t i = 0; i < surfaces.size(); ++i) {  // sorted z, y, x
    const glm::ivec3& v = surfaces.voxels[i];
    if (v.x != middle || v.z != middle) continue;
    const double light = double(radiance[i].g) / double(albedo);
    if (v.y < low) {
      low = v.y;
      sides.dark = light;
    }
    if (v.y > high) {
      high = v.y;
      sides.lit = light;
      sides.cancelled = glm::length(surfaces.normal[i]) < two_sided_length ? 1.0 : 0.0;
    }
  }
  return sides;
}

/// Mean over where the slab lies in its voxels. @param thickness voxels
Sides mean_sides(float thickness, Settings settings) {
  settings.grid.resolution = resolution;
  settings.grid.bounds = Bounds{glm::vec3(-1.0f), glm::vec3(1.0f)};
  constexpr float voxel = 2.0f / resolution;
  Sides sum;
  for (int i = 0; i < placements; ++i) {
    const float bottom = voxel * (float(i) + 0.5f) / placements;
    const Sides sides = sides_of(sunlit_slab(bottom, thickness * voxel), settings);
    sum.cancelled += sides.cancelled / placements;
    sum.lit += sides.lit / placements;
    sum.dark += sides.dark / placements;
  }
  return sum;
}

}  // namespace

Failure opposite_normals() {
  Failure failure{
      "Averaged opposite normals",
      "A slab under a sun, its lower side black. Both sides share a voxel with probability 1 - t for a thickness of t "
      "voxels, anywhere in the grid; their normals cancel, and the voxel is lit as a sheet that shows 1/2 to both "
      "sides. So theory is 1 - (1 - t) / 2 above and (1 - t) / 2 below, and nothing of it from one voxel on. The "
      "published profile has no normal there: what it makes of the average in bytes is shown beside it, without traced "
      "shadows, over the same lit radiance.",
      {"stability_opposite_normals",
       "Light that a slab's sides send, over that of the lit one",
       {{"thickness", "voxels"},
        {"cancelled", ""},
        {"lit", ""},
        {"lit_theory", ""},
        {"dark", ""},
        {"dark_theory", ""},
        {"lit_published", ""},
        {"dark_published", ""}}}};
  Settings published = profile("villegas2016");
  published.shade.shadow = VoxelShadow::none;
  const double published_unit = std::numbers::pi;  // its lights' intensity is not divided by pi
  double off = 0.0;
  std::vector<ChartPoint> from_thick;
  // Multiples of a placement's step: at every one of them the share that falls together is exact.
  for (const float t : {0.0625f, 0.25f, 0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f}) {
    const Sides sides = mean_sides(t, small_settings(resolution)), theirs = mean_sides(t, published);
    const double shared = std::max(0.0, 1.0 - double(t));
    failure.table.add({double(t), sides.cancelled, sides.lit, 1.0 - 0.5 * shared, sides.dark, 0.5 * shared,
                       theirs.lit / published_unit, theirs.dark / published_unit});
    off = worst_of({off, std::abs(sides.lit - 1.0 + 0.5 * shared), std::abs(sides.dark - 0.5 * shared),
                    std::abs(sides.cancelled - shared)});
    from_thick.insert(from_thick.begin(), chart_point(double(t), sides.dark));
  }
  failure.charts.push_back({"stability_opposite_normals",
                            "A thin slab's lit and dark side",
                            {"thickness / voxels", false, 0.0},
                            {"radiance / that of the lit side", false, 0.0},
                            {curve(failure.table, "thickness", "lit", "lit side", ChartStyle::points),
                             theory_curve(failure.table, "thickness", "lit_theory", "theory, lit side", "lit side"),
                             curve(failure.table, "thickness", "dark", "dark side", ChartStyle::points),
                             theory_curve(failure.table, "thickness", "dark_theory", "theory, dark side", "dark side"),
                             curve(failure.table, "thickness", "lit_published", "lit side, published profile"),
                             curve(failure.table, "thickness", "dark_published", "dark side, published profile")}});
  failure.charts.back().marks = {{breaks_at(from_thick, weber_low), "1 % and less"}};
  failure.thresholds = {
      {"opposite_dark", from_thick.back().y, "", "what the dark side of the thinnest slab sends, over the lit one's"},
      {"opposite_break", breaks_at(from_thick, weber_low), "voxels",
       "thickness below which the dark side sends over 1 %"},
      {"opposite_theory_gap", off, "", "most that either side or the share of shared voxels is off theory"}};
  return failure;
}

}  // namespace voxref
