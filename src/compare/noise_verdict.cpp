#include "compare/noise_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "compare/convolve.h"
#include "compare/difference.h"
#include "error.h"
#include "image/planes.h"

namespace voxref {

namespace {

constexpr std::array<const char*, 3> color_names = {"R", "G", "B"};

/// A quantity of both images, per pixel.
struct Quantity {
  std::string channel;
  std::vector<float> a, b;
  std::vector<float> error_a, error_b;  ///< empty: exact
};

/// Degrees of freedom of a pixel's standard error: one less than the estimates that it was taken from.
double freedom_of(const Image& image) {
  constexpr double usual = 15.0;  // of `path`, and a careful guess for others: fewer make larger differences chance
  const auto attribute = image.attributes.find("voxref:path");
  if (attribute == image.attributes.end()) return usual;
  const nlohmann::json path = nlohmann::json::parse(attribute->second, nullptr, false);
  const auto whole = [&](const char* key) {
    return path.is_object() && path.contains(key) && path[key].is_number() ? path[key].get<double>() : 0.0;
  };
  return whole("randomizations") >= 2.0 ? whole("randomizations") - 1.0 : usual;
}

std::vector<float> copy(std::span<const float> plane) { return {plane.begin(), plane.end()}; }

std::vector<float> luminances(const Image& image) {
  const Planes planes = image.layer("");
  std::vector<float> values(image.pixel_count());
  for (size_t i = 0; i < values.size(); ++i) values[i] = luminance_at(planes, i);
  return values;
}

std::vector<Quantity> quantities(const Image& a, const Image& b) {
  const auto by_color = [](const Image& image) { return image.has_layer("stderr") || !has_noise(image); };
  std::vector<Quantity> result;
  if (by_color(a) && by_color(b)) {
    const auto error = [](const Image& image, size_t c) {
      return has_noise(image) ? copy(image.layer("stderr")[c]) : std::vector<float>();
    };
    for (size_t c = 0; c < color_names.size(); ++c)
      result.push_back({color_names[c], copy(a.layer("")[c]), copy(b.layer("")[c]), error(a, c), error(b, c)});
    return result;
  }
  const auto error = [](const Image& image) {
    return has_noise(image) ? copy(image.channel("stderr.Y")) : std::vector<float>();
  };
  return {{"Y", luminances(a), luminances(b), error(a), error(b)}};
}

/// Sums over pixels. The error of a mean of independent pixels, and its degrees of freedom (Satterthwaite 1946).
struct RegionSums {
  double count = 0.0, sum = 0.0, variance = 0.0, variance_squares = 0.0;

  void add(double value, double error) {
    const double v = error * error;
    count += 1.0;
    sum += value;
    variance += v;
    variance_squares += v * v;
  }
  Estimate estimate(double pixel_freedom) const {
    Estimate e{sum / count, std::sqrt(variance) / count};
    if (variance_squares > 0.0) e.freedom = pixel_freedom * variance * variance / variance_squares;
    return e;
  }
};

struct Judge {
  const NoiseOptions& options;
  const Quantity& quantity;
  size_t width;
  double freedom_a, freedom_b;
  double corrected;    ///< significance of one test
  double least_scale;  ///< the mean by which darker regions are judged

