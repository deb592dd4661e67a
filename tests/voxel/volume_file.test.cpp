#include "voxel/volume_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "temporary_folder.h"
#include "voxel/array_bytes.h"
#include "voxel/mesh_scene.h"

using namespace voxref;

namespace {

/// A lamp and a grey box in a grid whose sides are no powers of two, with made-up radiance.
struct Example {
  SurfaceGrid surfaces;
  std::vector<glm::vec3> radiance;
  Pyramid pyramid;

  Example() {
    Scene scene = scene_of(box({3.5f, 2.5f, 2.5f}, {9.5f, 7.5f, 12.5f}));
    add_object(scene, "lamp", quad({4, 10, 4}, {8, 10, 4}, {8, 11, 8}, {4, 11, 8}),
               add_material(scene, emitter("lamp", glm::vec3(0.25f), glm::vec3(1, 2, 3))));
    Grid grid = unit_grid({13, 14, 21});
    grid.min = glm::vec3(0.0f, 0.0f, -0.125f);
    surfaces = voxelize(scene, grid, {.opacity = VoxelOpacity::coverage});
    for (size_t i = 0; i < surfaces.size(); ++i) radiance.push_back(glm::vec3(surfaces.voxels[i]) * 0.25f);
    pyramid = mipmap(surfaces, radiance, {});
  }

