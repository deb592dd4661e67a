#include "compare/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "compare/difference.h"
#include "compare/displayed.h"
#include "compare/measured.h"
#include "error.h"

namespace voxref {

namespace {

using Layer = std::array<std::span<const float>, 3>;

glm::vec3 pixel(const Layer& layer, size_t i) { return {layer[0][i], layer[1][i], layer[2][i]}; }

void count_nonfinite(Metrics& metrics, const Image& cone, const Image& path, const Measured& of_cone,
                     const Measured& of_path) {
  const Layer a = cone.layer(""), b = path.layer("");
  const auto finite = [](const glm::vec3& v) { return std::isfinite(v.r) && std::isfinite(v.g) && std::isfinite(v.b); };
  const auto note = [&](const char* side, size_t i) {
    const auto width = static_cast<size_t>(cone.width());
    if (metrics.first_nonfinite.empty())
      metrics.first_nonfinite =
          std::string(side) + " pixel (" + std::to_string(i % width) + ", " + std::to_string(i / width) + ")";
  };
  for (size_t i = 0; i < of_cone.value.size(); ++i) {
    if (!std::isfinite(of_cone.value[i]) || !finite(pixel(a, i))) {
      ++metrics.nonfinite_cone;
      note("cone", i);
    }
    if (!std::isfinite(of_path.value[i]) || !std::isfinite(of_path.standard_error[i]) || !finite(pixel(b, i))) {
      ++metrics.nonfinite_path;
      note("path", i);
    }
  }
}

void measure_luminance(Metrics& metrics, const Measured& of_cone, const Measured& of_path) {
  const auto count = static_cast<double>(of_cone.value.size());
  const double cone = of_cone.mean(), path = of_path.mean();
  double difference = 0.0, noise = 0.0;
  for (size_t i = 0; i < of_cone.value.size(); ++i) {
    const double d = of_cone.value[i] - of_path.value[i], s = of_path.standard_error[i];
    difference += d * d / count;
    noise += s * s / count;
  }
  const double error = std::sqrt(std::max(0.0, difference - noise));
  metrics.mean_ratio = cone / path;
  metrics.rel_error = error == 0.0 ? 0.0 : error / path;
  metrics.noise_share = noise / difference;
}

void measure_radiance(Metrics& metrics, const Layer& cone, const Layer& path) {
  const double count = 3.0 * static_cast<double>(cone[0].size());
  double squares = 0.0, relative = 0.0;
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < cone[c].size(); ++i) {
      const double a = cone[c][i], b = path[c][i], square = (a - b) * (a - b);
      squares += square / count;
      relative += square / (b * b + 0.01) / count;
    }
  metrics.rmse = std::sqrt(squares);
  metrics.relmse = relative;
}

}  // namespace

Metrics compare(const Image& cone, const Image& path, bool indirect_only, float exposure) {
  if (cone.width() != path.width() || cone.height() != path.height())
    throw Error("comparison", "sizes differ, " + std::to_string(cone.width()) + "x" + std::to_string(cone.height()) +
                                  " and " + std::to_string(path.width()) + "x" + std::to_string(path.height()));
  Metrics metrics;
  metrics.indirect_only = indirect_only;
  const Measured of_cone = measured_cone(cone, indirect_only), of_path = measured_path(path, indirect_only);
  count_nonfinite(metrics, cone, path, of_cone, of_path);
  if (metrics.nonfinite_cone + metrics.nonfinite_path > 0) {
    metrics.mean_ratio = metrics.rel_error = metrics.noise_share = metrics.rmse = metrics.relmse = metrics.psnr =
        metrics.ssim = metrics.flip = std::numeric_limits<double>::quiet_NaN();
    return metrics;
  }
  measure_luminance(metrics, of_cone, of_path);
  measure_radiance(metrics, cone.layer(""), path.layer(""));
  const DisplayedDifference displayed = displayed_difference(cone, path, exposure);
  metrics.psnr = displayed.psnr;
  metrics.ssim = displayed.ssim;
  metrics.flip = displayed.flip;
  return metrics;
}

nlohmann::json to_json(const Metrics& metrics) {
  nlohmann::json json = {{"of", metrics.indirect_only ? "indirect" : "rgb"},
                         {"mean_ratio", finite_or_null(metrics.mean_ratio)},
                         {"rel_error", finite_or_null(metrics.rel_error)},
                         {"noise_share", finite_or_null(metrics.noise_share)},
                         {"rmse", finite_or_null(metrics.rmse)},
                         {"relmse", finite_or_null(metrics.relmse)},
                         {"relmse_formula", Metrics::relmse_formula},
                         {"psnr", finite_or_null(metrics.psnr)},
                         {"ssim", finite_or_null(metrics.ssim)},
                         {"flip", finite_or_null(metrics.flip)},
                         {"nonfinite_cone", metrics.nonfinite_cone},
                         {"nonfinite_path", metrics.nonfinite_path},
                         {"first_nonfinite", nullptr}};
  if (!metrics.first_nonfinite.empty()) json["first_nonfinite"] = metrics.first_nonfinite;
  return json;
}

float auto_exposure(const Image& image) {
  constexpr double percentile = 0.99;
  constexpr float shown_as = 0.9f;  // of the display's white: bright surfaces stay below clipping, lamps do not matter
  constexpr float most_stops = 64.0f;  // 2^exposure stays finite for images that are black but for rounding
  const Layer layer = image.layer("");
  std::vector<float> values;
  for (size_t i = 0; i < image.pixel_count(); ++i)
    if (const float value = luminance(pixel(layer, i)); std::isfinite(value)) values.push_back(value);
  if (values.empty()) return 0.0f;
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(percentile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), rank, values.end());
  if (*rank <= 0.0f) return 0.0f;
  return std::clamp(std::log2(shown_as) - std::log2(*rank), -most_stops, most_stops);
}

}  // namespace voxref
