#include "cone/bounce.h"

#include "catch.h"
#include "cone/volumes.h"
#include "error.h"
#include "image/image.h"
#include "parallel.h"

using namespace voxref;

namespace {

BounceResult bounce_box(const SurfaceGrid& surfaces, std::optional<int> count, float emitted = 1.0f) {
  const std::vector<glm::vec3> direct(surfaces.size(), glm::vec3(emitted));
  BounceOptions options;
  options.count = count;
  return bounce(surfaces, direct, options, ConeOptions{}, MipmapOptions{}, glm::vec3(0.0f));
}

double mean(const std::vector<glm::vec3>& radiance) {
  double sum = 0.0;
  for (const glm::vec3& r : radiance) sum += luminance(r);
  return sum / double(radiance.size());
}

const glm::ivec3 box_size(24, 20, 18);

}  // namespace

TEST_CASE("Bounces in a closed uniform enclosure add up to the geometric series", "[bounce]") {
  const float r = 0.5f;
  const SurfaceGrid surfaces = box_surfaces(box_size, r);
  double series = 0.0, power = 1.0;
  for (int count = 0; count <= 5; ++count) {
    series += power;
    power *= r;
    const BounceResult result = bounce_box(surfaces, count);
    CAPTURE(count);
    CHECK(result.bounces == count);
    // Each gather returns at least 0.98 of the truth (gather.test.cpp), and so r is 0.49 at worst.
    CHECK(mean(result.radiance) <= series * (1.0 + 1e-5));
    CHECK(mean(result.radiance) >= (1.0 - std::pow(0.49, count + 1)) / (1.0 - 0.49));
  }
}

TEST_CASE("Automatic bounces stop within 1 % of 1 / (1 - r), and the gain is the albedo", "[bounce]") {
  for (const float r : {0.2f, 0.5f, 0.8f}) {
    const BounceResult result = bounce_box(box_surfaces(box_size, r), std::nullopt);
    CAPTURE(r, result.bounces);
    // The last addition is below 1 % of the total; those left out add r / (1 - r) of it.
    const double truth = 1.0 / (1.0 - r), left_out = 0.01 * truth * r / (1.0 - r);
    CHECK(mean(result.radiance) <= truth * (1.0 + 1e-5));
    CHECK(mean(result.radiance) >= 1.0 / (1.0 - 0.98 * r) - left_out);
    CHECK(result.gain == Approx(r).epsilon(0.02));
    CHECK(result.gain <= r * (1.0 + 1e-4));
    CHECK(result.bounces == int(std::ceil(std::log(0.01 / (1.0 - r)) / std::log(r))));
  }
}

TEST_CASE("Light that does not die down is refused with the gain", "[bounce]") {
  bool refused = false;
  try {
    bounce_box(box_surfaces(box_size, 1.1f), std::nullopt);
  } catch (const Error& error) {
    refused = true;
    CHECK(std::string(error.what()).rfind("bounce.count: ", 0) == 0);
    CHECK(std::string(error.what()).find("1.0") != std::string::npos);
  }
  CHECK(refused);
}

TEST_CASE("Nothing bounces in the dark, and no bounce leaves the direct light as it is", "[bounce]") {
  const SurfaceGrid surfaces = box_surfaces(box_size, 0.5f);
  const BounceResult dark = bounce_box(surfaces, std::nullopt, 0.0f);
  CHECK(dark.bounces == 1);
  CHECK(dark.gain == 0.0);
  CHECK(mean(dark.radiance) == 0.0);
  const BounceResult none = bounce_box(surfaces, 0);
  CHECK(none.bounces == 0);
  CHECK(mean(none.radiance) == 1.0);
  CHECK(none.pyramid.base(glm::ivec3(1, 1, 1)) == glm::vec4(1.0f));

  SurfaceGrid nothing;
  nothing.grid = unit_grid({4, 4, 4});
  const BounceResult empty = bounce(nothing, {}, {}, {}, {}, glm::vec3(1.0f));
  CHECK(empty.radiance.empty());
}

