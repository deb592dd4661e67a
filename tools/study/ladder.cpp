// From the path tracer to the shipped settings, one approximation at a time: whose error is it?
#include "study/ladder.h"

#include <fmt/format.h>

#include "image/image_file.h"
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

}  // namespace

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
  return {tries > 1 ? estimate(biases) : Estimate{biases[0]}, mean_square(differences, variances)};
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
    LadderClimb climb = climb_ladder(scene, view, options, progress);
    if (!gpu_image.empty()) climb.rungs.push_back({"your image", {measured_cone(users, false).value}});
    const std::vector<Region> regions = find_regions(scene, view, options, climb.direct);
    section.tables = {ladder_table(scene, climb, regions), closure(scene, view, options, climb, regions, progress)};
    section.charts = ladder_charts(scene, climb, regions);
    const Table& closed = section.tables.back();
    const double percent = 100.0 / mean(climb.rungs.front());
    const Estimate shipped = rung_step(climb.rungs[0], climb.rungs[climb.shipped], regions[0].pixels).bias;
    section.text = fmt::format(
        "All light (R,G,B) as luminance at the pixels' centres, {}x{} pixels, {} voxels. A rung differs from the one "
        "before in one thing alone; noise that two rungs share cancels. Error bars are standard errors over {} "
        "independent tries; the rays between voxels are drawn once and shared by all tries.\n\n"
        "The image of the shipped settings is {:+.2f} +- {:.2f} % from the path-traced one.\n\n"
        "Does the ladder close? Down to storage in bytes the rungs add up to {:+.2f} %; both ends rendered anew, paths "
        "with another seed, differ by {:+.2f} %: a gap of {:+.2f} +- {:.2f} %, which chance exceeds with probability "
        "{:.2g}.",
        view.width, view.height, options.resolution, options.tries, percent * shipped.mean, percent * shipped.error,
        closed.number(0, "sum"), closed.number(0, "ends"), closed.number(0, "gap"), closed.number(0, "gap_stderr"),
        closed.number(0, "p"));
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
  StudyResult result{"ladder", "how much of the error each approximation owns"};
  for (const StudyScene& scene : scenes_or_own(request, {cornell_point_scene()}, false, result.skipped))
    result.sections.push_back(ladder_section(scene, options, request.gpu_image, request.progress));
  return result;
}

}  // namespace voxref
