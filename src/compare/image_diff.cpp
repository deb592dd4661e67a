#include "compare/image_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "compare/metrics.h"
#include "error.h"
#include "image/image_file.h"
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
    for (size_t x = 0; x < width; ++x) {
      const size_t i = y * width + x;
      row[x] = luminance({planes[0][i], planes[1][i], planes[2][i]});
    }
  };
  diff.luminance = compare_planes(a, 0, diff.tolerance, [&](size_t y, std::span<float> row_a, std::span<float> row_b) {
    luminances(planes_a, y, row_a);
    luminances(planes_b, y, row_b);
  });
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

PerceptualDifference perceptual_difference(const Image& a, const Image& b, float exposure) {
  PerceptualDifference result;
  result.displayed = displayed_difference(a, b, exposure);
  const std::vector<glm::vec3> test = colors(a), reference = colors(b);
  result.exposures = flip_exposures(reference);
  result.hdr_flip = mean(hdr_flip_map(a.width(), a.height(), reference, test, result.exposures));
  result.yee_pixels = yee_difference(a, b, exposure);
  return result;
}

/// Both images with a mistake undone in the first; where that tells nothing both are the reference.
struct Undone {
  Image a, b;
};
Undone undo(const Mistake& mistake, const Image& a, const Image& b, const Field& field_a, const Field& field_b) {
  Undone undone{Image(b.width(), b.height()), b};
  undone.a.attributes = a.attributes;
  undone.a.add_layer("");
  for (const char* channel : {"stderr.R", "stderr.G", "stderr.B", "stderr.Y"})
    if (a.has(channel)) undone.a.add(channel);
  const auto to = undone.a.layer(""), reference = undone.b.layer("");
  for (size_t i = 0; i < field_b.texel_count(); ++i) {
    glm::vec4 value, expected;
    const glm::ivec3 place = field_b.place(i);
    const bool told = mistake.undo(field_a, field_b, place, value, expected);
    if (!told) value = expected = field_b.texel(place);
    for (int c = 0; c < 3; ++c) {
      to[size_t(c)][i] = value[c];
      reference[size_t(c)][i] = expected[c];
    }
    glm::ivec3 from;
    if (!told || !mistake.placement->source(place, field_a.size, from)) continue;
    // Errors are small: one of the value before is the difference that it makes after.
    const size_t source = field_a.index(from);
    const auto carry = [&](const char* channel, size_t c) {
      if (!a.has(channel)) return;
      const glm::vec4 stored = field_a.texel(from);
      const float error = a.channel(channel)[source];
      const glm::vec4 moved = mistake.recoding->undo(stored + glm::vec4(glm::vec3(error), 0.0f));
      undone.a.channel(channel)[i] = std::abs(moved[int(c)] - value[int(c)]);
    };
    carry("stderr.R", 0);
    carry("stderr.G", 1);
    carry("stderr.B", 2);
    carry("stderr.Y", 1);
  }
  return undone;
}

std::vector<Cause> search_causes(const ImageDiff& diff, const Image& a, const Image& b, const NoiseOptions& options) {
  const Field field_a = field_of(a), field_b = field_of(b);
  // What an 8-bit file rounds away, and ten times the usual tolerance: a cause must explain, not reproduce.
  const Tolerance loose{10.0 * diff.tolerance.absolute + 1.0 / 255.0, 10.0 * diff.tolerance.relative};
  return likely_causes(field_a, field_b, [&](const Mistake& mistake) {
    if (!diff.noise) return explains(mistake, field_a, field_b, loose);
    const Undone undone = undo(mistake, a, b, field_a, field_b);
    return judge_noise(undone.a, undone.b, options).verdict != Verdict::different;
  });
}

/// Adds a reason for every metric that is over its limit. NaN is over every limit.
void hold_against_limits(ImageDiff& diff, const ImageLimits& limits) {
  constexpr double absent = std::numeric_limits<double>::quiet_NaN();
  const auto over = [&](const char* name, double value, const std::optional<double>& limit, bool at_least) {
    if (!limit || (at_least ? value >= *limit : value <= *limit)) return;
    diff.reasons.push_back(fmt::format("{} is {:.6g}, {} {:g}", name, value, at_least ? "below" : "above", *limit));
  };
  const auto& eye = diff.perceptual;
  over("RMSE", diff.all.rmse(), limits.rmse, false);
  over("relMSE", diff.all.relmse(), limits.relmse, false);
  over("PSNR", diff.psnr, limits.psnr, true);
  over("SSIM", eye ? eye->displayed.ssim : absent, limits.ssim, true);
  over("FLIP", eye ? eye->displayed.flip : absent, limits.flip, false);
  over("HDR-FLIP", eye ? eye->hdr_flip : absent, limits.hdr_flip, false);
}