  void write(const std::filesystem::path& folder) const {
    VolumeFolderWriter writer(folder, surfaces.grid);
    writer.write_surfaces(surfaces);
    writer.write_radiance(surfaces, radiance, false);
    writer.write_levels(pyramid, false);
    writer.write_radiance(surfaces, radiance, true);
    writer.write_levels(pyramid, true);
    writer.finish();
  }
};

/// Replaces `from` by `to` in a folder's volumes.json.
void edit_index(const std::filesystem::path& folder, const std::string& from, const std::string& to) {
  std::string text = read_file(folder / "volumes.json");
  const size_t at = text.find(from);
  REQUIRE(at != text.npos);
  write_text(folder / "volumes.json", text.replace(at, from.size(), to));
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("volumes come back from a folder bit by bit", "[volume_file]") {
  const TemporaryFolder temporary;
  const std::filesystem::path path = temporary.path / "new" / "folder";
  const Example example;
  example.write(path);
  const VolumeFolder folder(path);

  CHECK(folder.grid().size == example.surfaces.grid.size);
  CHECK(folder.grid().min == example.surfaces.grid.min);
  CHECK(folder.grid().voxel == example.surfaces.grid.voxel);
  const SurfaceGrid surfaces = folder.surfaces();
  CHECK(surfaces.voxels == example.surfaces.voxels);
  CHECK(surfaces.albedo == example.surfaces.albedo);
  CHECK(surfaces.normal == example.surfaces.normal);
  CHECK(surfaces.centroid == example.surfaces.centroid);
  CHECK(surfaces.emission == example.surfaces.emission);
  CHECK(surfaces.area.empty());

  const std::vector<glm::vec3> radiance = folder.radiance(surfaces, false);
  for (size_t i = 0; i < radiance.size(); ++i)  // multiplied by opacity and divided by it: two roundings
    REQUIRE(glm::distance(radiance[i], example.radiance[i]) <= 2e-7f * glm::length(example.radiance[i]));
  for (const bool bounced : {false, true}) {
    const Pyramid pyramid = folder.pyramid(bounced);
    CHECK(std::ranges::equal(pyramid.base.texels(), example.pyramid.base.texels()));
    REQUIRE(pyramid.levels.size() == example.pyramid.levels.size());
    for (size_t k = 0; k < pyramid.levels.size(); ++k)
      CHECK(std::ranges::equal(pyramid.levels[k].texels(), example.pyramid.levels[k].texels()));
  }
}

TEST_CASE("volumes.json says what every volume is", "[volume_file]") {
  const TemporaryFolder temporary;
  const Example example;
  example.write(temporary.path);
  const VolumeFolder folder(temporary.path);
  CHECK(folder.entries().size() == 4 + 2 + 2 * 6 * example.pyramid.levels.size());
  const auto entry = [&](const std::string& name) {
    return *std::ranges::find(folder.entries(), name, &VolumeEntry::name);
  };
  CHECK(entry("albedo").shape == std::array<size_t, 4>{21, 14, 13, 4});
  CHECK(entry("albedo").stage == "voxelize");
  CHECK(entry("albedo").alpha == "opacity");
  CHECK(!entry("albedo").premultiplied);
  CHECK(entry("radiance").premultiplied);
  CHECK(entry("radiance_bounce").stage == "bounce");
  CHECK(entry("aniso_pos_y_1").shape == std::array<size_t, 4>{6, 4, 4, 4});
  CHECK(entry("aniso_pos_y_1").face == "pos_y");
  CHECK(entry("aniso_pos_y_1").level == 1);
  CHECK(entry("aniso_bounce_neg_z_0").stage == "mipmap after bounce");
  CHECK(contains(read_file(temporary.path / "volumes.json"), "\"axis_order\": \"zyxc\""));
  for (const VolumeEntry& volume : folder.entries())
    CHECK(std::filesystem::exists(temporary.path / (volume.name + ".npy")));
}

TEST_CASE("a folder that is being written anew has no volumes.json until it is whole", "[volume_file]") {
  const TemporaryFolder temporary;
  const Example example;
  example.write(temporary.path);
  {
    VolumeFolderWriter writer(temporary.path, example.surfaces.grid);
    CHECK(std::filesystem::exists(temporary.path / "volumes.json"));
    writer.write_surfaces(example.surfaces);
  }
  CHECK(!std::filesystem::exists(temporary.path / "volumes.json"));
  CHECK_THROWS_AS(VolumeFolder(temporary.path), Error);
}

TEST_CASE("a folder of volumes that was not finished leaves nothing of its own", "[volume_file]") {
  const TemporaryFolder temporary;
  const Example example;
  const auto start = [&](const std::filesystem::path& folder) {
    VolumeFolderWriter writer(folder, example.surfaces.grid);
    writer.write_surfaces(example.surfaces);
    CHECK(std::filesystem::exists(folder / "albedo.npy"));
  };
  for (const std::string name : {"new/folder", "new/folder/"}) {
    start(temporary.path / name);
    CHECK(std::filesystem::is_empty(temporary.path));
  }
  std::filesystem::create_directories(temporary.path / "other" / "empty");
  write_text(temporary.path / "other" / "notes.txt", "of somebody else");
  start(temporary.path / "other");
  CHECK(read_file(temporary.path / "other" / "notes.txt") == "of somebody else");
  CHECK(!std::filesystem::exists(temporary.path / "other" / "albedo.npy"));
  start(temporary.path / "other" / "empty");
  CHECK(std::filesystem::is_empty(temporary.path / "other" / "empty"));
  example.write(temporary.path / "other" / "empty");
  CHECK(VolumeFolder(temporary.path / "other" / "empty").has("albedo"));
}

TEST_CASE("a folder that cannot be made is refused", "[volume_file]") {
  const TemporaryFolder temporary;
  write_text(temporary.path / "file", "");
  CHECK_THROWS_AS(VolumeFolderWriter(temporary.path / "file" / "folder", unit_grid(glm::ivec3(4))), Error);
}

TEST_CASE("a damaged volumes.json is refused with the place", "[volume_file]") {
  const TemporaryFolder temporary;
  const Example example;
  const auto complaint = [&](const std::string& from, const std::string& to) {
    example.write(temporary.path);
    edit_index(temporary.path, from, to);
    return message_of([&] { VolumeFolder{temporary.path}; });
  };
  const std::string dims = "\"dims\": [\n  13";
  CHECK(contains(complaint("{", "["), "volumes.json: byte"));
  CHECK(contains(complaint("\"dims\"", "\"dim\""), "dims: is missing"));
  CHECK(contains(complaint(dims, "\"dims\": [\n  0"), "dims: 0 is outside"));
  CHECK(contains(complaint(dims, "\"dims\": [\n  -5"), "dims: -5 is outside"));
  CHECK(contains(complaint(dims, "\"dims\": [\n  99999999"), "dims: 99999999 is outside"));
  CHECK(contains(complaint(dims, "\"dims\": [\n  26"), "bounds: do not span"));
  CHECK(contains(complaint(dims, "\"dims\": [\n  \"13\""), "dims: has the wrong type"));
  CHECK(contains(complaint("zyxc", "xyzc"), "axis_order: is not zyxc"));
  CHECK(contains(complaint("float32\",\n   \"name\": \"normal", "float64\",\n   \"name\": \"normal"),
                 "volumes[1].dtype"));
  CHECK(contains(complaint("\"normal\"", "\"albedo\""), "volumes[1].name: is there twice"));
  CHECK(contains(complaint("\"normal\"", "\"../normal\""), "volumes[1].name"));
  CHECK(contains(complaint("\"voxel_size\": 1.0", "\"voxel_size\": -1.0"), "voxel_size"));
}

TEST_CASE("an entry may name its file, a mip level and a texel format", "[volume_file]") {
  const TemporaryFolder temporary;
  std::filesystem::create_directory(temporary.path / "dump");
  const auto complaint = [&](const std::string& members) {
    temporary.write("volumes.json", R"({"dims": [4, 4, 4], "bounds": [[0, 0, 0], [4, 4, 4]], "volumes": [
                                        {"name": "radiance", "shape": [4, 4, 4, 4], )" +
                                        members + "}]}");
    return message_of([&] {
      const BrickVolume<glm::vec4> base = VolumeFolder(temporary.path).base(false);
      CHECK(base({3, 3, 3}) == glm::vec4(0.375f, 0.25f, 0.125f, 0.5f));
    });
  };
  const auto four_floats = [](float r, float g, float b, float a) {
    const std::array<float, 4> texel = {r, g, b, a};
    return std::string(reinterpret_cast<const char*>(texel.data()), sizeof texel);
  };
  std::string wrong, right;
  for (int i = 0; i < 512; ++i) wrong += four_floats(9, 9, 9, 1);
  for (int i = 0; i < 64; ++i) right += four_floats(0.375f, 0.25f, 0.125f, 0.5f);
  // 8x8x8 texels of r32g32b32a32_float and a second level of half of that: a DDS header, then the DX10 extension.
  temporary.write("dump/texture.dds", words({0x20534444, 124, 0, 8, 8, 0, 8, 2}) + std::string(44, '\0') +
                                          words({32, 4, 0x30315844, 0, 0, 0, 0, 0, 0, 0x200000, 0, 0, 0}) +
                                          words({2, 4, 0, 1, 0}) + wrong + right);
  temporary.write("texture.raw", right);
  temporary.write("texture.raw.json", R"({"dims": [4, 4, 4], "format": "r32g32b32a32_float"})");
  const std::string float32 = R"("dtype": "float32", "premultiplied": true, )";
  CHECK(complaint(float32 + R"("file": "dump/texture.dds", "mip": 1)").empty());
  CHECK(complaint(R"("dtype": "r32g32b32a32_float", "premultiplied": true, "file": "texture.raw")").empty());
  CHECK(contains(complaint(float32 + R"("file": "dump/texture.dds")"), "texture.dds: header: shape is not"));
  CHECK(contains(complaint(float32 + R"("file": "dump/texture.dds", "mip": 2)"), "mip 2: is not there"));
  CHECK(contains(complaint(float32 + R"("file": "texture.raw", "mip": 1)"), "mip 1: is not there"));
  CHECK(contains(complaint(R"("dtype": "uint8", "file": "texture.raw")"), "texture.raw: header: type is not"));
  CHECK(contains(complaint(R"("dtype": "r8_unorm", "file": "texture.raw")"), "volumes[0].dtype: has another channel"));
  CHECK(contains(complaint(R"("dtype": "bc7", "file": "texture.raw")"), "volumes[0].dtype: is none of float32"));
  CHECK(contains(complaint(float32 + R"("mip": -1)"), "volumes[0].mip: -1 is below 0"));
  for (const std::string file : {"../a.npy", "dump/../../a.npy", "/a.npy", "dump/", "", "a\\u0000.npy"})
    CHECK(contains(complaint(float32 + "\"file\": \"" + file + "\""), "volumes[0].file: is no file of this folder"));
  CHECK(contains(complaint(float32 + R"("file": "texture.exr")"), "volumes[0].file: is none of .npy, .dds and .raw"));
}

TEST_CASE("volumes that are missing, cut short or of another shape are refused by name", "[volume_file]") {
  const TemporaryFolder temporary;
  const Example example;
  example.write(temporary.path);
  const VolumeFolder folder(temporary.path);
  std::filesystem::resize_file(temporary.path / "normal.npy", 1000);
  CHECK(contains(message_of([&] { folder.surfaces(); }), "normal.npy: "));
  std::filesystem::copy_file(temporary.path / "aniso_pos_x_1.npy", temporary.path / "aniso_pos_x_0.npy",
                             std::filesystem::copy_options::overwrite_existing);
  CHECK(contains(message_of([&] { folder.pyramid(false); }), "aniso_pos_x_0.npy: header: shape"));
  std::filesystem::remove(temporary.path / "radiance.npy");
  CHECK(contains(message_of([&] { folder.base(false); }), "radiance.npy: there is no such file"));

  VolumeFolderWriter writer(temporary.path, example.surfaces.grid);
  writer.write_radiance(example.surfaces, example.radiance, false);
  writer.finish();
  const VolumeFolder partial(temporary.path);
  CHECK(partial.has("radiance"));
  CHECK(!partial.has("albedo"));
  CHECK(contains(message_of([&] { partial.surfaces(); }), "has no volume 'albedo'"));
  CHECK(contains(message_of([&] { partial.pyramid(false); }), "has no volume 'aniso_neg_x_0'"));
}

TEST_CASE("an opacity outside 0 to 1 is refused with its voxel", "[volume_file]") {
  const TemporaryFolder temporary;
  SurfaceGrid surfaces;
  surfaces.grid = unit_grid(glm::ivec3(4));
  surfaces.voxels = {{1, 2, 3}};
  surfaces.albedo = {{0.0f, 0.0f, 0.0f, 1.5f}};
  VolumeFolderWriter writer(temporary.path, surfaces.grid);
  writer.write_radiance(surfaces, std::vector(1, glm::vec3(0.0f)), false);
  writer.finish();
  CHECK(contains(message_of([&] { VolumeFolder(temporary.path).base(false); }), "radiance.npy: [3,2,1]: opacity"));
}

TEST_CASE("a value that is not finite is refused with its place", "[volume_file]") {
  const TemporaryFolder temporary;
  const Example example;
  for (const float bad : {std::nanf(""), INFINITY}) {
    example.write(temporary.path);
    std::fstream file(temporary.path / "radiance.npy", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-4 * 6, std::ios::end);  // the third channel of the last texel but one
    file.write(reinterpret_cast<const char*>(&bad), 4);
    file.close();
    const std::string place = "radiance.npy: [20,13,11,2]: is not finite";
    CHECK(contains(message_of([&] { VolumeFolder(temporary.path).base(false); }), place));
  }
}

TEST_CASE("without a centroid volume voxel centres stand in", "[volume_file]") {
  const TemporaryFolder temporary;
  const Example example;
  example.write(temporary.path);
  edit_index(temporary.path, "\"centroid\"", "\"other\"");
  const SurfaceGrid surfaces = VolumeFolder(temporary.path).surfaces();
  for (size_t i = 0; i < surfaces.size(); ++i)
    REQUIRE(surfaces.centroid[i] == surfaces.grid.center(surfaces.voxels[i]));
}

TEST_CASE("volumes of the published GPU renderer are read as bytes over 255", "[volume_file]") {
  const auto path = shared_file("gpu/cornell_64/volumes");
  if (!path) VOXREF_SKIP("gpu/cornell_64 is not there");
  const VolumeFolder folder(*path);
  CHECK(folder.grid().size == glm::ivec3(64));
  CHECK(folder.grid().min == glm::vec3(-30.0f, -2.5f, -2.0f));
  CHECK(folder.has("visibility"));
  const SurfaceGrid surfaces = folder.surfaces();
  CHECK(surfaces.size() > 1000);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    REQUIRE(surfaces.albedo[i].a == 1.0f);                    // its alpha counts fragments
    REQUIRE(glm::length(surfaces.normal[i]) < 1.0f + 0.02f);  // 8 bits: half a step of 2/255 in each component
  }
  const Pyramid read = folder.pyramid(false);
  REQUIRE(read.levels.size() == 6);
  // The published mipmaps are the anisotropic filter of its own base, but for rounding to bytes.
  const Pyramid filtered = mipmap(folder.grid(), folder.base(false), {});
  float worst = 0.0f;
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        for (size_t face = 0; face < 6; ++face)
          for (int c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(std::as_const(read.levels[0])({x, y, z})[face][c] -
                                             std::as_const(filtered.levels[0])({x, y, z})[face][c]));
  CHECK(worst < 0.5f / 255.0f + 1e-6f);
}
