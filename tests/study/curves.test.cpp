#include "study/curves.h"

#include <cmath>
#include <numbers>

#include "catch.h"
#include "study/stability_setup.h"

using namespace voxref;

TEST_CASE("A curve breaks where its line crosses the limit", "[stability]") {
  const auto at = [](std::vector<std::pair<double, double>> points, double limit) {
    std::vector<ChartPoint> curve;
    for (const auto& [x, y] : points) curve.push_back(chart_point(x, y));
    return breaks_at(curve, limit);
  };
  CHECK(at({{0.0, 0.0}, {1.0, 2.0}, {2.0, 0.0}}, 1.0) == Approx(0.5));
  CHECK(at({{4.0, 0.0}, {2.0, 1.0}}, 0.25) == Approx(3.5));  // from right to left
  CHECK(at({{0.0, 3.0}, {1.0, 0.0}}, 1.0) == 0.0);
  CHECK(at({{0.0, 0.0}, {1.0, 0.5}}, 1.0) == 1.0);
  CHECK(std::isnan(at({{0.0, 0.0}, {1.0, std::nan("")}, {2.0, 2.0}}, 1.0)));
  CHECK(at({{0.0, 0.0}, {1.0, 2.0}, {2.0, std::nan("")}}, 1.0) == Approx(0.5));
}

TEST_CASE("Neither ripple nor harmonics show a straight trend, and both show a wave on it", "[stability]") {
  constexpr size_t count = 32, periods = 2;
  std::vector<double> line, wave;
  constexpr double slope = 0.01, amplitude = 0.03;
  for (size_t i = 0; i < count; ++i) {
    const double middle = double(i) - 0.5 * (count - 1);
    line.push_back(2.0 + slope * middle);
    // The third harmonic; a cosine about the middle has no trend of its own.
    wave.push_back(line.back() + 2.0 * amplitude * std::cos(2.0 * std::numbers::pi * 3.0 * periods * middle / count));
  }
  // Rounding alone is left: values of 2 have a last bit of 4e-16.
  CHECK(ripple(line) == Approx(0.0).margin(1e-14));
  for (const double a : harmonics(line, periods, 4)) CHECK(a == Approx(0.0).margin(1e-14));
  const std::vector<double> found = harmonics(wave, periods, 4);
  CHECK(found[2] == Approx(amplitude).epsilon(1e-10));
  for (const size_t k : {0u, 1u, 3u}) CHECK(found[k] == Approx(0.0).margin(1e-14));
  // Samples miss the crests by at most half their distance: cos(pi 6 / 32) = 0.83.
  CHECK(ripple(wave) > 2.0 * amplitude * 0.83);
  CHECK(ripple(wave) < 2.0 * amplitude * 1.0001);
}

TEST_CASE("A series takes the rows that it is asked for, and those that hold numbers", "[stability]") {
  Table table{"t", "", {{"set", ""}, {"x", ""}, {"y", ""}}, {}};
  table.add({1.0, 10.0, 0.1});
  table.add({2.0, 20.0, 0.2});
  table.add({1.0, 30.0, Cell{}});
  CHECK(curve(table, "x", "y", "").points.size() == 2);
  table.add({3.0, 40.0, std::nan("")});  // was measured, and went wrong: no curve shall hide it
  CHECK(std::isnan(curve(table, "x", "y", "").points.back().y));
  const Series second = curve(table, "x", "y", "", ChartStyle::dashes, {"set", 2.0});
  REQUIRE(second.points.size() == 1);
  CHECK(second.points[0].x == 20.0);
  CHECK(second.points[0].y == 0.2);
}

TEST_CASE("The worst of several numbers is the largest, or none", "[stability]") {
  const double nan = std::nan("");
  CHECK(worst_of({1.0, 3.0, 2.0}) == 3.0);
  CHECK(worst_of({-2.0, -1.0}) == -1.0);
  CHECK(std::isnan(worst_of({nan, 1.0})));
  CHECK(std::isnan(worst_of({1.0, nan, 2.0})));
  CHECK(std::isnan(worst_of({1.0, nan})));
}

TEST_CASE("The ball's light in closed form is the integral over the hemisphere", "[stability]") {
  for (const glm::vec3 offset : {glm::vec3(0.0f), glm::vec3(0.5f, 0.0f, -0.2f)}) {
    // Directions of equal cosine-weighted solid angle (Malley): the share that meets the ball.
    const glm::dvec3 center(-offset.x, double(ball_height), -offset.z);
    constexpr int rings = 400, sectors = 400;
    int met = 0;
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < sectors; ++j) {
        const double r = std::sqrt((i + 0.5) / rings), phi = 2.0 * std::numbers::pi * (j + 0.5) / sectors;
        const double up = std::sqrt(1.0 - r * r),
                     along = r * std::cos(phi) * center.x + up * center.y + r * std::sin(phi) * center.z;
        const double square = center.x * center.x + center.y * center.y + center.z * center.z;
        met += along > 0.0 && square - along * along < double(ball_radius) * double(ball_radius);
      }
    // 160,000 directions; cells that the ball's rim crosses are 1 % of those inside and round both ways.
    CHECK(double(met) / (rings * sectors) == Approx(ball_light(offset)).epsilon(0.005));
  }
}

TEST_CASE("The value of a series where it has no point is no number", "[stability]") {
  const Series series{"name", ChartStyle::line, {chart_point(1.0, 2.0), chart_point(3.0, 4.0)}};
  CHECK(value_at(series, 3.0) == 4.0);
  CHECK(std::isnan(value_at(series, 2.0)));
}
