// The ladder's rungs: the images between the path tracer and the shipped settings, and on to the published ones.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "error.h"
#include "parallel.h"
#include "settings_table.h"
#include "study/cone_runner.h"
#include "study/ladder.h"
#include "study/ray_gather.h"
#include "study/truth.h"

namespace voxref {

namespace {

constexpr float fine_step = 0.1f;  // texels: no shorter one changes what is gathered
constexpr Storage published_storage = Storage::unorm8;

class Ladder {
 public:
  Ladder(const StudyScene& scene, const View& view, const LadderOptions& options, const Progress& progress)
      : scene_(scene.scene), view_(view), options_(options), progress_(progress), caster_(scene_) {
    shipped_.grid.resolution = options.resolution;
  }

  LadderClimb climb() {
    const SurfaceGrid surfaces =
        voxelize(scene_, fit_grid(scene_.bounds(), shipped_.grid), shipped_.voxelize, progress_);
    const LitVoxels lit = light_voxels(scene_, caster_, surfaces, view_.background, shipped_, nullptr, progress_);
    const ConeTraceResult shipped = gather_image(scene_, caster_, view_, shipped_, lit, progress_);
    add_paths("path tracer", std::nullopt);
    add_paths(fmt::format("{} bounces", lit.bounces), lit.bounces + 2);
    add_rays(surfaces, lit, shipped.image.image);
    add_cones(fmt::format("{} narrow cones", options_.narrow_cones), options_.narrow_cones, fine_step, lit);
    add_cones(fmt::format("{} wide cones", shipped_.render.cone.diffuse), shipped_.render.cone.diffuse, fine_step, lit);
    add_cone_image(fmt::format("step {:g}", shipped_.render.cone.step), shipped.image.image);
    climb_.shipped = climb_.rungs.size() - 1;
    add_storages();
    climb_.first_published = climb_.rungs.size();
    if (options_.published) add_published();
    return std::move(climb_);
  }

 private:
  void add_paths(const std::string& name, const std::optional<int>& max_depth) {
    RungImage rung{name, {}};
    for (int t = 0; t < options_.tries; ++t) {
      PathOptions path;
      path.spp = options_.spp;
      path.randomizations = 1;
      path.max_depth = max_depth;
      path.seed = static_cast<uint64_t>(t + 1);  // the same for all rungs: what they share cancels
      const PathResult result = trace_paths(scene_, caster_, view_, path, progress_);
      rung.tries.push_back(measured_path(result.image, false).value);
      if (max_depth) continue;
      const auto direct = result.image.layer("direct");
      climb_.direct.resize(direct[0].size());
      for (size_t i = 0; i < direct[0].size(); ++i)
        climb_.direct[i] += double(luminance({direct[0][i], direct[1][i], direct[2][i]})) / options_.tries;
    }
    climb_.rungs.push_back(std::move(rung));
  }

  /// The three rungs on which rays gather in place of cones.
  void add_rays(const SurfaceGrid& surfaces, const LitVoxels& lit, const Image& shipped) {
    const auto* medium = std::get_if<Medium>(&lit.volume);
    if (!medium) throw Error("cone.opacity", "the ladder's rays march through extinction");
    const ConeOptions& cone = shipped_.render.cone;
    const std::vector<SeenPoint> seen = see(scene_, caster_, view_, cone, lit.grid.voxel);
    // What is not gathered: direct light and emission.
    std::vector<glm::vec3> rest(seen.size());
    const auto direct = shipped.layer("direct"), emission = shipped.layer("emission");
    for (size_t i = 0; i < rest.size(); ++i)
      for (int c = 0; c < 3; ++c) rest[i][c] = direct[size_t(c)][i] + emission[size_t(c)][i];
    const auto add = [&](const std::string& name, int rays, const IncomingRadiance& incoming) {
      RungImage rung{name, {}};
      for (int t = 0; t < options_.tries; ++t) {
        const auto gathered = gather_rays(seen, view_, rays, uint64_t(t + 1), incoming, progress_);
        std::vector<double>& values = rung.tries.emplace_back(seen.size());
        for (size_t i = 0; i < seen.size(); ++i) values[i] = double(luminance(rest[i] + gathered[i]));
      }
      climb_.rungs.push_back(std::move(rung));
    };

    const Shading shading = shade(scene_, &caster_, surfaces, shipped_.light, shipped_.shade, progress_);
    const std::vector<glm::vec3> bounced = bounce_by_rays(surfaces, shading.radiance, caster_, view_.background,
                                                          lit.bounces, options_.voxel_rays, progress_);
    const Pyramid by_rays = mipmap(surfaces, bounced, shipped_.mipmap, progress_);
    add("radiance of voxels", options_.spp, VoxelRadiance(caster_, lit.grid, by_rays.base, view_.background));
    add(fmt::format("{} cones at voxels", shipped_.bounce.cones), options_.spp,
        VoxelRadiance(caster_, lit.grid, medium->texels.base, view_.background));
    add("rays march voxels", options_.marched_rays, [&](const GatherPoint& from, const glm::vec3& direction) {
      const float voxel = lit.grid.voxel;
      const glm::vec3 lift = apex_height(from.geometric_normal, cone) * from.geometric_normal + from.aside / voxel;
      return march(*medium, from.position + voxel * lift, direction, 0.0f, {from.geometric_normal, lift},
                   {fine_step, view_.background})
          .radiance;
    });
  }

