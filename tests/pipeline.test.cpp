#include "pipeline.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <tuple>

#include "catch.h"
#include "make_scenes/builders.h"
#include "reference/path.h"
#include "temporary_folder.h"
#include "voxel/volume_file.h"

using namespace voxref;

namespace {

Settings at(int resolution) {
  Settings settings = profile("radiometric");
  settings.grid.resolution = resolution;
  return settings;
}

View view_of(const Scene& scene, int size) {
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = size;
  return view;
}

double mean_luminance(const Image& image, std::string_view layer) {
  const auto planes = image.layer(layer);
  double sum = 0.0;
  for (size_t i = 0; i < image.pixel_count(); ++i) sum += luminance({planes[0][i], planes[1][i], planes[2][i]});
  return sum / double(image.pixel_count());
}

}  // namespace

TEST_CASE("The pipeline says what it did, how long it took and what it held", "[pipeline]") {
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  const ConeTraceResult result = cone_trace(scene, caster, view_of(scene, 32), at(32));
  CHECK(std::max({result.grid.size.x, result.grid.size.y, result.grid.size.z}) == 32);
  CHECK(result.voxels_occupied > 1000);
  CHECK(result.bounces >= 3);
  CHECK(result.gain > 0.3);
  CHECK(result.gain < 0.8);
  const StageSeconds& s = result.seconds;
  for (const double seconds : {s.voxelize, s.shade, s.mipmap, s.bounce, s.prepare, s.cone_trace}) CHECK(seconds > 0.0);
  CHECK(s.voxelize + s.shade + s.mipmap + s.bounce + s.prepare + s.cone_trace <= s.total);
  size_t sum = 0;
  for (const auto& [volume, bytes] : result.bytes)
    if (volume != "total" && volume != "visibility") sum += bytes;  // which bounces do not need
  CHECK(result.bytes.at("total") == sum);
  CHECK(result.bytes.at("base") >= result.voxels_occupied * sizeof(glm::vec4));
  CHECK(double(result.mean.r) > 0.0);
}

TEST_CASE("Volumes written hold the pyramid before and after the bounces", "[pipeline]") {
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  const TemporaryFolder folder;
  ConeTraceOutputs outputs;
  outputs.volumes = folder.path / "volumes";
  const ConeTraceResult with = cone_trace(scene, caster, view_of(scene, 16), at(16), outputs);
  const VolumeFolder volumes(*outputs.volumes);
  for (const char* name : {"albedo", "normal", "radiance", "radiance_bounce", "aniso_neg_x_0", "aniso_bounce_pos_z_3"})
    CHECK(volumes.has(name));
  const SurfaceGrid surfaces = volumes.surfaces();
  CHECK(surfaces.size() == with.voxels_occupied);
  double before = 0.0, after = 0.0;
  for (const glm::vec3& r : volumes.radiance(surfaces, false)) before += luminance(r);
  for (const glm::vec3& r : volumes.radiance(surfaces, true)) after += luminance(r);
  CHECK(after > 1.2 * before);  // the mean albedo is about 1/2

  // Rendered again from the files: the same image as from memory.
  const LitVolume volume = make_medium(volumes.pyramid(true));
  const ConeImage again =
      render_cones({scene, caster, volume, scene.bounds(), {}}, view_of(scene, 16), RenderOptions{});
  for (const char* channel : {"R", "diffuse.G", "direct.B"})
    for (size_t i = 0; i < again.image.pixel_count(); ++i)
      CHECK(again.image.channel(channel)[i] == Approx(with.image.image.channel(channel)[i]).epsilon(1e-5).margin(1e-7));
}

