#include "compare/statistics.h"

#include <random>
#include <vector>

#include "catch.h"

namespace voxref {

TEST_CASE("Student's quantiles are those of the printed tables", "[statistics]") {
  // Two-sided 5 % and 1 %, as any textbook has them, to its three decimals.
  CHECK(student_quantile(0.05, 1.0) == Approx(12.706).margin(6e-4));
  CHECK(student_quantile(0.05, 10.0) == Approx(2.228).margin(6e-4));
  CHECK(student_quantile(0.01, 30.0) == Approx(2.750).margin(6e-4));
  CHECK(student_quantile(0.01, 1e6) == Approx(2.576).margin(6e-4));
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(student_quantile(0.01, infinity) == Approx(2.576).margin(6e-4));
  CHECK(student_tail(0.0, 7.0) == Approx(1.0));
}

TEST_CASE("Student's tails are those of the closed forms for one, two and three degrees, however small",
          "[statistics]") {
  for (const double t : {0.01, 0.5, 1.0, 3.0, 20.0, 1000.0}) {
    CHECK(student_tail(t, 1.0) == Approx(1.0 - 2.0 * std::atan(t) / std::numbers::pi).epsilon(1e-9));
    CHECK(student_tail(t, 2.0) == Approx(2.0 / (2.0 + t * t + t * std::sqrt(2.0 + t * t))).epsilon(1e-9));
    const double angle = std::atan(t / std::sqrt(3.0));
    const double body = 2.0 * (angle + std::sin(angle) * std::cos(angle)) / std::numbers::pi;
    CHECK(student_tail(t, 3.0) == Approx(1.0 - body).margin(1e-12));
  }
  // Where the approximation for many degrees takes over it is right to its stated 0.1 % of the tail.
  for (const double t : {1.0, 3.0, 5.0})
    CHECK(student_tail(t, 1000.0) == Approx(student_tail(t, 999.999)).epsilon(1e-3));
}

TEST_CASE("Student's quantiles are right for tails as small as a large picture's pixels need", "[statistics]") {
  // 1 % over the three channels of 512x512 pixels is 6e-9 each, over 3840x2160 2e-10; closed forms of one and two
  // degrees of freedom.
  for (const double tail : {0.3, 1e-4, 6e-9, 2e-10, 1e-15}) {
    CAPTURE(tail);
    CHECK(student_quantile(tail, 1.0) == Approx(1.0 / std::tan(0.5 * std::numbers::pi * tail)).epsilon(1e-9));
    const double body = 1.0 - tail;
    CHECK(student_quantile(tail, 2.0) == Approx(body * std::sqrt(2.0 / (tail * (2.0 - tail)))).epsilon(1e-9));
    for (const double freedom : {3.0, 15.0, 30.0, 400.0, 1e5})
      CHECK(student_tail(student_quantile(tail, freedom), freedom) == Approx(tail).epsilon(1e-9));
  }
  // Of the normal distribution beyond 5 and 6 deviations (any table).
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(student_quantile(5.733031e-7, infinity) == Approx(5.0).epsilon(1e-6));
  CHECK(student_quantile(1.973175e-9, infinity) == Approx(6.0).epsilon(1e-6));
  // Where the approximation for many degrees takes over: 0.1 % of a quantile is far less than samples tell.
  for (const double tail : {6e-9, 2e-10})
    CHECK(student_quantile(tail, 1000.0) == Approx(student_quantile(tail, 999.999)).epsilon(1e-3));
}

TEST_CASE("Welch's test is wrong as often as its significance says, and finds as much as its power says",
          "[statistics]") {
  // Samples of 12 and 30 values, spreads 1 and 3. Of 4000 trials 5 % and 90 % are known to 0.35 and 0.5 %; four of
  // those, and 1 % for the approximations of the freedom and of the power.
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  constexpr int trials = 4000;
  constexpr double significance = 0.05, power = 0.9;
  const Estimate known_a{0.0, 1.0 / std::sqrt(12.0), 11.0}, known_b{0.0, 3.0 / std::sqrt(30.0), 29.0};
  const double bias = Welch(known_a, known_b).detectable(significance, power);
  int false_alarms = 0, found = 0;
  for (int i = 0; i < trials; ++i) {
    std::vector<double> a(12), b(30);
    for (double& value : a) value = normal(random);
    for (double& value : b) value = 3.0 * normal(random);
    Estimate biased = estimate(a);
    false_alarms += Welch(biased, estimate(b)).p() < significance;
    biased.mean += bias;
    found += Welch(biased, estimate(b)).p() < significance;
  }
  CHECK(std::abs(false_alarms / double{trials} - significance) < 4.0 * 0.0035 + 0.01);
  CHECK(std::abs(found / double{trials} - power) < 4.0 * 0.005 + 0.01);
}

}  // namespace voxref