  RegionTest test(int x, int y, int w, int h, double margin) const {
    RegionSums a, b;
    for (int row = y; row < y + h; ++row)
      for (int column = x; column < x + w; ++column) {
        const size_t i = static_cast<size_t>(row) * width + static_cast<size_t>(column);
        a.add(double{quantity.a[i]}, quantity.error_a.empty() ? 0.0 : double{quantity.error_a[i]});
        b.add(double{quantity.b[i]}, quantity.error_b.empty() ? 0.0 : double{quantity.error_b[i]});
      }
    RegionTest region{x, y, w, h, quantity.channel, a.estimate(freedom_a), b.estimate(freedom_b)};
    region.margin = margin * std::max(std::abs(region.b.mean), least_scale);
    const Welch welch(region.a, region.b);
    if (welch.error > 0.0) {
      region.p = welch.p();
      region.confidence = student_quantile(2.0 * options.significance, welch.freedom) * welch.error;
      region.detectable = welch.detectable(corrected, options.power);
    } else {
      region.p = region.a.mean == region.b.mean ? 1.0 : 0.0;
    }
    return region;
  }
  bool differs(const RegionTest& region) const { return region.p < corrected && !region.equivalent(); }
};

double ratio(const RegionTest& region) {
  const double error = std::hypot(region.a.error, region.b.error);
  return error > 0.0 ? std::abs(region.difference()) / error : region.difference() == 0.0 ? 0.0 : HUGE_VAL;
}

void judge_tiles(NoiseVerdict& verdict, const Judge& judge, int width, int height) {
  const int side = judge.options.tile;
  for (int y = 0; y < height; y += side)
    for (int x = 0; x < width; x += side) {
      const RegionTest tile =
          judge.test(x, y, std::min(side, width - x), std::min(side, height - y), judge.options.tile_margin);
      if (judge.differs(tile))
        ++verdict.tiles_different;
      else if (!tile.equivalent())
        ++verdict.tiles_open;
      if (!verdict.worst_tile || ratio(tile) > ratio(*verdict.worst_tile)) verdict.worst_tile = tile;
      if (!verdict.noisiest_tile ||
          tile.detectable * verdict.noisiest_tile->margin > verdict.noisiest_tile->detectable * tile.margin)
        verdict.noisiest_tile = tile;
    }
}

/// Variance of a - b per pixel, but nowhere less than the mean over the pixels around: where light comes by rare events
/// most pixels have met none, and think themselves exact.
std::vector<float> pooled_variances(const Quantity& q, int width, int height) {
  constexpr size_t taps = 7;
  std::vector<float> variances(q.a.size(), 0.0f);
  for (size_t i = 0; i < variances.size(); ++i)
    for (const std::vector<float>* errors : {&q.error_a, &q.error_b})
      if (!errors->empty()) variances[i] += (*errors)[i] * (*errors)[i];
  const std::vector<float> box(taps, 1.0f / static_cast<float>(taps));
  const std::vector<float> around = convolve<float>(width, height, variances, box, box);
  for (size_t i = 0; i < variances.size(); ++i) variances[i] = std::max(variances[i], around[i]);
  return variances;
}

/// Single pixels, so that a hot one does not hide in its tile's mean. Their limits are those of the fewest degrees of
/// freedom that Welch's test can come to, for all pixels alike: somewhat strict, and quick.
void judge_pixels(NoiseVerdict& verdict, const Judge& judge, int width, int height) {
  const Quantity& q = judge.quantity;
  const double freedom = std::min(judge.freedom_a, judge.freedom_b);
  const double limit = student_quantile(judge.corrected, freedom);
  const double confidence = student_quantile(2.0 * judge.options.significance, freedom);
  const std::vector<float> variances = pooled_variances(q, width, height);
  for (size_t i = 0; i < q.a.size(); ++i) {
    const double error = std::sqrt(double{variances[i]});
    const double difference = std::abs(double{q.a[i]} - double{q.b[i]});
    const double margin = judge.options.tile_margin * std::max(std::abs(double{q.b[i]}), judge.least_scale);
    if (difference <= limit * error || difference + confidence * error <= margin) continue;
    ++verdict.pixels_different;
    if (verdict.worst_pixel && difference <= std::abs(verdict.worst_pixel->difference())) continue;
    const int x = static_cast<int>(i % judge.width), y = static_cast<int>(i / judge.width);
    verdict.worst_pixel = judge.test(x, y, 1, 1, judge.options.tile_margin);
  }
}

nlohmann::json region_json(const RegionTest& region) {
  return {{"x", region.x},
          {"y", region.y},
          {"width", region.width},
          {"height", region.height},
          {"channel", region.channel},
          {"a", region.a.mean},
          {"b", region.b.mean},
          {"stderr_a", region.a.error},
          {"stderr_b", region.b.error},
          {"difference", region.difference()},
          {"confidence", region.confidence},
          {"margin", region.margin},
          {"detectable", region.detectable},
          {"p", finite_or_null(region.p)}};
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  return verdict == Verdict::same ? "same" : verdict == Verdict::different ? "different" : "too_noisy";
}

bool has_noise(const Image& image) { return image.has_layer("stderr") || image.has("stderr.Y"); }

NoiseVerdict judge_noise(const Image& a, const Image& b, const NoiseOptions& options) {
  NoiseVerdict verdict;
  verdict.options = options;
  const int width = a.width(), height = a.height();
  if (width != b.width() || height != b.height()) throw Error("comparison", "sizes differ");
  const std::vector<Quantity> all = quantities(a, b);
  const auto tiles_of = [&](int side) { return static_cast<size_t>((side + options.tile - 1) / options.tile); };
  verdict.tiles = all.size() * tiles_of(width) * tiles_of(height);
  const double regions = static_cast<double>(verdict.tiles + all.size());
  const double pixels = static_cast<double>(all.size() * a.pixel_count());
  bool different = false;
  for (const Quantity& quantity : all) {
    Judge judge{options,
                quantity,
                static_cast<size_t>(width),
                freedom_of(a),
                freedom_of(b),
                0.5 * options.significance / regions,
                0.0};
    const RegionTest image = judge.test(0, 0, width, height, options.margin);
    judge.least_scale = options.dark * std::abs(image.b.mean);
    if (judge.differs(image))
      different = true;
    else if (!image.equivalent())
      ++verdict.image_open;
    verdict.image.push_back(image);
    judge_tiles(verdict, judge, width, height);
    judge.corrected = 0.5 * options.significance / pixels;
    judge_pixels(verdict, judge, width, height);
  }
  different |= verdict.tiles_different + verdict.pixels_different > 0;
  const bool open = verdict.image_open + verdict.tiles_open > 0;
  verdict.verdict = different ? Verdict::different : open ? Verdict::too_noisy : Verdict::same;
  return verdict;
}

nlohmann::json to_json(const NoiseVerdict& verdict) {
  const NoiseOptions& options = verdict.options;
  nlohmann::json json = {{"significance", options.significance},
                         {"power", options.power},
                         {"margin", options.margin},
                         {"tile_margin", options.tile_margin},
                         {"dark", options.dark},
                         {"tile", options.tile},
                         {"image", nlohmann::json::array()},
                         {"image_open", verdict.image_open},
                         {"tiles", verdict.tiles},
                         {"tiles_different", verdict.tiles_different},
                         {"tiles_open", verdict.tiles_open},
                         {"pixels_different", verdict.pixels_different}};
  for (const RegionTest& region : verdict.image) json["image"].push_back(region_json(region));
  const auto put = [&](const char* key, const std::optional<RegionTest>& region) {
    json[key] = region ? region_json(*region) : nlohmann::json();
  };
  put("worst_tile", verdict.worst_tile);
  put("noisiest_tile", verdict.noisiest_tile);
  put("worst_pixel", verdict.worst_pixel);
  return json;
}

}  // namespace voxref