TEST_CASE("Every storage makes nearly the same image, and writes and reads its own volumes", "[pipeline]") {
  Scene scene = cornell_box(CornellLight::point);
  scene.lights[0].intensity *= 0.1f;  // so that bytes can hold it
  const Caster caster(scene);
  const ConeTraceResult floats = cone_trace(scene, caster, view_of(scene, 16), at(32));
  for (const auto& [storage, name, bound] :
       {std::tuple(Storage::float16, "float16", 0.002), {Storage::unorm8, "unorm8", 0.05}}) {
    const TemporaryFolder folder;
    Settings settings = at(32);
    settings.storage = storage;
    const ConeTraceResult result = cone_trace(scene, caster, view_of(scene, 16), settings, {folder.path});
    CAPTURE(name);
    // Half floats have eleven bits; of the steps of bytes the mean indirect light is some five.
    CHECK(mean_luminance(result.image.image, "diffuse") ==
          Approx(mean_luminance(floats.image.image, "diffuse")).epsilon(bound));
    CHECK(result.clamped_shade.voxels == 0);
    CHECK(read_volume_index(folder.path).format == name);
    CHECK(read_volume_index(folder.path).find("aniso_bounce_neg_x_0")->premultiplied);
    const LitVolume volume = with_texel(storage, [&]<class Texel>(std::type_identity<Texel>) -> LitVolume {
      return make_medium(VolumeFolder(folder.path).pyramid<Texel>(true));
    });
    const ConeImage again =
        render_cones({scene, caster, volume, scene.bounds(), {}}, view_of(scene, 16), RenderOptions{});
    size_t different = 0;
    for (size_t i = 0; i < again.image.pixel_count(); ++i)
      different += again.image.channel("R")[i] != result.image.image.channel("R")[i];
    CHECK(different == 0);
  }
}

TEST_CASE("Shadows from the visibility volume are those of the volume as it is stored", "[pipeline]") {
  Scene scene = cornell_box(CornellLight::point);
  scene.lights[0].intensity *= 0.1f;
  const Caster caster(scene);
  for (const Storage storage : {Storage::float32, Storage::float16, Storage::unorm8}) {
    CAPTURE(storage_names[size_t(storage)]);
    const TemporaryFolder folder;
    Settings settings = at(32);
    settings.storage = storage;
    settings.shade.shadow = VoxelShadow::volume;  // which lets a share of the light through
    settings.render.pixel.shadow = PixelShadow::visibility;
    const Image image = cone_trace(scene, caster, view_of(scene, 16), settings, {folder.path}).image.image;
    const VolumeFolder volumes(folder.path);
    const SurfaceGrid surfaces = volumes.surfaces();
    const std::vector<float> shares = volumes.visibility(surfaces);
    CHECK(std::ranges::any_of(shares, [](float share) { return share > 0.01f && share < 0.99f; }));
    const LightVisibility visibility(surfaces, shares);
    const LitVolume volume = with_texel(storage, [&]<class Texel>(std::type_identity<Texel>) -> LitVolume {
      return make_medium(volumes.pyramid<Texel>(true));
    });
    const ConeImage again =
        render_cones({scene, caster, volume, scene.bounds(), {}, &visibility}, view_of(scene, 16), settings.render);
    size_t different = 0;
    for (const char* channel : {"R", "direct.G"})
      for (size_t i = 0; i < image.pixel_count(); ++i)
        different += again.image.channel(channel)[i] != image.channel(channel)[i];
    CHECK(different == 0);
  }
}

TEST_CASE("Voxels whose light is not finite are counted and placed, and do not bounce", "[pipeline]") {
  Scene scene = cornell_box(CornellLight::point);
  scene.lights[0].intensity = glm::vec3(1e37f);  // overflows within 0.17 m of the light
  const Caster caster(scene);
  Settings settings = at(16);
  settings.bounce.count = 0;
  const NonfiniteVoxels found = cone_trace(scene, caster, view_of(scene, 4), settings).nonfinite_voxels;
  CHECK(found.count > 0);
  CHECK(found.first.y > 8);  // close under the ceiling, where the light is
  settings.bounce.count.reset();
  CHECK_THROWS_AS(cone_trace(scene, caster, view_of(scene, 4), settings), Error);
}

