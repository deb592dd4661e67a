#include "compare/image_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "compare/image_causes.h"
#include "compare/image_verdict.h"
#include "compare/metrics.h"
#include "error.h"
#include "image/image_file.h"
#include "image/planes.h"
#include "parallel.h"

namespace voxref {

namespace {

/// Compares planes in parallel; the parts join in the order of the image.
template <class Row>  // (y, std::span<float> a, std::span<float> b)
Difference compare_planes(const Image& image, int channel, const Tolerance& tolerance, const Row& row) {
  constexpr size_t rows_per_part = 64;
  const auto width = static_cast<size_t>(image.width()), height = static_cast<size_t>(image.height());
  std::vector<Difference> parts((height + rows_per_part - 1) / rows_per_part);
  parallel_for(height, rows_per_part, [&](size_t begin, size_t end) {
    std::vector<float> a(width), b(width);
    for (size_t y = begin; y < end; ++y) {
      row(y, std::span(a), std::span(b));
      Difference& part = parts[begin / rows_per_part];
      compare_row(part, a, b, {{0, static_cast<int>(y), 0}, channel, 1}, tolerance);
    }
  });
  Difference all;
  for (const Difference& part : parts) all.append(part);
  return all;
}

void compare_values(ImageDiff& diff, const Image& a, const Image& b) {
  const auto planes_a = a.layer(""), planes_b = b.layer("");
  const auto width = static_cast<size_t>(a.width());
  for (size_t c = 0; c < 3; ++c) {
    diff.channels[c] = compare_planes(a, static_cast<int>(c), diff.tolerance,
                                      [&](size_t y, std::span<float> row_a, std::span<float> row_b) {
                                        std::ranges::copy(planes_a[c].subspan(y * width, width), row_a.begin());
                                        std::ranges::copy(planes_b[c].subspan(y * width, width), row_b.begin());
                                      });
    diff.all.append(diff.channels[c]);
  }
  const auto luminances = [&](const auto& planes, size_t y, std::span<float> row) {
    for (size_t x = 0; x < width; ++x) row[x] = luminance_at(planes, y * width + x);
  };
  diff.luminance = compare_planes(a, 0, diff.tolerance, [&](size_t y, std::span<float> row_a, std::span<float> row_b) {
    luminances(planes_a, y, row_a);
    luminances(planes_b, y, row_b);
  });
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

PerceptualDifference perceptual_difference(const Image& a, const Image& b, float exposure, const Progress& progress) {
  PerceptualDifference result;
  progress.check();
  progress("SSIM and FLIP", 0.0);
  result.displayed = displayed_difference(a, b, exposure);
  const std::vector<glm::vec3> test = colors(a), reference = colors(b);
  result.exposures = flip_exposures(reference);
  result.hdr_flip = mean(hdr_flip_map(a.width(), a.height(), reference, test, result.exposures, progress));
  progress.check();
  progress("Yee", 0.0);
  result.yee_pixels = yee_difference(a, b, exposure);
  return result;
}

/// Standard errors that are no numbers: statistics would take their pixels for exact.
void find_nonfinite_errors(NonfiniteErrors& errors, const Image& image, const char* side, uint64_t& count) {
  for (const char* channel : {"stderr.R", "stderr.G", "stderr.B", "stderr.Y"}) {
    if (!image.has(channel)) continue;
    const std::span<const float> plane = image.channel(channel);
    for (size_t i = 0; i < plane.size(); ++i) {
      if (std::isfinite(plane[i])) continue;
      ++count;
      const auto width = static_cast<size_t>(image.width());
      if (errors.first.empty())
        errors.first = fmt::format("{} pixel ({}, {}) {}: {}", side, i % width, i / width, channel, plane[i]);
    }
  }
}

std::string attribute(const Image& image, const char* name) {
  const auto found = image.attributes.find(name);
  return found == image.attributes.end() ? "" : found->second;
}

}  // namespace

ImageDiff diff_images(const Image& a, const Image& b, const ImageDiffOptions& options, const Progress& progress) {
  if (a.width() != b.width() || a.height() != b.height())
    throw Error("comparison",
                fmt::format("sizes differ: {}x{} and {}x{}", a.width(), a.height(), b.width(), b.height()));
  ImageDiff diff;
  diff.tolerance = options.limits.tolerance.value_or(Tolerance{});
  progress.check();
  compare_values(diff, a, b);
  find_nonfinite_errors(diff.errors, a, "A", diff.errors.a);
  find_nonfinite_errors(diff.errors, b, "B", diff.errors.b);
  diff.exposure = options.exposure.value_or(auto_exposure(b));
  diff.psnr = std::numeric_limits<double>::quiet_NaN();
  if (diff.all.nonfinite == 0) {
    if (options.perceptual) {
      diff.perceptual = perceptual_difference(a, b, diff.exposure, progress);
      diff.psnr = diff.perceptual->displayed.psnr;
    } else {
      diff.psnr = displayed_psnr(a, b, diff.exposure);
    }
  }
  diff.same_seed = has_noise(a) && has_noise(b) && !attribute(a, "voxref:seed").empty() &&
                   attribute(a, "voxref:seed") == attribute(b, "voxref:seed") &&
                   attribute(a, "voxref:scene_sha256") == attribute(b, "voxref:scene_sha256");
  progress.check();
  judge_images(diff, a, b, options.limits);
  if (diff.verdict == Verdict::different && diff.all_finite())
    diff.causes = image_causes(diff, a, b, options.limits.noise, progress);
  return diff;
}

nlohmann::json to_json(const ImageDiff& diff) {
  nlohmann::json json = to_json(diff.all, false);
  json["verdict"] = verdict_name(diff.verdict);
  json["nonfinite_a"] = diff.all.nonfinite_a + diff.errors.a;
  json["nonfinite_b"] = diff.all.nonfinite_b + diff.errors.b;
  json["nonfinite_errors"] = {{"a", diff.errors.a}, {"b", diff.errors.b}, {"first", nullptr}};
  if (!diff.errors.first.empty()) json["nonfinite_errors"]["first"] = diff.errors.first;
  json["reasons"] = diff.reasons;
  json["tolerance"] = {{"absolute", diff.tolerance.absolute}, {"relative", diff.tolerance.relative}};
  json["channels"] = {{"R", to_json(diff.channels[0], false)},
                      {"G", to_json(diff.channels[1], false)},
                      {"B", to_json(diff.channels[2], false)},
                      {"luminance", to_json(diff.luminance, false)}};
  json["noise"] = diff.noise ? to_json(*diff.noise) : nlohmann::json();
  json["same_seed"] = diff.same_seed;
  json["exposure"] = diff.exposure;
  json["psnr"] = finite_or_null(diff.psnr);
  for (const char* key : {"ssim", "flip", "hdr_flip", "yee"}) json[key] = nullptr;
  if (const auto& eye = diff.perceptual) {
    json["ssim"] = finite_or_null(eye->displayed.ssim);
    json["flip"] = finite_or_null(eye->displayed.flip);
    json["hdr_flip"] = {{"mean", finite_or_null(eye->hdr_flip)},
                        {"start_exposure", eye->exposures.start},
                        {"stop_exposure", eye->exposures.stop},
                        {"exposures", eye->exposures.count}};
    json["yee"] = {{"pixels", eye->yee_pixels}, {"luminance", 100}, {"field_of_view", 45}};
  }
  json["causes"] = to_json(diff.causes);
  return json;
}

}  // namespace voxref
