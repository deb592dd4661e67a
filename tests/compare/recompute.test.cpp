#include "recompute.h"

#include <nlohmann/json.hpp>

#include "catch.h"
#include "compare/volume_folder.h"
#include "scene/gltf.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;
using testing::tamper;

FolderDifference recomputed(const fs::path& volumes, const Scene& scene, const Settings& settings) {
  const TemporaryFolder work;
  return recompute(volumes, scene, settings, glm::vec3(0.0f), {}, work.path);
}

}  // namespace

TEST_CASE("What follows from an error is not counted against the stages after it", "[diff]") {
  const TemporaryFolder folder;
  const fs::path original = folder.path / "original", a = folder.path / "a";
  testing::write_published_volumes(original);
  const Scene scene = testing::small_published_scene();
  const Settings settings = testing::small_published_settings();
  CHECK(recomputed(original, scene, settings).verdict == Verdict::same);

  // One byte of each volume in turn: the stage that made it is told, with the voxel, whatever comes of it later.
  for (const char* volume : {"normal", "radiance", "visibility", "aniso_pos_x_0", "aniso_neg_y_2", "radiance_bounce",
                             "aniso_bounce_pos_z_1"}) {
    INFO(volume);
    fs::remove_all(a);
    fs::copy(original, a);
    const testing::Tampered place = tamper(a, volume, 40);
    const FolderDifference found = recomputed(a, scene, settings);
    const VolumeDifference* first = found.first_divergence();
    REQUIRE(first);
    CHECK(first->entry.name == volume);
    REQUIRE(first->values.first);
    CHECK(first->values.first->at == place.voxel);
    CHECK(first->values.first->channel == place.channel);
  }
}

TEST_CASE("Averages of fragments are accepted in the order of any GPU, and nothing beyond", "[diff]") {
  const TemporaryFolder folder;
  const fs::path a = folder.path / "a";
  testing::write_published_volumes(a);
  const Scene scene = testing::small_published_scene();
  const Settings settings = testing::small_published_settings();
  const Grid grid = read_volume_index(a).grid;
  // A voxel whose albedo another order would make different, set to that value.
  const auto envelopes = raster_envelopes(scene, grid, settings.voxelize.static_wins);
  const auto wide = std::ranges::find_if(
      envelopes, [](const VoxelEnvelope& e) { return e.albedo[0].least < e.albedo[0].greatest && e.albedo[0].exact; });
  REQUIRE(wide != envelopes.end());
  const auto set_red = [&](int value) {
    const fs::path file = a / "albedo.npy";
    std::string bytes = read_file(file);
    const size_t values = grid.voxel_count() * 4;
    const glm::ivec3 v = wide->voxel;
    const size_t index = 4 * (size_t(v.x) + size_t(grid.size.x) * (size_t(v.y) + size_t(grid.size.y) * size_t(v.z)));
    bytes[bytes.size() - values + index] = char(uint8_t(value));
    write_text(file, bytes);
  };
  const auto albedo_of = [&] {
    const FolderDifference found = recomputed(a, scene, settings);
    return *std::ranges::find_if(found.volumes, [](const VolumeDifference& v) { return v.entry.name == "albedo"; });
  };
  // Which of both ends the file holds is not told; the other one differs.
  set_red(wide->albedo[0].least);
  const VolumeDifference least = albedo_of();
  set_red(wide->albedo[0].greatest);
  const VolumeDifference greatest = albedo_of();
  CHECK(least.within_envelope + greatest.within_envelope >= 1);
  CHECK(!least.differs({}));
  CHECK(!greatest.differs({}));
  set_red(wide->albedo[0].greatest + 1);
  CHECK(albedo_of().differs({}));
}

TEST_CASE("The published shaders' volumes hold against voxref, stage by stage", "[diff][parity]") {
  for (const char* name : {"cornell_64", "glossy_64"}) {
    const auto volumes = shared_file(std::string("gpu/") + name + "/volumes");
    if (!volumes) VOXREF_SKIP("shared/gpu is absent");
    const fs::path folder = volumes->parent_path();
    Settings settings;
    apply_json(settings, nlohmann::json::parse(read_file((folder / "settings.json").string())));
    const FolderDifference found = recomputed(*volumes, load_gltf(folder / "scene.glb"), settings);
    CHECK(found.volumes.size() > 70);
    INFO(to_json(found)["first_divergence"].dump());
    CHECK(found.verdict == Verdict::same);
  }
}

}  // namespace voxref
