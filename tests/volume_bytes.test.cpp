#include "volume_bytes.h"

#include <cmath>

#include "catch.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "reference/small_scenes.h"

using namespace voxref;

namespace {

View tiny_view(const Scene& scene) {
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = 1;
  return view;
}

}  // namespace

TEST_CASE("What info predicts for each volume is what the pipeline allocates, within 2 %", "[pipeline]") {
  for (const auto& [name, scene] : {std::pair<const char*, Scene>("Cornell box", cornell_box(CornellLight::point)),
                                    {"red and green wall", red_green_wall()},
                                    {"sphere", sphere_furnace(0.5f, 2)}})
    for (const char* profile_name : {"radiometric", "villegas2016"})
      for (const Storage storage : {Storage::float32, Storage::float16, Storage::unorm8})
        for (const int resolution : {64, 128}) {
          Settings settings = profile(profile_name);
          settings.storage = storage;
          settings.grid.resolution = resolution;
          settings.bounce.count = 0;  // all volumes are there without; a bounce adds a radiance per voxel
          const Caster caster(scene);
          const VolumeBytes held = cone_trace(scene, caster, tiny_view(scene), settings).bytes;
          const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize);
          VolumeBytes predicted = predict_bytes(surfaces, settings);
          CAPTURE(name, profile_name, storage_names[size_t(storage)], resolution);
          for (const auto& [volume, bytes] : held) {
            CAPTURE(volume);
            CHECK(double(predicted[volume]) == Approx(double(bytes)).epsilon(0.02));
          }
          CHECK(held.size() >= predicted.size() - 1);  // raw cones hold no depths
        }
}

TEST_CASE("A bounce holds a second radiance, and the surfaces while cones are traced", "[pipeline]") {
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  Settings settings = profile("radiometric");
  settings.grid.resolution = 32;
  settings.bounce.count = 1;
  const ConeTraceResult result = cone_trace(scene, caster, tiny_view(scene), settings);
  size_t sum = 0;
  for (const auto& [volume, bytes] : result.bytes)
    if (volume != "total") sum += bytes;
  CHECK(result.bytes.at("total") == sum);
  CHECK(result.bytes.at("radiance") == 2 * result.voxels_occupied * sizeof(glm::vec3));
  settings.bounce.count = 0;
  CHECK(cone_trace(scene, caster, tiny_view(scene), settings).bytes.at("total") < sum);
}
