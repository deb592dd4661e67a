#include "voxel/voxelize_raster.h"

#include <glm/geometric.hpp>

#include "catch.h"
#include "parallel.h"
#include "settings.h"
#include "voxel/mesh_scene.h"

using namespace voxref;

namespace {

const Grid grid = unit_grid(glm::ivec3(16));
const VoxelizeOptions raster = profile("villegas2016").voxelize;

/// A square in the plane z, from (low, low) to (high, high), front towards +z.
Mesh wall(float z, float low, float high) {
  return quad({low, low, z}, {high, low, z}, {high, high, z}, {low, high, z});
}

/// Index of a voxel; the count of voxels where it is not occupied.
size_t find(const SurfaceGrid& surfaces, const glm::ivec3& voxel) {
  return size_t(std::find(surfaces.voxels.begin(), surfaces.voxels.end(), voxel) - surfaces.voxels.begin());
}

/// A texture of one texel and texture coordinates for all vertices.
void add_texture(Scene& scene, const std::array<uint8_t, 4>& texel, bool srgb) {
  TextureImage image;
  image.width = image.height = 1;
  image.texels8.assign(texel.begin(), texel.end());
  scene.images.push_back(image);
  scene.uv[0].assign(scene.positions.size(), glm::vec2(0.5f));
  for (Material& material : scene.materials) {
    material.base_color_texture.image = 0;
    material.base_color_texture.srgb = srgb;
  }
}

bool same(const SurfaceGrid& a, const SurfaceGrid& b) {
  return a.voxels == b.voxels && a.fragments == b.fragments && a.dynamic == b.dynamic && a.albedo == b.albedo &&
         a.normal == b.normal && a.emission == b.emission;
}

}  // namespace

TEST_CASE("A voxel holds bytes of base colour and of the normal from 0 to 1, and counts its fragments",
          "[voxelize_raster]") {
  const Scene scene = scene_of(wall(5.5f, 2.25f, 9.75f), lambertian("paint", {0.5f, 0.25f, 1.0f}));
  const SurfaceGrid surfaces = voxelize(scene, grid, raster);
  CHECK(surfaces.size() == 64);
  CHECK(surfaces.emission.empty());
  const float byte = 1.0f / 255.0f;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    CHECK(surfaces.voxels[i].z == 5);
    CHECK(surfaces.albedo[i] == glm::vec4(127 * byte, 63 * byte, 1.0f, 1.0f));  // 127.5, 63.75 rounded down
    CHECK(surfaces.normal[i] == 2.0f * glm::vec3(127 * byte, 127 * byte, 1.0f) - 1.0f);
    CHECK(surfaces.centroid[i] == grid.center(surfaces.voxels[i]));
  }
  // The two triangles share the pixels of the diagonal.
  CHECK(surfaces.fragments[find(surfaces, {2, 2, 5})] == 2);
  CHECK(surfaces.fragments[find(surfaces, {8, 3, 5})] == 1);
}

TEST_CASE("The base colour's texture is looked up without decoding sRGB, and emission takes its texel",
          "[voxelize_raster]") {
  for (const bool srgb : {false, true}) {
    Scene scene = scene_of(wall(5.5f, 2.25f, 9.75f), emitter("lamp", glm::vec3(1.0f), {1.0f, 0.5f, 0.0f}));
    add_texture(scene, {128, 64, 32, 255}, srgb);
    const SurfaceGrid surfaces = voxelize(scene, grid, raster);
    REQUIRE(surfaces.size() == 64);
    const float byte = 1.0f / 255.0f;
    CHECK(surfaces.albedo[0] == glm::vec4(128 * byte, 64 * byte, 32 * byte, 1.0f));
    CHECK(surfaces.emission[0] == glm::vec3(128 * byte, 32 * byte, 0.0f));
  }
}

