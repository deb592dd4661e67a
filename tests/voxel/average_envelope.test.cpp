#include "voxel/average_envelope.h"

#include <algorithm>
#include <random>

#include "catch.h"
#include "settings.h"
#include "voxel/mesh_scene.h"
#include "voxel/running_average.h"
#include "voxel/texel.h"
#include "voxel/voxelize.h"

using namespace voxref;

namespace {

uint8_t averaged(const std::vector<float>& values) {
  RunningAverage8 average;
  for (const float v : values) average.add(glm::vec3(v));
  return average.value[0];
}

std::vector<float> random_values(std::mt19937& random, size_t count) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<float> values(count);
  for (float& v : values) v = unit(random);
  return values;
}

/// Whether all three channels of a byte triple lie in their envelopes.
bool inside(const std::array<AverageEnvelope, 3>& envelope, const glm::vec3& value) {
  const Rgba8 bytes = encode<Rgba8>(load(glm::vec4(value, 0.0f)));
  return envelope[0].contains(bytes.bytes[0]) && envelope[1].contains(bytes.bytes[1]) &&
         envelope[2].contains(bytes.bytes[2]);
}

}  // namespace

TEST_CASE("The envelope of few fragments is what trying all orders finds", "[envelope]") {
  std::mt19937 random(11);
  for (size_t count = 1; count <= 7; ++count)
    for (int repeat = 0; repeat < 10; ++repeat) {
      std::vector<float> values = random_values(random, count);
      if (count > 3 && repeat % 2 == 0) values[1] = values[0];  // equal ones share their states
      std::sort(values.begin(), values.end());
      uint8_t least = 255, greatest = 0;
      do {
        const uint8_t value = averaged(values);
        least = std::min(least, value), greatest = std::max(greatest, value);
      } while (std::next_permutation(values.begin(), values.end()));
      const AverageEnvelope envelope = average_envelope(values);
      CHECK(envelope.exact);
      CHECK(int(envelope.least) == int(least));
      CHECK(int(envelope.greatest) == int(greatest));
    }
}

TEST_CASE("Equal fragments leave no choice", "[envelope]") {
  const AverageEnvelope envelope = average_envelope(std::vector<float>(200, 0.4f));
  CHECK(envelope.exact);
  CHECK(envelope.least == 102);
  CHECK(envelope.greatest == 102);
}

TEST_CASE("The bound on many fragments holds for any order, and drift stays inside it", "[envelope]") {
  std::mt19937 random(13);
  for (const size_t count : {20, 64, 200, 255, 300}) {
    std::vector<float> values = random_values(random, count);
    const AverageEnvelope envelope = average_envelope(values);
    CHECK_FALSE(envelope.exact);
    for (int order = 0; order < 50; ++order) {
      CHECK(envelope.contains(averaged(values)));
      std::shuffle(values.begin(), values.end(), random);
    }
    std::sort(values.begin(), values.end());
    CHECK(envelope.contains(averaged(values)));
    std::reverse(values.begin(), values.end());
    CHECK(envelope.contains(averaged(values)));
    if (count == 20) CHECK(envelope.greatest - envelope.least <= 11);  // (n + 1) / 2
  }
}

TEST_CASE("What wraps may be anything", "[envelope]") {
  const AverageEnvelope envelope = average_envelope(std::vector<float>{0.5f, 1.5f});
  CHECK_FALSE(envelope.exact);
  CHECK(envelope.least == 0);
  CHECK(envelope.greatest == 255);
}

TEST_CASE("A voxelization lies in the envelopes of its voxels, whatever the order of its triangles", "[envelope]") {
  const Grid grid = unit_grid(glm::ivec3(16));
  const VoxelizeOptions options = profile("villegas2016").voxelize;
  std::mt19937 random(17);
  Scene scene;
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 color(float(i) / 12.0f, 0.5f, 1.0f - float(i) / 12.0f);
    add_object(scene, "sphere", moved(scaled(icosphere(1), 2.0f + 0.3f * float(i)), {8, 8, 8}),
               add_material(scene, lambertian("", color)));
  }
  scene.objects.back().dynamic = true;
  const std::vector<VoxelEnvelope> envelopes = raster_envelopes(scene, grid, options.static_wins);
  for (int order = 0; order < 3; ++order) {
    const SurfaceGrid surfaces = voxelize(scene, grid, options);
    REQUIRE(surfaces.size() == envelopes.size());
    size_t outside = 0;
    for (size_t i = 0; i < surfaces.size(); ++i) {
      const VoxelEnvelope& e = envelopes[i];
      outside += e.voxel != surfaces.voxels[i] || e.count != surfaces.fragments[i] ||
                 !inside(e.albedo, glm::vec3(surfaces.albedo[i])) ||
                 !inside(e.normal, 0.5f * surfaces.normal[i] + 0.5f);
    }
    CHECK(outside == 0);
    for (Object& object : scene.objects)  // within each object: the ranges stay
      std::shuffle(scene.triangles.begin() + object.first_triangle,
                   scene.triangles.begin() + object.first_triangle + object.triangle_count, random);
  }
}