std::string noise_reason(const NoiseVerdict& noise) {
  if (noise.verdict == Verdict::too_noisy) {
    const RegionTest& tile = *noise.noisiest_tile;
    return fmt::format(
        "{} of {} tiles and image means are too noisy to say: in the noisiest tile a difference of {:.3g} "
        "({}) would have been found, {:.3g} matters",
        noise.tiles_open, noise.tiles + noise.image.size(), tile.detectable, tile.channel, tile.margin);
  }
  for (const RegionTest& image : noise.image)
    if (!image.equivalent() && std::abs(image.difference()) > image.detectable)
      return fmt::format("the image's mean {} is {:.6g} instead of {:.6g}, {:.1f} standard errors off", image.channel,
                         image.a.mean, image.b.mean,
                         std::abs(image.difference()) / std::hypot(image.a.error, image.b.error));
  if (noise.tiles_different > 0) {
    const RegionTest& tile = *noise.worst_tile;
    return fmt::format("{} of {} tiles differ; the tile at ({}, {}) has {} {:.6g} instead of {:.6g}",
                       noise.tiles_different, noise.tiles, tile.x, tile.y, tile.channel, tile.a.mean, tile.b.mean);
  }
  if (noise.pixels_different > 0) {
    const RegionTest& pixel = *noise.worst_pixel;
    return fmt::format("{} single values differ; pixel ({}, {}) has {} {:.6g} instead of {:.6g}",
                       noise.pixels_different, pixel.x, pixel.y, pixel.channel, pixel.a.mean, pixel.b.mean);
  }
  return "the image's mean differs";
}

void judge(ImageDiff& diff, const Image& a, const Image& b, const ImageLimits& limits) {
  const Difference& all = diff.all;
  if (all.nonfinite > 0) {
    const Mismatch& first = *all.first_nonfinite;
    diff.reasons.push_back(
        fmt::format("{} values are NaN or infinite, the first at pixel ({}, {}) {}: {} instead of {}", all.nonfinite,
                    first.at.x, first.at.y, "RGB"[first.channel], first.a, first.b));
    diff.verdict = Verdict::different;
    return;
  }
  hold_against_limits(diff, limits);
  const bool by_values = !limits.by_metrics() || limits.tolerance;
  if (by_values && all.fraction() > limits.fraction) {
    const bool noisy = has_noise(a) || has_noise(b);
    if (noisy && !limits.tolerance) {
      diff.noise = judge_noise(a, b, limits.noise);
      diff.verdict = diff.noise->verdict;
      if (diff.verdict != Verdict::same) diff.reasons.push_back(noise_reason(*diff.noise));
    } else {
      diff.reasons.push_back(fmt::format("{} of {} values differ by more than {:g} + {:g} |b|", all.differing,
                                         all.values, diff.tolerance.absolute, diff.tolerance.relative));
    }
  }
  if (!diff.reasons.empty() && diff.verdict != Verdict::too_noisy) diff.verdict = Verdict::different;
}

std::string attribute(const Image& image, const char* name) {
  const auto found = image.attributes.find(name);
  return found == image.attributes.end() ? "" : found->second;
}

}  // namespace

ImageDiff diff_images(const Image& a, const Image& b, const ImageDiffOptions& options) {
  if (a.width() != b.width() || a.height() != b.height())
    throw Error("comparison",
                fmt::format("sizes differ: {}x{} and {}x{}", a.width(), a.height(), b.width(), b.height()));
  ImageDiff diff;
  diff.tolerance = options.limits.tolerance.value_or(Tolerance{});
  compare_values(diff, a, b);
  diff.exposure = options.exposure.value_or(auto_exposure(b));
  diff.psnr = std::numeric_limits<double>::quiet_NaN();
  if (diff.all.nonfinite == 0) {
    if (options.perceptual) {
      diff.perceptual = perceptual_difference(a, b, diff.exposure);
      diff.psnr = diff.perceptual->displayed.psnr;
    } else {
      diff.psnr = displayed_psnr(a, b, diff.exposure);
    }
  }
  diff.same_seed = has_noise(a) && has_noise(b) && !attribute(a, "voxref:seed").empty() &&
                   attribute(a, "voxref:seed") == attribute(b, "voxref:seed") &&
                   attribute(a, "voxref:scene_sha256") == attribute(b, "voxref:scene_sha256");
  judge(diff, a, b, options.limits);
  if (diff.verdict == Verdict::different && diff.all.nonfinite == 0)
    diff.causes = search_causes(diff, a, b, options.limits.noise);
  return diff;
}

nlohmann::json to_json(const ImageDiff& diff) {
  const auto number = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); };
  nlohmann::json json = to_json(diff.all, false);
  json["verdict"] = verdict_name(diff.verdict);
  json["reasons"] = diff.reasons;
  json["tolerance"] = {{"absolute", diff.tolerance.absolute}, {"relative", diff.tolerance.relative}};
  json["channels"] = {{"R", to_json(diff.channels[0], false)},
                      {"G", to_json(diff.channels[1], false)},
                      {"B", to_json(diff.channels[2], false)},
                      {"luminance", to_json(diff.luminance, false)}};
  json["noise"] = diff.noise ? to_json(*diff.noise) : nlohmann::json();
  json["same_seed"] = diff.same_seed;
  json["exposure"] = diff.exposure;
  json["psnr"] = number(diff.psnr);
  for (const char* key : {"ssim", "flip", "hdr_flip", "yee"}) json[key] = nullptr;
  if (const auto& eye = diff.perceptual) {
    json["ssim"] = number(eye->displayed.ssim);
    json["flip"] = number(eye->displayed.flip);
    json["hdr_flip"] = {{"mean", number(eye->hdr_flip)},
                        {"start_exposure", eye->exposures.start},
                        {"stop_exposure", eye->exposures.stop},
                        {"exposures", eye->exposures.count}};
    json["yee"] = {{"pixels", eye->yee_pixels}, {"luminance", 100}, {"field_of_view", 45}};
  }
  json["causes"] = to_json(diff.causes);
  return json;
}

}  // namespace voxref
