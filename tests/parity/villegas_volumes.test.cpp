// The villegas2016 profile against the volumes that the published shaders made (shared/gpu): each stage on the GPU's
// own previous volume, then all of them from the scene file.
#include "catch.h"
#include "cone/bounce.h"
#include "gpu_volumes.h"
#include "pipeline.h"
#include "temporary_folder.h"
#include "voxel/volume_writer.h"

using namespace voxref;

namespace {

/// Runs `test` on both configurations; says so where they are absent.
template <class Test>
void for_each_case(Test&& test) {
  for (const char* name : {"cornell_64", "glossy_64"}) {
    const auto folder = shared_file(std::filesystem::path("gpu") / name);
    if (!folder) VOXREF_SKIP(std::string("shared/gpu/") + name + " is absent");
    CAPTURE(name);
    test(GpuCase(*folder));
  }
}

void check_volumes(const GpuCase& gpu, const std::filesystem::path& folder) {
  const VolumeFolder ours(folder);
  for (const VolumeEntry& volume : ours.entries()) {
    const std::string file = volume.name + ".npy";
    const TexelDifferences d = difference(folder / file, gpu.folder / "volumes" / file);
    CAPTURE(volume.name, d.first, d.largest);
    CHECK(d.texels == 0);
  }
}

}  // namespace

TEST_CASE("Raster voxelization is that of the published shaders, byte for byte", "[parity][voxelize]") {
  for_each_case([](const GpuCase& gpu) {
    const TemporaryFolder folder;
    VolumeFolderWriter writer(folder.path, gpu.grid(), Storage::unorm8);
    writer.write_surfaces(voxelize(gpu.scene, gpu.grid(), gpu.settings.voxelize));
    writer.finish();
    check_volumes(gpu, folder.path);
  });
}

TEST_CASE("Shading the published shaders' voxels gives their radiance and visibility", "[parity][shade]") {
  for_each_case([](const GpuCase& gpu) {
    const SurfaceGrid surfaces = gpu.volumes.surfaces();
    const Shading shading = shade(gpu.scene, nullptr, surfaces, gpu.settings.light, gpu.settings.shade);
    const TemporaryFolder folder;
    VolumeFolderWriter writer(folder.path, surfaces.grid, Storage::unorm8);
    writer.write_visibility(surfaces, shading.visibility);
    writer.write_radiance(surfaces, shading.radiance, false);
    writer.finish();
    check_volumes(gpu, folder.path);
  });
}

TEST_CASE("Filtering the published shaders' radiance gives their directional volumes", "[parity][mipmap]") {
  for_each_case([](const GpuCase& gpu) {
    const TemporaryFolder folder;
    VolumeFolderWriter writer(folder.path, gpu.grid(), Storage::unorm8);
    for (const bool bounced : {false, true})
      writer.write_levels(mipmap(gpu.grid(), gpu.volumes.base<Rgba8>(bounced), gpu.settings.mipmap), bounced);
    writer.finish();
    check_volumes(gpu, folder.path);
  });
}

TEST_CASE("The bounce from the published shaders' volumes is theirs but for rounding", "[parity][bounce]") {
  for_each_case([](const GpuCase& gpu) {
    const Settings& settings = gpu.settings;
    const SurfaceGrid surfaces = gpu.volumes.surfaces();
    const std::vector<glm::vec3> direct = gpu.volumes.radiance(surfaces, false);
    const auto bounced = bounce(surfaces, direct, gpu.volumes.pyramid<Rgba8>(false), settings.bounce,
                                settings.render.cone, settings.mipmap, glm::vec3(0.0f));
    const TemporaryFolder folder;
    VolumeFolderWriter writer(folder.path, surfaces.grid, Storage::unorm8);
    writer.write_radiance(surfaces, bounced.radiance, true);
    writer.finish();
    const TexelDifferences d =
        difference(folder.path / "radiance_bounce.npy", gpu.folder / "volumes" / "radiance_bounce.npy");
    CAPTURE(d.first);
    // The sum of the cones is not rounded in the same order; a value half-way between two bytes may go either way.
    CHECK(d.texels <= 2);
    CHECK(d.largest <= 1);
  });
}

TEST_CASE("The whole chain from the scene file gives the published shaders' volumes", "[parity][pipeline]") {
  for_each_case([](const GpuCase& gpu) {
    const TemporaryFolder folder;
    View view;
    view.camera = gpu.scene.cameras.at(0);
    view.width = view.height = 4;
    ConeTraceOutputs outputs;
    outputs.volumes = folder.path / "volumes";
    cone_trace(gpu.scene, Caster(gpu.scene), view, gpu.settings, outputs);
    check_volumes(gpu, *outputs.volumes);
    // All of them, described alike.
    const VolumeFolder ours(*outputs.volumes);
    CHECK(ours.entries().size() == gpu.volumes.entries().size());
    for (const VolumeEntry& theirs : gpu.volumes.entries()) {
      CAPTURE(theirs.name);
      REQUIRE(ours.has(theirs.name));
      const VolumeEntry& entry = *std::ranges::find(ours.entries(), theirs.name, &VolumeEntry::name);
      CHECK(entry.shape == theirs.shape);
      CHECK(entry.stage == theirs.stage);
      CHECK(entry.face == theirs.face);
      CHECK(entry.level == theirs.level);
      CHECK(entry.premultiplied == theirs.premultiplied);
      CHECK(entry.encoding == theirs.encoding);
    }
  });
}
