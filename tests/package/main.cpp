#include <voxref/make_scenes/builders.h>
#include <voxref/pipeline.h>
#include <voxref/reference/path.h>
#include <voxref/study/pareto.h>

#include <cstdio>

// Renders an empty scene with both renderers through the installed headers and libraries: the background comes back.
// Then one study of one setting, on a plane.
int main() {
  const voxref::Scene scene;
  const voxref::Caster caster(scene);
  voxref::View view;
  view.width = view.height = 4;
  view.camera = voxref::framing_camera(scene);
  view.background = {0.25f, 0.5f, 0.75f};
  voxref::Settings settings = voxref::profile("radiometric");
  settings.grid.resolution = 16;
  voxref::PathOptions options;
  options.spp = 2;
  const glm::vec3 cone = voxref::cone_trace(scene, caster, view, settings).mean;
  const glm::vec3 path = voxref::path_trace(scene, caster, view, options).mean;
  std::printf("cone %g %g %g path %g %g %g\n", cone.r, cone.g, cone.b, path.r, path.g, path.b);

  voxref::StudyScene plane{"plane", voxref::point_light_over_plane(), {}};
  plane.view.camera = plane.scene.cameras.at(0);
  const voxref::ParetoGrid grid{{{16}, {0}, {voxref::Storage::float32}, {1.0f}, {4}}, 8, 16, 1, 2, 1};
  const bool measured = voxref::pareto_section(plane, grid, {}).tables.at(0).number(0, "rel_error") < 1.0;
  return cone == view.background && path == view.background && measured ? 0 : 1;
}