TEST_CASE("Vertex colours multiply base colour and alpha, and not emission", "[voxelize_raster]") {
  Scene scene = scene_of(wall(5.5f, 2.25f, 9.75f), emitter("lamp", glm::vec3(0.5f, 1.0f, 1.0f), {1.0f, 0.5f, 0.0f}));
  scene.colors = {{0, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};  // red grows along x, blue falls along y
  VoxelizeOptions plain = raster;
  plain.average = VoxelAverage::area;
  const SurfaceGrid surfaces = voxelize(scene, grid, plain);
  REQUIRE(surfaces.size() == 64);
  // Half a pixel on each side, and the diagonal by half a pixel along both axes: the lower triangle's corners, which
  // keep their colours, lie at (0.75, 1.75), (10.25, 1.75) and (10.25, 11.25), the upper one's are mirrored.
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const glm::ivec3& voxel = surfaces.voxels[i];
    CHECK(surfaces.emission[i] == glm::vec3(1.0f, 0.5f, 0.0f));
    CHECK(surfaces.albedo[i].g == 1.0f);
    if (std::abs(voxel.x - voxel.y) < 2) continue;  // both triangles
    CAPTURE(voxel.x, voxel.y);
    const bool lower = voxel.x > voxel.y;
    const double x = voxel.x + 0.5 - (lower ? 0.75 : 1.75), y = voxel.y + 0.5 - (lower ? 1.75 : 0.75);
    CHECK(surfaces.albedo[i].r == Approx(0.5 * x / 9.5));
    CHECK(surfaces.albedo[i].b == Approx(1.0 - y / 9.5));
  }
  for (glm::vec4& color : scene.colors) color = {1.0f, 1.0f, 1.0f, 0.5f};
  CHECK(voxelize(scene, grid, plain).albedo[0] == glm::vec4(0.25f, 0.5f, 0.5f, 1.0f));
  for (glm::vec4& color : scene.colors) color.a = 0.0f;
  CHECK(voxelize(scene, grid, plain).size() == 0);
}

TEST_CASE("Turned the other way round, a triangle keeps its vertices' colours", "[voxelize_raster]") {
  VoxelizeOptions plain = raster;
  plain.average = VoxelAverage::area;
  Scene front = scene_of(wall(5.5f, 2.25f, 9.75f)), back = front;
  front.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
  back.colors = front.colors;
  for (glm::uvec3& triangle : back.triangles) std::swap(triangle.y, triangle.z);
  const SurfaceGrid a = voxelize(front, grid, plain), b = voxelize(back, grid, plain);
  REQUIRE(a.voxels == b.voxels);
  for (size_t i = 0; i < a.size(); ++i) CHECK(glm::distance(a.albedo[i], b.albedo[i]) < 1e-5f);  // rounding
}

TEST_CASE("Normals that cancel leave a voxel without one, in either average", "[voxelize_raster]") {
  Scene scene = scene_of(wall(5.5f, 2.25f, 9.75f));
  scene.normals.assign(scene.normals.size(), glm::vec3(0.0f));
  VoxelizeOptions plain = raster;
  plain.average = VoxelAverage::area;
  const SurfaceGrid mean = voxelize(scene, grid, plain), bytes = voxelize(scene, grid, raster);
  REQUIRE(mean.size() == 64);
  const float byte = 1.0f / 255.0f;
  for (const glm::vec3& normal : mean.normal) CHECK(normal == glm::vec3(0.0f));
  for (const glm::vec3& normal : bytes.normal) CHECK(normal == glm::vec3(2.0f * (127 * byte) - 1.0f));
}

TEST_CASE("Positions are multiplied by 1 / G: a wall on the grid's far side may stay inside", "[voxelize_raster]") {
  // 47 x (1 / 47 in float32) is below 1; 47 / 47 would be outside.
  Grid far = grid;
  far.voxel = 47.0f / 16.0f;
  const SurfaceGrid surfaces = voxelize(scene_of(wall(47.0f, 8.0f, 39.0f)), far, raster);
  CHECK(find(surfaces, {8, 8, 15}) < surfaces.size());
}

TEST_CASE("Alpha multiplies the colour and makes no hole unless it is 0", "[voxelize_raster]") {
  Scene scene = scene_of(wall(5.5f, 2.25f, 9.75f), lambertian("paint", glm::vec3(1.0f)));
  add_texture(scene, {255, 255, 255, 51}, false);
  scene.materials[0].alpha_mode = AlphaMode::mask;  // which the published shaders know nothing of
  SurfaceGrid surfaces = voxelize(scene, grid, raster);
  REQUIRE(surfaces.size() == 64);
  CHECK(surfaces.albedo[0].r == 51 * (1.0f / 255.0f));
  CHECK(surfaces.albedo[0].a == 1.0f);
  scene.images[0].texels8[3] = 0;
  CHECK(voxelize(scene, grid, raster).size() == 0);
}

TEST_CASE("Emission above 1 wraps", "[voxelize_raster]") {
  const Scene scene = scene_of(wall(5.5f, 2.25f, 9.75f), emitter("lamp", glm::vec3(0.5f), {2.0f, 1.0f, 0.2f}));
  const SurfaceGrid surfaces = voxelize(scene, grid, raster);
  const size_t once = find(surfaces, {8, 3, 5});
  CHECK(surfaces.emission[once] == glm::vec3(254 * (1.0f / 255.0f), 1.0f, 51 * (1.0f / 255.0f)));
}

