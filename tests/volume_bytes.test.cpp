#include "volume_bytes.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "allocated.h"
#include "catch.h"
#include "cone/optical_depth.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "reference/small_scenes.h"
#include "voxel/shadow_volume.h"

using namespace voxref;

namespace {

constexpr double within = 0.02;  // what the issue asks for; the C library rounds up by 16 bytes and less

View tiny_view(const Scene& scene) {
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = 1;
  return view;
}

/// A profile with some parameters changed.
struct Setup {
  std::string profile;
  std::vector<std::string> changes;

  Settings settings(int resolution) const {
    Settings settings = voxref::profile(profile);
    settings.grid.resolution = resolution;
    settings.bounce.count = 1;
    for (const std::string& change : changes) apply_assignment(settings, change);
    return settings;
  }
};

/// Each volume that is not always there is there in some of them, and in some it is there for one reason alone.
const std::vector<Setup> setups = {
    {"radiometric", {}},
    {"radiometric", {"bounce.count=2", "storage=float16"}},
    {"radiometric", {"bounce.count=0", "storage=unorm8", "pixel.shadow=visibility"}},
    {"radiometric", {"bounce.count=0", "shade.shadow=volume"}},
    {"radiometric", {"mipmap.filter=isotropic"}},
    {"radiometric", {"bounce.cones=villegas4", "cone.opacity=raw"}},
    {"villegas2016", {}},
    {"villegas2016", {"bounce.count=0"}},
    {"villegas2016", {"storage=float16", "pixel.shadow=visibility"}},
    {"villegas2016", {"bounce.cones=9"}},
    {"villegas2016", {"cone.opacity=extinction", "bounce.count=0"}},
    {"villegas2016", {"shade.shadow_hit=null", "bounce.count=0"}},
};

/// Bytes that making something left allocated.
template <class Make>
size_t bytes_of(const Make& make) {
  const size_t before = allocated_bytes();
  const auto made = make();
  return allocated_bytes() - before;
}

size_t of(const VolumeBytes& bytes, const char* volume) { return bytes.contains(volume) ? bytes.at(volume) : 0; }

}  // namespace

TEST_CASE("What info predicts for each volume is what the pipeline counts, within 2 %", "[volume_bytes]") {
  for (const auto& [name, scene] : {std::pair<const char*, Scene>("Cornell box", cornell_box(CornellLight::point)),
                                    {"red and green wall", red_green_wall()},
                                    {"sphere", sphere_furnace(0.5f, 2)}})
    for (const Setup& setup : setups) {
      const Settings settings = setup.settings(64);
      const Caster caster(scene);
      const VolumeBytes counted = cone_trace(scene, caster, tiny_view(scene), settings).bytes;
      const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize);
      const VolumeBytes predicted = predict_bytes(surfaces, settings);
      CAPTURE(name, to_json(settings).dump());
      REQUIRE(predicted.size() == counted.size());
      for (const auto& [volume, bytes] : predicted) {
        CAPTURE(volume);
        REQUIRE(counted.contains(volume));
        CHECK(double(bytes) == Approx(double(counted.at(volume))).epsilon(within));
        CHECK(bytes > 0);
      }
    }
}

TEST_CASE("The most that the pipeline has allocated at any time is what info predicts, within 2 %", "[volume_bytes]") {
  if (!counts_allocations()) VOXREF_SKIP("a sanitizer allocates");
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  for (const Setup& setup : setups) {
    const Settings settings = setup.settings(128);
    const size_t before = allocated_bytes();
    SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize);
    const size_t predicted = predict_bytes(surfaces, settings).at("total");
    take_peak_of_allocated_bytes();
    const LitVoxels lit = light_voxels(scene, caster, std::move(surfaces), glm::vec3(0.0f), settings);
    gather_image(scene, caster, tiny_view(scene), settings, lit);
    CAPTURE(to_json(settings).dump());
    CHECK(double(take_peak_of_allocated_bytes() - before) == Approx(double(predicted)).epsilon(within));
  }
}

TEST_CASE("Each volume, made alone, allocates what info predicts, within 2 %", "[volume_bytes]") {
  if (!counts_allocations()) VOXREF_SKIP("a sanitizer allocates");
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  for (const Setup& setup : setups) {
    const Settings settings = setup.settings(64);
    CAPTURE(to_json(settings).dump());
    const size_t before = allocated_bytes();
    const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize);
    const size_t surface_bytes = allocated_bytes() - before;
    const VolumeBytes predicted = predict_bytes(surfaces, settings);
    const auto check = [&](size_t bytes, size_t expected) {
      CHECK(double(bytes) == Approx(double(expected)).epsilon(within));
    };
    check(surface_bytes, of(predicted, "surfaces"));
    const size_t radiances = settings.bounce.count != 0 ? 2 : 1;
    Shading shading;
    check(bytes_of([&] { return shade(scene, &caster, surfaces, settings.light, settings.shade); }),
          of(predicted, "radiance") / radiances + of(predicted, "visibility"));
    shading = shade(scene, &caster, surfaces, settings.light, settings.shade);
    if (settings.shade.shadow == VoxelShadow::volume)
      check(settings.shade.shadow_hit ? bytes_of([&] { return ShadowVolume(surfaces); })
                                      : bytes_of([&] { return make_opacity_medium(surfaces); }),
            of(predicted, "shadow"));
    if (settings.render.pixel.shadow == PixelShadow::visibility)
      check(bytes_of([&] { return LightVisibility(surfaces, shading.visibility); }), of(predicted, "light_visibility"));
    with_texel(settings.storage, [&]<class Texel>(std::type_identity<Texel>) {
      const auto filter = [&] { return mipmap<Texel>(surfaces, shading.radiance, settings.mipmap); };
      check(bytes_of(filter), of(predicted, "base") + of(predicted, "levels"));
      const BasicPyramid<Texel> pyramid = filter();
      check(bytes_of([&] { return Occupancy(pyramid); }), of(predicted, "occupancy"));
      if (of(predicted, "depths") != 0)
        check(bytes_of([&] { return optical_depths(pyramid); }), of(predicted, "depths"));
    });
  }
}

TEST_CASE("Depths and shadows' volumes are there only while something needs them", "[volume_bytes]") {
  const Scene scene = cornell_box(CornellLight::point);
  const auto predicted = [&](const Setup& setup) {
    const Settings settings = setup.settings(64);
    return predict_bytes(voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize), settings);
  };
  CHECK(of(predicted({"villegas2016", {}}), "depths") == 0);
  CHECK(of(predicted({"villegas2016", {"bounce.cones=9"}}), "depths") > 0);
  CHECK(of(predicted({"villegas2016", {"bounce.cones=9", "bounce.count=0"}}), "depths") == 0);
  CHECK(of(predicted({"villegas2016", {"bounce.cones=9", "mipmap.filter=isotropic"}}), "depths") == 0);
  CHECK(of(predicted({"radiometric", {"bounce.count=0"}}), "depths") > 0);
  CHECK(of(predicted({"radiometric", {}}), "shadow") == 0);
  CHECK(of(predicted({"radiometric", {}}), "light_visibility") == 0);
  CHECK(of(predicted({"radiometric", {"bounce.count=0"}}), "radiance") * 2 ==
        of(predicted({"radiometric", {}}), "radiance"));
}
