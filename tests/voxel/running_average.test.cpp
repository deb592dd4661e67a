#include "voxel/running_average.h"

#include <algorithm>
#include <random>
#include <vector>

#include "catch.h"

using namespace voxref;

namespace {

/// What is left of `values` (0 to 255) after averaging them in this order; one channel.
int averaged(const std::vector<double>& values) {
  RunningAverage8 average;
  for (const double v : values) average.add(glm::vec3(float(v / 255.0)));
  return average.value[0];
}

/// Mean over many voxels of what the running average is off from the true mean of `count` values spread over a range.
double drift(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> spread(92.0, 208.0);  // wide enough for the floor to fall anywhere
  constexpr int voxels = 2000;
  double sum = 0.0;
  for (int v = 0; v < voxels; ++v) {
    std::vector<double> values(static_cast<size_t>(count));
    double mean = 0.0;
    for (double& value : values) mean += (value = spread(random)) / count;
    sum += averaged(values) - mean;
  }
  return sum / voxels;
}

}  // namespace

TEST_CASE("The first fragment is stored rounded down, and counted", "[running_average]") {
  RunningAverage8 average;
  CHECK(average.empty());
  average.add({0.5f, 1.0f, 0.0f});  // 127.5, 255, 0
  CHECK(average == RunningAverage8{{127, 255, 0}, 1});
  average.add({0.5f, 0.0f, 1.0f});  // (127 + 127.5) / 2, 255 / 2, 255 / 2
  CHECK(average == RunningAverage8{{127, 127, 127}, 2});
}

TEST_CASE("The average of fragments depends on their order", "[running_average]") {
  CHECK(averaged({0, 0, 255}) == 85);
  CHECK(averaged({255, 0, 0}) == 84);  // 255, 127, floor(254 / 3)
}

TEST_CASE("Equal fragments keep their byte however many there are", "[running_average]") {
  RunningAverage8 average;
  for (int i = 0; i < 255; ++i) average.add({100.0f / 255.0f, 0.2f, 1.0f});
  // 100 / 255 times 255 is 100 in float32; 0.2 is 51.
  CHECK(average == RunningAverage8{{100, 51, 255}, 255});
}

TEST_CASE("Fragments that vary drift dark by about a quarter of a level each", "[running_average]") {
  // The specification's numbers. At 200 fragments the average has come down to the least values and stays there, so
  // that the spread decides: a range of 100 gives -41, of 150 -49.
  CHECK(drift(64) == Approx(-16.0).margin(0.5));
  CHECK(drift(200) == Approx(-44.0).margin(2.0));
}

TEST_CASE("With 256 fragments the count wraps and the voxel reads as empty", "[running_average]") {
  RunningAverage8 average;
  for (int i = 0; i < 255; ++i) average.add(glm::vec3(0.4f));  // 102
  CHECK_FALSE(average.empty());
  average.add(glm::vec3(0.4f));
  CHECK(average.empty());
  CHECK(average.value[0] == 102);  // its colour is still there
  average.add(glm::vec3(1.0f));    // and starts anew
  CHECK(average == RunningAverage8{{255, 255, 255}, 1});
}

TEST_CASE("Channels above 1 lose their upper bits and wrap", "[running_average]") {
  RunningAverage8 average;
  average.add({2.0f, 1.0f, 256.0f / 255.0f});  // 510 = 256 + 254
  CHECK(average.value == std::array<uint8_t, 3>{254, 255, 0});
  average.add({2.0f, 1.0f, 1.0f});  // (254 + 510) / 2 = 382 = 256 + 126
  CHECK(average.value == std::array<uint8_t, 3>{126, 255, 127});
}

TEST_CASE("What is no number averages in as nothing", "[running_average]") {
  RunningAverage8 average;
  average.add({std::nanf(""), -0.5f, 1e30f});
  CHECK(average == RunningAverage8{{0, 0, 0}, 1});
}