TEST_CASE("A voxel that got 256 fragments keeps its bytes and reads as empty", "[voxelize_raster]") {
  Mesh mesh;
  for (int i = 0; i < 256; ++i)
    append(mesh, Mesh{{{6.1f, 6.1f, 3.5f}, {6.2f, 6.1f, 3.5f}, {6.1f, 6.2f, 3.5f}},
                      {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                      {{0, 1, 2}}});
  const SurfaceGrid surfaces = voxelize(scene_of(mesh), grid, raster);
  REQUIRE(surfaces.size() == 1);
  CHECK(surfaces.fragments[0] == 0);
  CHECK(surfaces.albedo[0].a == 0.0f);
  CHECK(surfaces.albedo[0].r == 127 * (1.0f / 255.0f));
}

TEST_CASE("Triangles average in draw order", "[voxelize_raster]") {
  // Two walls in one layer of voxels: 0 then 255 gives floor(255 / 2), and so does 255 then 0; a third tells.
  const auto stacked = [](const std::vector<float>& greys) {
    Scene scene;
    for (const float grey : greys)
      add_object(scene, "wall", wall(5.5f, 2.25f, 9.75f), add_material(scene, lambertian("", glm::vec3(grey))));
    const SurfaceGrid surfaces = voxelize(scene, grid, raster);
    return surfaces.albedo[find(surfaces, {8, 3, 5})].r * 255.0f;
  };
  CHECK(stacked({0.0f, 0.0f, 1.0f}) == Approx(85));
  CHECK(stacked({1.0f, 0.0f, 0.0f}) == Approx(84));
}

TEST_CASE("Averaged by area, fragments have their plain mean, which does not drift", "[voxelize_raster]") {
  VoxelizeOptions plain = raster;
  plain.average = VoxelAverage::area;
  Scene scene;
  for (int i = 0; i < 64; ++i)
    add_object(scene, "wall", wall(5.5f, 2.25f, 9.75f),
               add_material(scene, emitter("", glm::vec3(float(i % 8) / 10.0f), glm::vec3(2.0f * float(i % 2)))));
  const glm::ivec3 once(8, 3, 5);
  const SurfaceGrid mean = voxelize(scene, grid, plain), bytes = voxelize(scene, grid, raster);
  REQUIRE(mean.voxels == bytes.voxels);
  const size_t i = find(mean, once);
  CHECK(mean.albedo[i].r == Approx(0.35));
  CHECK(mean.emission[i].r == Approx(1.0));
  CHECK(mean.normal[i] == glm::vec3(0, 0, 1));
  CHECK(mean.area[i] == 64.0f);
  CHECK(bytes.albedo[i].r < 0.35 - 10.0 / 255.0);
}

TEST_CASE("Raster voxels have the same bits on one thread and on many", "[voxelize_raster]") {
  Scene scene;
  for (int i = 0; i < 40; ++i) {
    const Mesh turned =
        moved(rotated(box({-3, -2, -4}, {4, 3, 2}), float(17 * i), glm::normalize(glm::vec3(1, i, 2))), {8, 8, 8});
    add_object(scene, "box", turned, add_material(scene, lambertian("", glm::vec3(0.02f * float(i), 0.5f, 0.9f))));
  }
  const SurfaceGrid many = voxelize(scene, grid, raster);
  const ThreadLimit one(1);
  CHECK(same(voxelize(scene, grid, raster), many));
  CHECK(many.size() > 500);
}

TEST_CASE("Dynamic surfaces leave static voxels alone, unless static_wins is off", "[voxelize_raster]") {
  Scene scene = scene_of(wall(5.5f, 2.25f, 9.75f), lambertian("fixed", glm::vec3(0.2f)));
  add_object(scene, "mover", wall(5.5f, 6.25f, 13.75f), add_material(scene, lambertian("mover", glm::vec3(1.0f))));
  scene.objects[1].dynamic = true;
  const glm::ivec3 shared(9, 7, 5), free(12, 7, 5);  // off both diagonals
  const float byte = 1.0f / 255.0f;
  const SurfaceGrid kept = voxelize(scene, grid, raster);
  CHECK(kept.albedo[find(kept, shared)].r == 51 * byte);
  CHECK(kept.albedo[find(kept, free)].r == 1.0f);
  CHECK(kept.dynamic[find(kept, shared)] == 0);
  CHECK(kept.dynamic[find(kept, free)] == 1);

  VoxelizeOptions overwrite = raster;
  overwrite.static_wins = false;
  const SurfaceGrid mixed = voxelize(scene, grid, overwrite);
  CHECK(mixed.albedo[find(mixed, shared)].r == 153 * byte);  // (51 + 255) / 2
  CHECK(mixed.fragments[find(mixed, shared)] == 2);
  CHECK(mixed.albedo[find(mixed, free)].r == 1.0f);
}
