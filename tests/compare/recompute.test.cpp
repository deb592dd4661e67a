#include "recompute.h"

#include <nlohmann/json.hpp>

#include "catch.h"
#include "compare/volume_folder.h"
#include "scene/gltf.h"
#include "voxel/npy.h"

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
  const auto albedo_of = [&](const Settings& with) {
    const FolderDifference found = recomputed(a, scene, with);
    return *std::ranges::find_if(found.volumes, [](const VolumeDifference& v) { return v.entry.name == "albedo"; });
  };
  // Which of both ends the file holds is not told; the other one differs.
  set_red(wide->albedo[0].least);
  const VolumeDifference least = albedo_of(settings);
  set_red(wide->albedo[0].greatest);
  const VolumeDifference greatest = albedo_of(settings);
  CHECK(least.within_envelope + greatest.within_envelope >= 1);
  CHECK(!least.differs({}));
  CHECK(!greatest.differs({}));
  // A mean by area is the same in all orders: what rounds down after each fragment is something else.
  Settings by_area = settings;
  by_area.voxelize.average = VoxelAverage::area;
  CHECK(albedo_of(by_area).differs({}));
  set_red(wide->albedo[0].greatest + 1);
  CHECK(albedo_of(settings).differs({}));
}

namespace {

/// Removes all volumes but those that `keep` takes from a folder's volumes.json.
template <class Keep>
void keep_only(const fs::path& folder, Keep&& keep) {
  auto document = nlohmann::json::parse(read_file(folder / "volumes.json"));
  auto& volumes = document["volumes"];
  for (size_t i = volumes.size(); i-- > 0;)
    if (!keep(volumes[i]["name"].template get<std::string>())) volumes.erase(i);
  write_text(folder / "volumes.json", document.dump());
}

const VolumeDifference* find(const FolderDifference& folder, const std::string& name) {
  const auto found =
      std::ranges::find_if(folder.volumes, [&](const VolumeDifference& v) { return v.entry.name == name; });
  return found == folder.volumes.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("Levels that were filtered from a bounce are judged without what the bounce was made from", "[diff]") {
  const TemporaryFolder folder;
  const fs::path a = folder.path / "a";
  testing::write_published_volumes(a);
  tamper(a, "aniso_bounce_pos_z_1", 40);
  keep_only(a, [](const std::string& name) { return name.find("bounce") != name.npos; });
  const FolderDifference found = recomputed(a, testing::small_published_scene(), testing::small_published_settings());
  REQUIRE(found.first_divergence());
  CHECK(found.first_divergence()->entry.name == "aniso_bounce_pos_z_1");
  REQUIRE(find(found, "radiance_bounce"));
  CHECK(find(found, "radiance_bounce")->missing);  // it is listed, and says what it lacks
  CHECK(find(found, "radiance_bounce")->problem.find("not judged") == 0);
}

TEST_CASE("What a folder lacks is not judged, and does not keep the rest from it", "[diff]") {
  const TemporaryFolder folder;
  const fs::path a = folder.path / "a";
  testing::write_published_volumes(a);
  const Scene scene = testing::small_published_scene();
  const Settings settings = testing::small_published_settings();
  for (const std::string lacking : {"normal", "albedo", "aniso_neg_y_2", "radiance"}) {
    INFO(lacking);
    const fs::path b = folder.path / lacking;
    fs::copy(a, b);
    keep_only(b, [&](const std::string& name) { return name != lacking; });
    const FolderDifference found = recomputed(b, scene, settings);
    CHECK(found.verdict == Verdict::same);
    CHECK(find(found, "radiance_bounce")->missing);
    CHECK(!find(found, "aniso_bounce_pos_x_0")->missing);
  }
}

TEST_CASE("Volumes that voxref does not make are no place for garbage", "[diff]") {
  const TemporaryFolder folder;
  const fs::path a = folder.path / "a";
  const Scene scene = testing::small_published_scene();
  Settings settings = profile("radiometric");
  settings.grid.resolution = 16;
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = 2;
  cone_trace(scene, Caster(scene), view, settings, {a});
  const auto add = [&](const std::string& name, const std::array<size_t, 4>& shape, float value) {
    write_npy(a / (name + ".npy"), ElementType::float32, shape,
              [&](size_t, std::span<float> slice) { std::ranges::fill(slice, value); });
    auto document = nlohmann::json::parse(read_file(a / "volumes.json"));
    document["volumes"].push_back({{"name", name}, {"shape", shape}, {"dtype", "float32"}});
    write_text(a / "volumes.json", document.dump());
  };
  const glm::ivec3 size = read_volume_index(a).grid.size;
  const std::array<size_t, 4> shape = {size_t(size.z), size_t(size.y), size_t(size.x), 3};
  CHECK(!read_volume_index(a).find("emission"));  // no lamp in this box
  add("emission", shape, 0.0f);
  CHECK(recomputed(a, scene, settings).verdict == Verdict::same);
  add("occupancy_of_mine", shape, 7.0f);
  const FolderDifference unknown = recomputed(a, scene, settings);
  CHECK(unknown.verdict == Verdict::same);
  CHECK(find(unknown, "occupancy_of_mine")->missing);
  add("aniso_neg_x_9", {1, 1, 1, 4}, 0.5f);
  CHECK(recomputed(a, scene, settings).first_divergence()->entry.name == "aniso_neg_x_9");
  keep_only(a, [](const std::string& name) { return name != "aniso_neg_x_9" && name != "emission"; });
  add("emission", shape, 0.25f);
  CHECK(recomputed(a, scene, settings).first_divergence()->entry.name == "emission");
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
