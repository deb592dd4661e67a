// From the path tracer to the shipped settings, one approximation at a time: whose error is it?
#include "study/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/ladder_charts.h"
#include "study/ray_gather.h"
#include "study/study_scenes.h"

namespace voxref {

namespace {

/// The whole image; where direct light falls; where none does; near contacts of surfaces.
std::vector<Region> find_regions(const StudyScene& scene, const View& view, const LadderOptions& options,
                                 const std::vector<double>& direct) {
  const Caster caster(scene.scene);
  GridOptions grid;
  grid.resolution = options.resolution;
  const float voxel = fit_grid(scene.scene.bounds(), grid).voxel;
  const std::vector<SeenPoint> seen = see(scene.scene, caster, view, {}, voxel);
  std::vector<Region> regions = {{"whole", {}}, {"lit", {}}, {"shadow", {}}, {"contact", {}}};
  for (size_t i = 0; i < seen.size(); ++i) {
    regions[0].pixels.push_back(i);
    if (!seen[i].surface) continue;
    regions[direct[i] > 0.0 ? 1 : 2].pixels.push_back(i);
    if (seen[i].contact) regions[3].pixels.push_back(i);
  }
  std::erase_if(regions, [](const Region& region) { return region.pixels.empty(); });
  return regions;
}

/// What is not finite, in a sentence each.
std::vector<std::string> find_nonfinite(const LadderClimb& climb, const View& view) {
  std::vector<std::string> found;
  const auto width = static_cast<size_t>(view.width);
  for (const RungImage& rung : climb.rungs) {
    size_t count = 0, first = 0;
    for (const std::vector<double>& values : rung.tries)
      for (size_t i = values.size(); i-- > 0;)
        if (!std::isfinite(values[i])) first = count++ == 0 ? i : std::min(first, i);
    if (count > 0)
      found.push_back(fmt::format("the rung '{}' is not finite in {} pixels of {} images, the first is ({}, {})",
                                  rung.name, count, rung.tries.size(), first % width, first / width));
  }
  return found;
}

/// What the user's own image adds to the last rung before it, in shares of that: its units may be others than the path
/// tracer's.
std::string about_users_image(const LadderOptions& options, const LadderClimb& climb, const Region& whole) {
  const RungImage &ours = climb.rungs[climb.rungs.size() - 2], &users = climb.rungs.back();
  const double percent = 100.0 / mean(ours);
  const RungStep gap = rung_step(ours, users, whole.pixels);
  return fmt::format(
      "\n\nYour image differs from the cone-traced one of {} by {:+.3f} % of that one's mean, and {:.3f} % RMS: "
      "what no parameter explains.",
      options.goal ? options.goal->name : "the shipped settings in bytes", percent * gap.bias.mean,
      percent * gap.square.root());
}

std::string findings(const LadderOptions& options, const View& view, const LadderClimb& climb, const Region& whole,
                     const Table& closed) {
  const double percent = 100.0 / mean(climb.rungs.front());
  const RungStep shipped = rung_step(climb.rungs[0], climb.rungs[climb.shipped], whole.pixels);
  const std::string at = options.resolution == Settings().grid.resolution
                             ? fmt::format("The shipped settings, {} voxels,", options.resolution)
                             : fmt::format("The shipped settings at {} voxels, not their own {},", options.resolution,
                                           Settings().grid.resolution);
  return fmt::format(
      "All light (R,G,B) as luminance at the pixels' centres, {}x{} pixels, {} voxels. A rung differs from the one "
      "before in one thing alone; noise that two rungs share cancels. Error bars are standard errors over {} "
      "independent tries.\n\n"
      "{} are {:+.2f} +- {:.2f} % from the path tracer in the mean, and {:.2f} +- {:.2f} % RMS.\n\n"
      "Does the ladder close? Down to their storage in {} the rungs add up to {:+.2f} %; both ends rendered anew, "
      "paths with another seed, differ by {:+.2f} %: a gap of {:+.2f} +- {:.2f} %, which chance exceeds with "
      "probability "
      "{:.2g}.",
      view.width, view.height, options.resolution, options.tries, at, percent * shipped.bias.mean,
      percent * shipped.bias.error, percent * shipped.square.root(), percent * shipped.square.root_stderr(),
      storage_names[static_cast<size_t>(shipped_settings(options).storage)], closed.number(0, "sum"),
      closed.number(0, "ends"), closed.number(0, "gap"), closed.number(0, "gap_stderr"), closed.number(0, "p"));
}

}  // namespace

double mean(const RungImage& image) {
  double sum = 0.0;
  for (const auto& values : image.tries) sum += mean(values);
  return sum / double(image.tries.size());
}

RungStep rung_step(const RungImage& from, const RungImage& to, const std::vector<size_t>& pixels) {
  const size_t tries = std::max(from.tries.size(), to.tries.size());
  const auto value = [](const RungImage& image, size_t t, size_t i) {
    return image.tries[image.tries.size() == 1 ? 0 : t][i];
  };
  std::vector<double> biases(tries, 0.0), differences, variances, of_pixel(tries);
  for (const size_t i : pixels) {
    for (size_t t = 0; t < tries; ++t) {
      of_pixel[t] = value(to, t, i) - value(from, t, i);
      biases[t] += of_pixel[t] / double(pixels.size());
    }
    const Estimate difference = tries > 1 ? estimate(of_pixel) : Estimate{of_pixel[0]};
    differences.push_back(difference.mean);
    variances.push_back(difference.error * difference.error);
  }
  const Estimate bias = tries > 1 ? estimate(biases) : Estimate{biases[0]};
  return {bias, mean_square(differences, variances, bias.freedom)};
}

Section ladder_section(const StudyScene& scene, const LadderOptions& options, const std::optional<Image>& users,
                       const Progress& progress) {
  return timed_section(scene.name, [&](Section& section) {
    View view = sized(scene.view, options.width);
    if (users) {
      view.width = users->width();
      view.height = users->height();
    }
    LadderClimb climb = climb_ladder(scene, view, options, progress);
    section.warnings = climb.warnings;
    if (climb.rungs.size() == 1) {
      section.text =
          "Nothing in this image is lit: paths find no light, so that there is no mean that errors could be shares of.";
      return;
    }
    if (users) climb.rungs.push_back({"your image", {measured_cone(*users, false).value}});
    for (std::string& warning : find_nonfinite(climb, view)) section.warnings.push_back(std::move(warning));
    const std::vector<Region> regions = find_regions(scene, view, options, climb.direct);
    section.tables = {ladder_table(scene, climb, regions),
                      closure(scene, view, options, climb, regions, section.warnings, progress)};
    const std::string goal = options.goal ? options.goal->name : "the shipped settings";
    section.charts = ladder_charts(scene, climb, regions, users ? "your image" : goal);
    section.text = findings(options, view, climb, regions[0], section.tables.back());
    if (!scene.scene.lights.empty() && (scene.scene.has_emission() || view.background != glm::vec3(0.0f)))
      section.text +=
          "\n\nBounces are counted for the lamps, whose light voxels hold from the first. Light of what glows and of "
          "the "
          "surroundings has one more in the paths of the second rung than in the voxels: that one is part of the "
          "third.";
    if (users) section.text += about_users_image(options, climb, regions[0]);
  });
}

LadderOptions ladder_options(bool quick) {
  LadderOptions options;
  if (quick) {
    options.resolution = options.width = 64;
    options.tries = 4;
    options.spp = 16;
    options.marched_rays = 8;
    options.voxel_rays = 4;
    options.narrow_cones = 128;
  }
  return options;
}

StudyResult run_ladder(const StudyRequest& request) {
  LadderOptions options = ladder_options(request.quick);
  if (request.settings) {
    options.goal = {"your settings", *request.settings};
  } else {
    options.goal = {"the published shaders' settings", profile("villegas2016")};
    options.goal->settings.grid.resolution = options.resolution;
  }
  StudyResult result{"ladder", "how much of the error each approximation owns"};
  for (const StudyScene& scene : scenes_or_own(request, {cornell_point_scene()}, false, result.skipped))
    result.sections.push_back(ladder_section(scene, options, request.users_image, request.progress));
  return result;
}

}  // namespace voxref
