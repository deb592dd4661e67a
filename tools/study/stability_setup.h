#pragma once
#include <glm/mat3x3.hpp>
#include <initializer_list>
#include <optional>
#include <string>

#include "cone/gather.h"
#include "make_scenes/mesh.h"
#include "pipeline.h"

namespace voxref {

/// The largest; NaN where any is, which std::max may pass over.
double worst_of(std::initializer_list<double> values);

// What several curves of stability are measured on.

/// A wall of unit voxels across a cube of `side` of them, whose first layer is side / 2: white, normal -x.
/// @param thickness voxels
SurfaceGrid wall(int side, int thickness, float opacity);
/// It glows with radiance 1.
Pyramid wall_pyramid(int side, int thickness, float opacity, MipmapFilter filter = MipmapFilter::anisotropic);

/// A black floor, 4 m wide at y = 0 (front up), and a mesh; either glows with radiance 1 or is black.
Scene floor_and(const Mesh& mesh, bool floor_glows, bool mesh_glows);

/// A glowing ball over the floor at height 0.8 m; its radius, metres.
inline constexpr float ball_radius = 0.3f, ball_height = 0.8f;
Scene floor_and_ball(float x);
/// The ball's light on the floor at `offset` from the point below it, as mean radiance over the hemisphere: the form
/// factor of a sphere, cos (r / d)^2.
double ball_light(const glm::vec3& offset);

/// Appends one triangle as an object.
void add_triangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& normal,
                  uint32_t material);

/// The volume of a scene whose voxels show their emission and nothing else.
Pyramid glowing_pyramid(const Scene& scene, const GridOptions& grid);
Medium glowing_medium(const Scene& scene, const GridOptions& grid);

/// Mean radiance over the hemisphere, as luminance: irradiance / pi, gathered with `cones` cones.
double gathered(const Medium& medium, const glm::vec3& position, const glm::vec3& normal, int cones,
                const ConeOptions& options = {});

/// Radiometric, without bounces at the voxels.
Settings small_settings(int resolution);

/// The whole pipeline, which may refuse: that leaves no result.
struct TryTrace {
  /// Seen by one of the scene's cameras. @param width pixels
  TryTrace(const Scene& scene, const Settings& settings, int width, size_t camera = 0);
  /// Luminance; NaN where there is no result, or a pixel of it is not finite.
  double mean() const;
  /// The same of the indirect light alone.
  double mean_indirect() const;

  std::optional<ConeTraceResult> result;
  std::string outcome;  ///< "rendered", or "refused: why"
};

/// Weber's fraction of brightness is 1 to 2 %: below the one a change is not seen, above the other it is.
inline constexpr double weber_low = 0.01, weber_high = 0.02;
/// The least error that a plan is asked for, and half of it: where what is measured is one part of an error of many.
inline constexpr double plan_error = 0.1, half_plan_error = 0.05;

/// Of the Cornell box with a point light, 32 voxels, 16 pixels wide: what it shows where nothing is changed.
inline constexpr int box_voxels = 32, box_width = 16;
double usual_box_mean();

/// Counter-clockwise seen from the axis's tip. @param axis any length
glm::mat3 turn_about(const glm::vec3& axis, float degrees);
/// Every point of the scene, lights and cameras too, turned about the origin and then moved.
Scene placed(Scene scene, const glm::mat3& turn, const glm::vec3& offset);

}  // namespace voxref
