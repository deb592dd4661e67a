// The ladder's rungs: the images between the path tracer and the shipped settings, and on to the goal's.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
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

// Texels. Against an eighth of it, light changes by 0.003 % RMS of its mean on the Cornell box at 64 voxels, by 0.03 %
// on Sponza at 256; half of it would leave 0.001 and 0.01 %.
constexpr float fine_step = 0.1f;

class Ladder {
 public:
  Ladder(const StudyScene& scene, const View& view, const LadderOptions& options, const Progress& progress)
      : scene_(scene.scene), view_(view), options_(options), progress_(progress), caster_(scene_) {
    shipped_.grid.resolution = options.resolution;
  }

  LadderClimb climb() {
    add_paths("path tracer", std::nullopt);
    if (mean(climb_.rungs.front()) == 0.0) return std::move(climb_);
    const SurfaceGrid surfaces =
        voxelize(scene_, fit_grid(scene_.bounds(), shipped_.grid), shipped_.voxelize, progress_);
    const LitVoxels lit = light_voxels(scene_, caster_, surfaces, view_.background, shipped_, nullptr, progress_);
    bounces_ = lit.bounces;
    if (lit.nonfinite.count > 0)
      climb_.warnings.push_back(fmt::format("{} voxels are not lit by a finite number", lit.nonfinite.count));
    const Image narrow = image_with_cones(options_.narrow_cones, lit);
    // Voxels hold lamps' light before the first bounce; what glows, and the surroundings, they only meet in gathering.
    add_paths(fmt::format("{} bounces", lit.bounces), lit.bounces + (scene_.lights.empty() ? 1 : 2));
    add_rays(surfaces, lit, narrow);
    add_cone_image(fmt::format("{} narrow cones", options_.narrow_cones), narrow);
    const int wide = shipped_.render.cone.diffuse;
    add_cone_image(fmt::format("{} wide cones", wide), image_with_cones(wide, lit));
    add_cone_image(fmt::format("step {:g}", shipped_.render.cone.step),
                   gather_image(scene_, caster_, view_, shipped_, lit, progress_).image.image);
    climb_.shipped = climb_.rungs.size() - 1;
    add_storages();
    climb_.first_parameter = climb_.rungs.size();
    if (options_.goal) add_parameters(options_.goal->settings);
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
      if (const std::string missing = missing_paths(result.nonfinite, result.first_nonfinite); !missing.empty())
        climb_.warnings.push_back(name + ": " + missing);
      rung.tries.push_back(measured_path(result.image, false).value);
      if (max_depth) continue;
      const auto direct = result.image.layer("direct");
      climb_.direct.resize(direct[0].size());
      for (size_t i = 0; i < direct[0].size(); ++i)
        climb_.direct[i] += double(luminance({direct[0][i], direct[1][i], direct[2][i]})) / options_.tries;
    }
    climb_.rungs.push_back(std::move(rung));
  }

  /// Light that is gathered, and what is not: direct light and emission, which all rungs from here on share.
  void add_gathered(const std::string& name, const Image& rest,
                    const std::function<std::vector<glm::vec3>(uint64_t seed)>& gather) {
    const auto direct = rest.layer("direct"), emission = rest.layer("emission");
    RungImage rung{name, {}};
    for (int t = 0; t < options_.tries; ++t) {
      std::vector<glm::vec3> light = gather(static_cast<uint64_t>(t + 1));
      std::vector<double>& values = rung.tries.emplace_back(light.size());
      for (size_t i = 0; i < light.size(); ++i) {
        for (int c = 0; c < 3; ++c) light[i][c] += direct[size_t(c)][i] + emission[size_t(c)][i];
        values[i] = double(luminance(light[i]));
      }
    }
    climb_.rungs.push_back(std::move(rung));
  }

  /// The rungs on which rays gather in place of cones. @param narrow whose specular cones the last of them has
  void add_rays(const SurfaceGrid& surfaces, const LitVoxels& lit, const Image& narrow) {
    const auto* medium = std::get_if<Medium>(&lit.volume);
    if (!medium) throw Error("cone.opacity", "the ladder's rays march through extinction");
    const ConeOptions& cone = shipped_.render.cone;
    const std::vector<SeenPoint> seen = see(scene_, caster_, view_, cone, lit.grid.voxel);
    const Shading shading = shade(scene_, &caster_, surfaces, shipped_.light, shipped_.shade, progress_);
    add_gathered("radiance of voxels", narrow, [&](uint64_t seed) {
      const BrickVolume<glm::vec4> bounced =
          voxel_volume(surfaces, bounce_by_rays(surfaces, shading.radiance, caster_, view_.background, lit.bounces,
                                                options_.voxel_rays, seed, progress_));
      return gather_rays(seen, view_, options_.spp, seed, VoxelRadiance(caster_, lit.grid, bounced, view_.background),
                         progress_);
    });
    add_gathered(fmt::format("{} cones at voxels", shipped_.bounce.cones), narrow, [&](uint64_t seed) {
      return gather_rays(seen, view_, options_.spp, seed,
                         VoxelRadiance(caster_, lit.grid, medium->texels.base, view_.background), progress_);
    });
    const IncomingRadiance through_voxels = [&](const GatherPoint& from, const glm::vec3& direction) {
      const float voxel = lit.grid.voxel;
      const glm::vec3 lift = apex_height(from.geometric_normal, cone) * from.geometric_normal + from.aside / voxel;
      return march(*medium, from.position + voxel * lift, direction, 0.0f, {from.geometric_normal, lift},
                   {fine_step, view_.background})
          .radiance;
    };
    add_gathered("rays march voxels", narrow, [&](uint64_t seed) {
      return gather_rays(seen, view_, options_.marched_rays, seed, through_voxels, progress_);
    });
    if (std::none_of(seen.begin(), seen.end(),
                     [](const SeenPoint& s) { return s.surface && s.shading.reflectance.has_specular(); }))
      return;
    const auto mirrored = narrow.layer("specular");
    const std::vector<SeenPoint> dull = without_specular(seen);
    add_gathered("one specular cone", narrow, [&](uint64_t seed) {
      std::vector<glm::vec3> light = gather_rays(dull, view_, options_.marched_rays, seed, through_voxels, progress_);
      for (size_t i = 0; i < light.size(); ++i)
        for (int c = 0; c < 3; ++c) light[i][c] += mirrored[size_t(c)][i];
      return light;
    });
  }

  void add_cone_image(const std::string& name, const Image& image) {
    climb_.rungs.push_back({name, {measured_cone(image, false).value}});
  }
  /// In short steps. The image alone has these cones; the voxels keep the shipped ones.
  Image image_with_cones(int cones, const LitVoxels& lit) const {
    Settings settings = shipped_;
    settings.render.cone.diffuse = cones;
    settings.render.cone.step = fine_step;
    return gather_image(scene_, caster_, view_, settings, lit, progress_).image.image;
  }

  /// The shipped settings in ever fewer bits, as GPUs hold them, down to the goal's.
  void add_storages() {
    ConeRunner runner(scene_, caster_, view_, progress_);
    Settings settings = shipped_;
    const Storage last = shipped_settings(options_).storage;
    for (const auto& [name, storage] : {std::pair{"float16", Storage::float16}, {"unorm8", Storage::unorm8}}) {
      if (settings.storage == last) break;
      settings.storage = storage;
      add_cone_image(std::string("storage ") + name, runner(settings).image.image);
    }
  }

  /// Every parameter that the goal sets otherwise, one by one, as `in_order` has them.
  void add_parameters(const Settings& goal) {
    ConeRunner runner(scene_, caster_, view_, progress_);
    Settings settings = shipped_settings(options_);
    for (const Parameter& parameter : in_order(goal)) {
      const nlohmann::json value = parameter.get(goal);
      if (value == parameter.get(settings)) continue;
      parameter.set(settings, value);
      add_cone_image(parameter.key + " = " + (value.is_string() ? value.get<std::string>() : value.dump()),
                     runner(settings).image.image);
    }
  }
  /// The table's order; but bounces, which take most of the time, go first where the goal has fewer.
  std::vector<Parameter> in_order(const Settings& goal) const {
    std::vector<Parameter> order = parameters();
    if (goal.bounce.count && *goal.bounce.count < bounces_)
      std::stable_partition(order.begin(), order.end(), [](const Parameter& p) { return p.key == "bounce.count"; });
    return order;
  }

  const Scene& scene_;
  View view_;
  const LadderOptions& options_;
  Progress progress_;
  Caster caster_;
  Settings shipped_;
  int bounces_ = 0;  // that the shipped settings make here
  LadderClimb climb_;
};

}  // namespace