  void add_cone_image(const std::string& name, const Image& image) {
    climb_.rungs.push_back({name, {measured_cone(image, false).value}});
  }
  /// The image alone has these cones; the voxels keep the shipped ones.
  void add_cones(const std::string& name, int cones, float step, const LitVoxels& lit) {
    Settings settings = shipped_;
    settings.render.cone.diffuse = cones;
    settings.render.cone.step = step;
    add_cone_image(name, gather_image(scene_, caster_, view_, settings, lit, progress_).image.image);
  }

  /// The shipped settings in ever fewer bits, as GPUs hold them.
  void add_storages() {
    ConeRunner runner(scene_, caster_, view_, progress_);
    Settings settings = shipped_;
    for (const auto& [name, storage] : {std::pair{"float16", Storage::float16}, {"unorm8", published_storage}}) {
      settings.storage = storage;
      add_cone_image(std::string("storage ") + name, runner(settings).image.image);
    }
  }

  /// Every parameter that the published profile sets otherwise, in the table's order, one by one.
  void add_published() {
    ConeRunner runner(scene_, caster_, view_, progress_);
    const Settings published = profile("villegas2016");
    Settings settings = shipped_;
    settings.storage = published_storage;
    for (const Parameter& parameter : parameters()) {
      const nlohmann::json value = parameter.get(published);
      if (parameter.key == "grid.resolution" || value == parameter.get(settings)) continue;
      parameter.set(settings, value);
      add_cone_image(parameter.key + " = " + (value.is_string() ? value.get<std::string>() : value.dump()),
                     runner(settings).image.image);
    }
  }

  const Scene& scene_;
  View view_;
  const LadderOptions& options_;
  Progress progress_;
  Caster caster_;
  Settings shipped_;
  LadderClimb climb_;
};

}  // namespace

LadderClimb climb_ladder(const StudyScene& scene, const View& view, const LadderOptions& options,
                         const Progress& progress) {
  return Ladder(scene, view, options, progress).climb();
}

Table closure(const StudyScene& scene, const View& view, const LadderOptions& options, const LadderClimb& climb,
              const std::vector<Region>& regions, const Progress& progress) {
  const Caster caster(scene.scene);
  PathOptions path;
  path.spp = options.spp * options.tries;
  path.seed = static_cast<uint64_t>(options.tries + 1);  // the rungs have those before
  const PathResult traced = trace_paths(scene.scene, caster, view, path, progress);
  Settings settings;
  settings.grid.resolution = options.resolution;
  settings.storage = published_storage;
  const Measured truth = measured_path(traced.image, false),
                 cone = measured_cone(cone_trace(scene.scene, caster, view, settings, {}, progress).image.image, false);

  Table table{"ladder_" + scene.name + "_closure",
              "The sum of the rungs up to the published ones, against their ends rendered anew, in percent of the "
              "path-traced mean of the whole image",
              {{"region", ""}, {"sum", "%"}, {"ends", "%"}, {"gap", "%"}, {"gap_stderr", "%"}, {"p", ""}}};
  const double percent = 100.0 / truth.mean();
  for (const Region& region : regions) {
    double sum = 0.0, ends = 0.0, variance = 0.0;
    for (size_t r = 1; r < climb.first_published; ++r)
      sum += rung_step(climb.rungs[r - 1], climb.rungs[r], region.pixels).bias.mean;
    const auto count = double(region.pixels.size());
    for (const size_t i : region.pixels) {
      ends += (cone.value[i] - truth.value[i]) / count;
      variance += truth.standard_error[i] * truth.standard_error[i] / (count * count);
    }
    const Estimate total = rung_step(climb.rungs[0], climb.rungs[climb.first_published - 1], region.pixels).bias;
    const Welch gap({sum, total.error, total.freedom}, {ends, std::sqrt(variance), path.randomizations - 1.0});
    table.add({region.name, percent * sum, percent * ends, percent * gap.difference, percent * gap.error, gap.p()});
  }
  return table;
}

}  // namespace voxref