TEST_CASE("Radiance that a storage cannot hold is clamped and counted", "[pipeline]") {
  Scene scene = cornell_box(CornellLight::point);
  scene.lights[0].intensity *= 1e6f;
  const Caster caster(scene);
  Settings settings = at(16);
  CHECK(cone_trace(scene, caster, view_of(scene, 4), settings).clamped_shade.voxels == 0);
  for (const Storage storage : {Storage::float16, Storage::unorm8}) {
    settings.storage = storage;
    const ConeTraceResult result = cone_trace(scene, caster, view_of(scene, 4), settings);
    CHECK(result.clamped_shade.voxels > 0);
    CHECK(result.clamped_shade.brightest > 65504.0f);
    CHECK(result.clamped_bounce.voxels > result.clamped_shade.voxels / 2);
    CHECK(result.image.nonfinite == 0);
  }
}

TEST_CASE("Without bounces there is no bounced volume", "[pipeline]") {
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  const TemporaryFolder folder;
  Settings settings = at(16);
  settings.bounce.count = 0;
  const ConeTraceResult result = cone_trace(scene, caster, view_of(scene, 8), settings, {folder.path});
  CHECK(result.bounces == 0);
  CHECK(result.seconds.bounce == 0.0);
  CHECK_FALSE(VolumeFolder(folder.path).has("radiance_bounce"));
}

TEST_CASE("Twice the light gives twice the image, to the bit", "[pipeline]") {
  Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  const Image once = cone_trace(scene, caster, view_of(scene, 16), at(24)).image.image;
  scene.lights[0].intensity *= 2.0f;
  const Image twice = cone_trace(scene, caster, view_of(scene, 16), at(24)).image.image;
  size_t different = 0;
  for (const char* channel : {"R", "G", "B", "diffuse.R", "direct.R"})
    for (size_t i = 0; i < once.pixel_count(); ++i)
      different += twice.channel(channel)[i] != 2.0f * once.channel(channel)[i];
  CHECK(different == 0);
}

TEST_CASE("Indirect light on the Cornell box with a point light agrees with the path tracer's in the mean",
          "[pipeline]") {
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  const View view = view_of(scene, 48);
  const Image cones = cone_trace(scene, caster, view, at(128)).image.image;
  PathOptions options;
  options.spp = 64;
  const Image paths = path_trace(scene, caster, view, options).image;
  const double ratio =
      (mean_luminance(cones, "diffuse") + mean_luminance(cones, "specular")) / mean_luminance(paths, "indirect");
  // Six cones at 128 voxels gather about a sixth too much: coarse texels make surfaces look half a texel thicker.
  CHECK(ratio > 0.8);
  CHECK(ratio < 1.25);
}

TEST_CASE("Closed rooms with oblique walls lose no more light than measured", "[pipeline]") {
  // Radiance is 1 / (1 - 0.5) = 2 times the emission (furnace), 0.5 / pi times 2 W/m^2 (sphere). Measured: 0.990 of the
  // truth in the aligned cube, 0.989 in the turned one, 0.986 in the sphere, of which automatic bounces leave out
  // 0.008. Without the joint opacity of texels behind each other (optical_depths) the last two were 0.92 and 0.89.
  const auto share = [](const Scene& scene, double truth) {
    const Caster caster(scene);
    return mean_luminance(cone_trace(scene, caster, view_of(scene, 16), at(64)).image.image, "") / truth;
  };
  Scene turned = furnace(0.5f);
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.6f, glm::normalize(glm::vec3(1.0f, 2.0f, 3.0f))));
  for (glm::vec3& position : turned.positions) position = turn * position;
  for (glm::vec3& normal : turned.normals) normal = turn * normal;
  CHECK(share(furnace(0.5f), 2.0) > 0.98);
  CHECK(share(turned, 2.0) > 0.98);
  CHECK(share(sphere_furnace(0.5f, 4), 1.0 / std::numbers::pi) > 0.98);
}