LadderClimb climb_ladder(const StudyScene& scene, const View& view, const LadderOptions& options,
                         const Progress& progress) {
  return Ladder(scene, view, options, progress).climb();
}

Settings shipped_settings(const LadderOptions& options) {
  Settings settings;
  settings.grid.resolution = options.resolution;
  settings.storage = options.goal ? options.goal->settings.storage : Storage::unorm8;
  return settings;
}

size_t ladder_bytes_per_pixel(const LadderOptions& options) {
  // Rungs: up to six in tries, the others cone-traced once. Beside them the path tracer while it renders (sums and the
  // pass, 424 bytes), or what pixels see, also without specular lobes, and two cone-traced images.
  constexpr size_t noisy = 6, cone_rungs = 5, path = 424;
  // The user's image (four channels) and its rung, direct light, indices of three regions that a pixel may be in, and
  // the mean and noise of its difference.
  constexpr size_t users = 4 * sizeof(float) + sizeof(double), regions = 4 * sizeof(double) + 2 * sizeof(double);
  const size_t rungs = noisy * static_cast<size_t>(options.tries) + cone_rungs + parameters().size();
  return rungs * sizeof(double) + users + regions +
         std::max(path, 2 * sizeof(SeenPoint) + 2 * cone_image_bytes_per_pixel);
}

}  // namespace voxref
