#include "compare/difference.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "catch.h"

namespace voxref {

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

struct Arrays {
  static constexpr int width = 7, height = 5, channels = 3;
  std::vector<float> a, b;

  explicit Arrays(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 2.0f);
    for (int i = 0; i < width * height * channels; ++i) {
      b.push_back(uniform(random));
      a.push_back(i % 4 == 0 ? uniform(random) : b.back());
    }
  }
  /// @param order of the rows, which must not matter
  Difference compare(std::vector<int> order, const Tolerance& tolerance = {}) const {
    Difference all;
    const size_t row = width * channels;
    for (const int y : order) {
      Difference part;
      compare_row(part, std::span(a).subspan(size_t(y) * row, row), std::span(b).subspan(size_t(y) * row, row),
                  {{0, y, 0}, 0, channels}, tolerance);
      all.append(part);
    }
    return all;
  }
};

}  // namespace

TEST_CASE("A difference is what a plain loop over the values finds, whatever the order of its parts", "[diff]") {
  const Arrays arrays(3);
  double largest = 0.0, sum = 0.0, squares = 0.0, relative = 0.0;
  uint64_t differing = 0;
  for (size_t i = 0; i < arrays.a.size(); ++i) {
    const double d = double{arrays.a[i]} - double{arrays.b[i]}, b = arrays.b[i];
    largest = std::max(largest, std::abs(d));
    sum += d;
    squares += d * d;
    relative += d * d / (b * b + 0.01);
    differing += std::abs(d) > 1e-5 + 1e-3 * b;
  }
  const auto count = double(arrays.a.size());
  for (const auto& order : {std::vector{0, 1, 2, 3, 4}, {4, 2, 0, 3, 1}}) {
    const Difference found = arrays.compare(order);
    CHECK(found.values == arrays.a.size());
    CHECK(found.differing == differing);
    CHECK(found.max_abs == Approx(largest));
    // Sums of a and b are taken apart: what cancels leaves rounding of their own size.
    CHECK(found.mean_signed() == Approx(sum / count).margin(1e-12));
    CHECK(found.rmse() == Approx(std::sqrt(squares / count)));
    CHECK(found.relmse() == Approx(relative / count));
    REQUIRE(found.first);
    CHECK(found.first->at == glm::ivec3(0));
    REQUIRE(found.worst.size() == Difference::most_worst);
    CHECK(std::abs(found.worst[0].a - found.worst[0].b) == Approx(largest));
    for (size_t i = 1; i < found.worst.size(); ++i)
      CHECK(std::abs(found.worst[i].a - found.worst[i].b) <= std::abs(found.worst[i - 1].a - found.worst[i - 1].b));
  }
}

TEST_CASE("NaN and infinity always differ, are counted by side, and are in no mean", "[diff]") {
  Arrays arrays(4);
  arrays.a = arrays.b;
  arrays.a[20] = nan_value;
  arrays.b[41] = infinite;
  arrays.a[62] = arrays.b[62] = nan_value;  // equal on both sides is no excuse
  arrays.a[83] = arrays.b[83] = infinite;
  const Difference found = arrays.compare({4, 3, 2, 1, 0}, {1e30, 1.0});
  CHECK(found.nonfinite == 4);
  CHECK(found.nonfinite_a == 3);
  CHECK(found.nonfinite_b == 3);
  CHECK(found.differing == 4);
  CHECK(found.rmse() == 0.0);
  CHECK(found.max_abs == 0.0);
  REQUIRE(found.first_nonfinite);
  CHECK(found.first_nonfinite->at == glm::ivec3(6, 0, 0));
  CHECK(found.first_nonfinite->channel == 2);
  CHECK(to_json(found, false)["first_nonfinite"]["a"] == "nan");
}

TEST_CASE("The histogram sorts differences by decades", "[diff]") {
  Difference found;
  compare_row(found, std::vector{1e-9f, 3e-8f, 0.5f, 2.0f, 3e6f, 1.0f}, std::vector{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f},
              {}, {});
  const auto bin = [](int decade) { return size_t(decade - Difference::first_decade) + 1; };
  CHECK(found.histogram[0] == 1);
  CHECK(found.histogram[bin(-8)] == 1);
  CHECK(found.histogram[bin(-1)] == 1);
  CHECK(found.histogram[bin(0)] == 1);
  CHECK(found.histogram[bin(4)] == 1);  // the last one holds all that is larger
}

}  // namespace voxref
