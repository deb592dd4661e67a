#include "study/stability_setup.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numbers>

#include "compare/measured.h"
#include "error.h"
#include "image/image.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"
#include "study/study_scenes.h"
#include "voxel/mipmap.h"

namespace voxref {

double worst_of(std::initializer_list<double> values) {
  double worst = *values.begin();
  for (const double value : values)
    if (!std::isnan(worst) && !(value <= worst)) worst = value;
  return worst;
}

SurfaceGrid wall(int side, int thickness, float opacity) {
  SurfaceGrid surfaces;
  surfaces.grid.size = glm::ivec3(side);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = side / 2; x < side / 2 + thickness; ++x) {
        surfaces.voxels.emplace_back(x, y, z);
        surfaces.albedo.emplace_back(1.0f, 1.0f, 1.0f, opacity);
        surfaces.normal.emplace_back(-1.0f, 0.0f, 0.0f);
        surfaces.centroid.push_back(surfaces.grid.center(surfaces.voxels.back()));
      }
  return surfaces;
}

Pyramid wall_pyramid(int side, int thickness, float opacity, MipmapFilter filter) {
  const SurfaceGrid surfaces = wall(side, thickness, opacity);
  return mipmap(surfaces, std::vector<glm::vec3>(surfaces.size(), glm::vec3(1.0f)), {filter});
}

Scene floor_and(const Mesh& mesh, bool floor_glows, bool mesh_glows) {
  Scene scene;
  const auto material = [&](const char* name, bool glows) {
    return add_material(scene,
                        glows ? emitter(name, glm::vec3(0.0f), glm::vec3(1.0f)) : lambertian(name, glm::vec3(0.0f)));
  };
  add_object(scene, "floor", plane(4.0f), material("floor", floor_glows));
  add_object(scene, "mesh", mesh, material("mesh", mesh_glows));
  return scene;
}

Scene floor_and_ball(float x) {
  return floor_and(moved(scaled(icosphere(3), ball_radius), {x, ball_height, 0.0f}), false, true);
}

double ball_light(const glm::vec3& offset) {
  const auto square = double(glm::dot(offset, offset)) + double(ball_height) * double(ball_height);
  return double(ball_radius) * double(ball_radius) / square * double(ball_height) / std::sqrt(square);
}

void add_triangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& normal,
                  uint32_t material) {
  Mesh mesh;
  for (const glm::vec3& p : {a, b, c}) add_vertex(mesh, p, normal);
  mesh.triangles.emplace_back(0u, 1u, 2u);
  add_object(scene, "triangle", mesh, material);
}

Pyramid glowing_pyramid(const Scene& scene, const GridOptions& grid) {
  const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), grid), {});
  std::vector<glm::vec3> radiance = surfaces.emission;
  radiance.resize(surfaces.size());
  return mipmap(surfaces, radiance, {});
}

Medium glowing_medium(const Scene& scene, const GridOptions& grid) { return make_medium(glowing_pyramid(scene, grid)); }

double gathered(const Medium& medium, const glm::vec3& position, const glm::vec3& normal, int cones,
                const ConeOptions& options) {
  const GatherPoint point{position, normal, normal, {}};
  const DiffuseGather light = gather_diffuse(medium, pixel_cones(cones), point, options, {}, glm::vec3(0.0f));
  return double(luminance(light.irradiance)) / std::numbers::pi;
}

Settings small_settings(int resolution) {
  Settings settings;
  settings.grid.resolution = resolution;
  settings.bounce.count = 0;
  return settings;
}

TryTrace::TryTrace(const Scene& scene, const Settings& settings, int width, size_t camera) : outcome("rendered") {
  View view;
  view.camera = scene.cameras.at(camera);
  try {
    result = cone_trace(scene, Caster(scene), sized(view, width), settings);
  } catch (const Error& error) {
    outcome = std::string("refused: ") + error.what();
  }
}

double TryTrace::mean() const {
  if (!result || result->image.nonfinite > 0) return std::numeric_limits<double>::quiet_NaN();
  return double(luminance(result->mean));
}

double TryTrace::mean_indirect() const {
  if (std::isnan(mean())) return mean();
  return measured_cone(result->image.image, true).mean();
}

double usual_box_mean() {
  return TryTrace(cornell_box(CornellLight::point), small_settings(box_voxels), box_width).mean();
}

glm::mat3 turn_about(const glm::vec3& axis, float degrees) {
  return glm::mat3(glm::rotate(glm::mat4(1.0f), glm::radians(degrees), glm::normalize(axis)));
}

Scene placed(Scene scene, const glm::mat3& turn, const glm::vec3& offset) {
  for (glm::vec3& p : scene.positions) p = turn * p + offset;
  for (glm::vec3& n : scene.normals) n = turn * n;
  for (Light& light : scene.lights) {
    light.position = turn * light.position + offset;
    light.direction = turn * light.direction;
  }
  for (Camera& camera : scene.cameras)
    for (int column = 0; column < 4; ++column) {
      const glm::vec3 moved =
          turn * glm::vec3(camera.world_from_camera[column]) + (column == 3 ? offset : glm::vec3(0.0f));
      camera.world_from_camera[column] = glm::vec4(moved, camera.world_from_camera[column].w);
    }
  return scene;
}

}  // namespace voxref
