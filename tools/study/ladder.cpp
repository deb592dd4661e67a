// From the path tracer to the shipped settings, one approximation at a time: whose error is it?
#include "study/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "error.h"
#include "image/image_file.h"
#include "study/deviation.h"
#include "study/ray_gather.h"
#include "study/study_scenes.h"

namespace voxref {

namespace {

struct Region {
  std::string name;
  std::vector<size_t> pixels;
};

/// The whole image; where direct light falls; where it does not; near contacts of surfaces.
std::vector<Region> find_regions(const StudyScene& scene, const View& view, const LadderOptions& options) {
  const Caster caster(scene.scene);
  GridOptions grid;
  grid.resolution = options.resolution;
  const float voxel = fit_grid(scene.scene.bounds(), grid).voxel;
  const std::vector<SeenPoint> seen = see(scene.scene, caster, view, {}, voxel);
  std::vector<Region> regions = {{"whole", {}}, {"lit", {}}, {"shadow", {}}, {"contact", {}}};
  for (size_t i = 0; i < seen.size(); ++i) {
    regions[0].pixels.push_back(i);
    if (!seen[i].surface) continue;
    bool lit = false;
    for (const Light& light : scene.scene.lights) {
      const Illumination at = illuminate(light, seen[i].point.position);
      if (glm::dot(at.to_light, seen[i].point.geometric_normal) <= 0.0f) continue;
      const Ray away = caster.leave(seen[i].point.position, seen[i].point.geometric_normal, at.to_light);
      lit = lit || (light.type == LightType::directional ? !caster.occluded(away)
                                                         : caster.visible(away.origin, light.position));
    }
    regions[lit ? 1 : 2].pixels.push_back(i);
    if (seen[i].contact) regions[3].pixels.push_back(i);
  }
  std::erase_if(regions, [](const Region& region) { return region.pixels.empty(); });
  return regions;
}

double mean(const RungImage& image) {
  double sum = 0.0;
  for (const auto& values : image.tries)
    sum += std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
  return sum / double(image.tries.size());
}

Table ladder_table(const StudyScene& scene, const std::vector<RungImage>& rungs, const std::vector<Region>& regions) {
  Table table{
      "ladder_" + scene.name,
      "Each rung against the one before, in percent of the path-traced mean; the last row of a region: end to end",
      {{"region", ""},
       {"rung", ""},
       {"bias", "%"},
       {"bias_stderr", "%"},
       {"rms", "%"},
       {"rms_stderr", "%"},
       {"rms_to_path", "%"}},
      {}};
  const double percent = 100.0 / mean(rungs.front());
  for (const Region& region : regions) {
    const auto add = [&](const std::string& name, const RungStep& step, const RungStep& total) {
      table.add({region.name, name, percent * step.bias, percent * step.bias_error, percent * step.rms,
                 percent * step.rms_error, percent * total.rms});
    };
    for (size_t r = 1; r < rungs.size(); ++r)
      add(rungs[r].name, rung_step(rungs[r - 1], rungs[r], region.pixels),
          rung_step(rungs[0], rungs[r], region.pixels));
    const RungStep total = rung_step(rungs.front(), rungs.back(), region.pixels);
    add("total", total, total);
  }
  return table;
}

/// Bars that hang on each other from the path tracer's level on; too bright, too dark, and the end.
Chart waterfall(const StudyScene& scene, const std::vector<RungImage>& rungs, const std::vector<size_t>& pixels,
                size_t count) {
  Chart chart{"ladder_" + scene.name,
              scene.name + ": what each approximation adds to the mean",
              {"", false, {}, {}, {}},
              {"bias / % of the path-traced mean", false, {}, {}, {}},
              {{"brighter", ChartStyle::bars, {}}, {"darker", ChartStyle::bars, {}}, {"sum", ChartStyle::bars, {}}}};
  const double percent = 100.0 / mean(rungs.front());
  double level = 0.0;
  for (size_t r = 1; r < count; ++r) {
    const RungStep step = rung_step(rungs[r - 1], rungs[r], pixels);
    const double bias = percent * step.bias;
    chart.series[bias < 0.0 ? 1 : 0].points.push_back(
        {double(r - 1), level + bias, percent * step.bias_error, fmt::format("{:+.2f}", bias), level});
    level += bias;
    chart.x.categories.push_back(rungs[r].name);
  }
  const RungStep total = rung_step(rungs[0], rungs[count - 1], pixels);
  chart.series[2].points.push_back({double(count - 1), percent * total.bias, percent * total.bias_error,
                                    fmt::format("{:+.2f}", percent * total.bias), 0.0});
  chart.x.categories.emplace_back("sum");
  return chart;
}

/// RMS of each rung's own change, per region; on a logarithmic axis, since published units are not W/(sr m^2).
Chart rms_chart(const StudyScene& scene, const std::vector<RungImage>& rungs, const std::vector<Region>& regions,
                size_t begin, size_t end, const std::string& suffix, const std::string& title) {
  Chart chart{"ladder_" + scene.name + suffix,
              scene.name + ": " + title,
              {"", false, {}, {}, {}},
              {"RMS change / % of the path-traced mean", true, {}, {}, {}},
              {}};
  const double percent = 100.0 / mean(rungs.front());
  constexpr double least = 1e-3;  // percent; below it nothing changed
  std::vector<size_t> shown;
  for (size_t r = begin; r < end; ++r)
    if (percent * rung_step(rungs[r - 1], rungs[r], regions[0].pixels).rms > least) shown.push_back(r);
  for (const size_t r : shown) chart.x.categories.push_back(rungs[r].name);
  for (size_t k = 0; k < regions.size(); ++k) {
    Series series{regions[k].name, ChartStyle::points, {}};
    for (size_t i = 0; i < shown.size(); ++i) {
      const RungStep step = rung_step(rungs[shown[i] - 1], rungs[shown[i]], regions[k].pixels);
      const double beside = 0.12 * (double(k) - 0.5 * double(regions.size() - 1));
      if (percent * step.rms > least)
        series.points.push_back({double(i) + beside, percent * step.rms, percent * step.rms_error, "", 0.0});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

RungStep rung_step(const RungImage& from, const RungImage& to, const std::vector<size_t>& pixels) {
  const size_t tries = std::max(from.tries.size(), to.tries.size());
  const auto value = [](const RungImage& image, size_t t, size_t i) {
    return image.tries[image.tries.size() == 1 ? 0 : t][i];
  };
  const auto count = double(pixels.size()), k = double(tries);
  std::vector<double> biases(tries, 0.0);
  double square = 0.0, noise = 0.0, moved = 0.0;
  for (const size_t i : pixels) {
    double sum = 0.0, squares = 0.0;
    for (size_t t = 0; t < tries; ++t) {
      const double d = value(to, t, i) - value(from, t, i);
      biases[t] += d / count;
      sum += d / k;
      squares += d * d / k;
    }
    const double variance = tries > 1 ? std::max(0.0, squares - sum * sum) / (k - 1.0) : 0.0;  // of the mean
    square += sum * sum / count;
    noise += variance / count;
    moved += sum * sum * variance;
  }
  RungStep step;
  step.bias = std::accumulate(biases.begin(), biases.end(), 0.0) / k;
  double scatter = 0.0;
  for (const double b : biases) scatter += (b - step.bias) * (b - step.bias);
  if (tries > 1) step.bias_error = std::sqrt(scatter / (k * (k - 1.0)));
  step.rms = std::sqrt(std::max(0.0, square - noise));
  step.rms_error = square > 0.0 ? std::sqrt(moved / square) / count : 0.0;
  return step;
}

Section ladder_section(const StudyScene& scene, const LadderOptions& options, const std::filesystem::path& gpu_image,
                       const Progress& progress) {
  return timed_section(scene.name, [&](Section& section) {
    View view = sized(scene.view, options.width);
    Image users;
    if (!gpu_image.empty()) {
      users = read_image(gpu_image);
      view.width = users.width();
      view.height = users.height();
    }
    size_t published = 0;
    std::vector<RungImage> rungs = climb_ladder(scene, view, options, published, progress);
    if (!gpu_image.empty()) rungs.push_back({"your image", {measured_cone(users, false).value}});
    const std::vector<Region> regions = find_regions(scene, view, options);
    section.tables.push_back(ladder_table(scene, rungs, regions));
    section.charts.push_back(waterfall(scene, rungs, regions[0].pixels, published));
    section.charts.push_back(rms_chart(scene, rungs, regions, 1, published, "_rms", "RMS change of each rung"));
    if (rungs.size() > published)
      section.charts.push_back(rms_chart(scene, rungs, regions, published, rungs.size(), "_published",
                                         "from the shipped settings to the published ones"));
    const double percent = 100.0 / mean(rungs.front());
    double sum = 0.0;
    for (size_t r = 1; r < published; ++r) sum += percent * rung_step(rungs[r - 1], rungs[r], regions[0].pixels).bias;
    const RungStep total = rung_step(rungs[0], rungs[published - 1], regions[0].pixels);
    section.text = fmt::format(
        "All light (R,G,B) as luminance at the pixels' centres, {}x{} pixels, {} voxels. A rung differs from the one "
        "before "
        "in one thing alone; noise that two rungs share cancels. Error bars are standard errors over {} independent "
        "tries; the rays between voxels are drawn once and shared by all tries.\n\nThe rungs add up to {:+.2f} %, and "
        "the "
        "shipped image is {:+.2f} +- {:.2f} % from the path-traced one.",
        view.width, view.height, options.resolution, options.tries, sum, percent * total.bias,
        percent * total.bias_error);
  });
}

StudyResult run_ladder(const StudyRequest& request) {
  LadderOptions options;
  options.resolution = request.quick ? 64 : 128;
  options.width = request.quick ? 64 : 160;
  options.spp = request.quick ? 16 : 64;
  options.marched_rays = request.quick ? 8 : 32;
  options.voxel_rays = request.quick ? 16 : 64;
  options.narrow_cones = request.quick ? 128 : 1024;
  options.tries = request.quick ? 4 : 8;
  if (!request.gpu_image.empty() && request.scenes.size() != 1)
    throw Error("--gpu", "needs the one scene that the image shows");
  StudyResult result{"ladder", "how much of the error each approximation owns", {}, {}};
  std::vector<StudyScene> own;
  if (request.scenes.empty()) {
    own.push_back(cornell_point_scene());
    if (!request.quick) {
      if (auto sponza = public_scene("sponza", request.assets, false))
        own.push_back(std::move(*sponza));
      else
        result.skipped.emplace_back("sponza: not in VOXREF_ASSETS");
    }
  }
  for (const StudyScene& scene : request.scenes.empty() ? own : request.scenes)
    result.sections.push_back(ladder_section(scene, options, request.gpu_image, request.progress));
  return result;
}

}  // namespace voxref
