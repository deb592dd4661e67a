#include "compare/difference.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "compare/metrics.h"

namespace voxref {

namespace {

size_t bin_of(double magnitude) {
  static constexpr std::array<double, Difference::bins - 1> decades = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2,
                                                                       1e-1, 1.0,  1e1,  1e2,  1e3,  1e4};
  return static_cast<size_t>(std::ranges::upper_bound(decades, magnitude) - decades.begin());
}

bool worse(const Mismatch& x, const Mismatch& y) { return std::abs(x.a - x.b) > std::abs(y.a - y.b); }

/// Keeps the list sorted and short. Of equal ones the earlier stays in front.
void note_worst(std::vector<Mismatch>& worst, const Mismatch& mismatch) {
  if (worst.size() == Difference::most_worst && !worse(mismatch, worst.back())) return;
  worst.insert(std::upper_bound(worst.begin(), worst.end(), mismatch, worse), mismatch);
  if (worst.size() > Difference::most_worst) worst.pop_back();
}

/// In the order of the file: z, y, x, channel.
std::optional<Mismatch> earlier(const std::optional<Mismatch>& x, const std::optional<Mismatch>& y) {
  if (!x || !y) return x ? x : y;
  const auto key = [](const Mismatch& m) { return std::tuple(m.at.z, m.at.y, m.at.x, m.channel); };
  return key(*y) < key(*x) ? y : x;
}

nlohmann::json number(float value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0.0f ? "inf" : "-inf";
}

}  // namespace

bool Tolerance::accepts(float a, float b) const {
  if (!std::isfinite(a) || !std::isfinite(b)) return false;
  return std::abs(double{a} - double{b}) <= absolute + relative * std::abs(double{b});
}

double Difference::rmse() const { return std::sqrt(mean(sum_squares)); }
double Difference::psnr() const { return 20.0 * std::log10(peak / rmse()); }

void Difference::append(const Difference& other) {
  values += other.values;
  differing += other.differing;
  nonfinite += other.nonfinite;
  nonfinite_a += other.nonfinite_a;
  nonfinite_b += other.nonfinite_b;
  first_nonfinite = earlier(first_nonfinite, other.first_nonfinite);
  first = earlier(first, other.first);
  for (const Mismatch& mismatch : other.worst) note_worst(worst, mismatch);
  for (size_t i = 0; i < bins; ++i) histogram[i] += other.histogram[i];
  max_abs = std::max(max_abs, other.max_abs);
  peak = std::max(peak, other.peak);
  sum_a += other.sum_a;
  sum_b += other.sum_b;
  sum_squares += other.sum_squares;
  sum_relative += other.sum_relative;
}

void compare_row(Difference& difference, std::span<const float> a, std::span<const float> b, const Row& row,
                 const Tolerance& tolerance) {
  difference.values += a.size();
  for (size_t i = 0; i < a.size(); ++i) {
    const double x = double{a[i]}, y = double{b[i]};
    if (a[i] == b[i] && std::isfinite(a[i])) {  // most values of most comparisons
      difference.sum_a += x;
      difference.sum_b += y;
      difference.peak = std::max(difference.peak, std::abs(y));
      continue;
    }
    const auto place = static_cast<int>(i);
    const Mismatch mismatch{
        {row.at.x + place / row.channels, row.at.y, row.at.z}, row.channel + place % row.channels, a[i], b[i]};
    const bool finite = std::isfinite(a[i]) && std::isfinite(b[i]);
    if (!finite) {
      ++difference.nonfinite;
      difference.nonfinite_a += !std::isfinite(a[i]);
      difference.nonfinite_b += !std::isfinite(b[i]);
      if (!difference.first_nonfinite) difference.first_nonfinite = mismatch;
    }
    if (!tolerance.accepts(a[i], b[i])) {
      ++difference.differing;
      if (!difference.first) difference.first = mismatch;
    }
    if (!finite) continue;
    const double magnitude = std::abs(x - y);
    difference.peak = std::max(difference.peak, std::abs(y));
    difference.sum_a += x;
    difference.sum_b += y;
    difference.sum_squares += magnitude * magnitude;
    difference.sum_relative += magnitude * magnitude / (y * y + 0.01);
    difference.max_abs = std::max(difference.max_abs, magnitude);
    ++difference.histogram[bin_of(magnitude)];
    note_worst(difference.worst, mismatch);
  }
}

nlohmann::json finite_or_null(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); }

nlohmann::json to_json(const Mismatch& m, bool volume) {
  nlohmann::json place =
      volume ? nlohmann::json{m.at.x, m.at.y, m.at.z, m.channel} : nlohmann::json{m.at.x, m.at.y, m.channel};
  return {{"place", std::move(place)}, {"a", number(m.a)}, {"b", number(m.b)}};
}

nlohmann::json to_json(const Difference& difference, bool volume) {
  nlohmann::json json = {{"nonfinite_a", difference.nonfinite_a},
                         {"nonfinite_b", difference.nonfinite_b},
                         {"first_nonfinite", nullptr},
                         {"max_abs", difference.max_abs},
                         {"mean_signed", difference.mean_signed()},
                         {"rmse", difference.rmse()},
                         {"relmse", difference.relmse()},
                         {"relmse_formula", Metrics::relmse_formula},
                         {"worst", nullptr},
                         {"worst_places", nlohmann::json::array()},
                         {"first", nullptr},
                         {"differing", {{"count", difference.differing}, {"fraction", difference.fraction()}}}};
  if (volume) {
    json["psnr"] = finite_or_null(difference.psnr());
    json["psnr_formula"] = "20 log10(max |b| / rmse)";
  }
  for (const Mismatch& mismatch : difference.worst) json["worst_places"].push_back(to_json(mismatch, volume));
  if (!difference.worst.empty()) json["worst"] = json["worst_places"][0];
  if (difference.first) json["first"] = to_json(*difference.first, volume);
  if (difference.first_nonfinite) json["first_nonfinite"] = to_json(*difference.first_nonfinite, volume);
  nlohmann::json histogram = nlohmann::json::array();
  for (size_t i = 0; i < Difference::bins; ++i)
    histogram.push_back({{"from", i == 0 ? 0.0 : std::pow(10.0, Difference::first_decade + int(i) - 1)},
                         {"count", difference.histogram[i]}});
  json["histogram"] = std::move(histogram);
  return json;
}

}  // namespace voxref