TEST_CASE("Twice the light bounces twice as bright, to the bit, and the pyramid shows the last bounce", "[bounce]") {
  SurfaceGrid surfaces = box_surfaces(box_size, 0.6f);
  for (size_t i = 0; i < surfaces.size(); ++i) surfaces.albedo[i].g = 0.1f + 0.03f * float(surfaces.voxels[i].x % 20);
  const BounceResult once = bounce_box(surfaces, std::nullopt, 0.7f), twice = bounce_box(surfaces, std::nullopt, 1.4f);
  REQUIRE(once.bounces == twice.bounces);
  CHECK(once.gain == twice.gain);
  size_t different = 0;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    different += twice.radiance[i] != 2.0f * once.radiance[i];
    different += glm::vec3(once.pyramid.base(surfaces.voxels[i])) != once.radiance[i];
  }
  CHECK(different == 0);
}

TEST_CASE("One thread and two make the same bounces, to the bit", "[bounce]") {
  const SurfaceGrid surfaces = box_surfaces(box_size, 0.6f);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return bounce_box(surfaces, std::nullopt);
  };
  const BounceResult one = run(1), two = run(2);
  CHECK(one.radiance == two.radiance);
  CHECK(one.gain == two.gain);
}

TEST_CASE("A thin sheet gathers from both sides and takes the mean", "[bounce]") {
  // A horizontal sheet in a box whose upper half is lit: seen from above 1, from below 0.
  const glm::ivec3 size(32, 32, 32);
  SurfaceGrid surfaces = box_surfaces(size, 0.0f);
  std::vector<glm::vec3> direct;
  for (const glm::ivec3& v : surfaces.voxels) direct.emplace_back(v.y > 16 ? 1.0f : 0.0f);
  for (int z = 2; z < size.z - 2; ++z)
    for (int x = 2; x < size.x - 2; ++x) {
      surfaces.voxels.emplace_back(x, 16, z);
      surfaces.albedo.emplace_back(0.8f, 0.8f, 0.8f, 1.0f);
      surfaces.normal.emplace_back(0.0f);
      surfaces.centroid.push_back(surfaces.grid.center({x, 16, z}));
      direct.emplace_back(0.0f);
    }
  BounceOptions options;
  options.count = 1;
  const BounceResult result = bounce(surfaces, direct, options, {}, {}, glm::vec3(0.0f));
  const size_t middle = surfaces.size() - 1 - size_t(28 * 14 + 14);
  CHECK(result.radiance[middle].r ==
        Approx(0.5f * 0.8f).epsilon(0.05));  // six cones at its centre: 0.97 at worst, two gathers
}

TEST_CASE("Progress is one fraction over all bounces that never falls", "[bounce]") {
  const ThreadLimit one(1);  // several report slightly out of order
  const SurfaceGrid surfaces = box_surfaces(box_size, 0.7f);
  const std::vector<glm::vec3> direct(surfaces.size(), glm::vec3(1.0f));
  const Pyramid filtered = mipmap(surfaces, direct, {});
  for (const std::optional<int> count : {std::optional<int>(4), std::optional<int>()}) {
    double last = 0.0, largest_step = 0.0;
    size_t backwards = 0, other_stages = 0;
    Progress progress;
    progress.report = [&](std::string_view stage, double fraction) {
      other_stages += stage != "bounce";
      backwards += fraction < last;
      largest_step = std::max(largest_step, fraction - last);
      last = fraction;
    };
    BounceOptions options;
    options.count = count;
    bounce(surfaces, direct, Pyramid(filtered), options, {}, {}, glm::vec3(0.0f), progress);
    CAPTURE(count.value_or(-1));
    CHECK(other_stages == 0);
    CHECK(backwards == 0);
    CHECK(last == 1.0);
    CHECK(largest_step < 0.2);  // a task of 256 voxels is a tenth of this box, and a first bounce a quarter of all
  }
}

TEST_CASE("A bounce under way can be stopped", "[bounce]") {
  const std::atomic<bool> stop{true};
  Progress progress;
  progress.cancel = &stop;
  const SurfaceGrid surfaces = box_surfaces(box_size, 0.5f);
  const std::vector<glm::vec3> direct(surfaces.size(), glm::vec3(1.0f));
  CHECK_THROWS_AS(bounce(surfaces, direct, {}, {}, {}, glm::vec3(0.0f), progress), Interrupted);
}
