#include "cone/bounce.h"

#include <atomic>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "error.h"
#include "image/image.h"
#include "parallel.h"

namespace voxref {
namespace {

constexpr int most_bounces = 1000;         // an albedo of 0.99 needs 460 to come within 1 %
constexpr double negligible_share = 0.01;  // of the total: what one more bounce may leave out
constexpr size_t grain = 256;              // voxels per task, some milliseconds

/// Irradiance at one voxel from the radiance in `medium`.
glm::vec3 voxel_irradiance(const SurfaceGrid& surfaces, size_t i, const Medium& medium, const std::vector<Cone>& cones,
                           const ConeOptions& options, const glm::vec3& background) {
  const auto gather = [&](const glm::vec3& n) {
    return gather_diffuse(medium, cones, {surfaces.centroid[i], n, n}, options, AoOptions{}, background).irradiance;
  };
  const float length = glm::length(surfaces.normal[i]);
  if (length >= two_sided_length) return gather(surfaces.normal[i] / length);
  const glm::vec3 n = length > 0.0f ? surfaces.normal[i] / length : glm::vec3(0.0f, 1.0f, 0.0f);
  return 0.5f * (gather(n) + gather(-n));
}

struct Sums {
  double total = 0.0;   ///< luminance of the new radiance over all voxels
  double change = 0.0;  ///< of what it has more than the old one
};

/// One bounce: replaces `radiance` by direct + albedo/pi E(medium).
Sums gather_bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct, const Medium& medium,
                   const std::vector<Cone>& cones, const ConeOptions& options, const glm::vec3& background,
                   std::vector<glm::vec3>& radiance, const Progress& progress) {
  std::vector<Sums> partial((surfaces.size() + grain - 1) / grain);  // merged by index: the same bits for any threads
  std::atomic<size_t> done{0};
  parallel_for(surfaces.size(), grain, [&](size_t begin, size_t end) {
    progress.check();
    Sums& sums = partial[begin / grain];
    for (size_t i = begin; i < end; ++i) {
      const glm::vec3 irradiance = voxel_irradiance(surfaces, i, medium, cones, options, background);
      const glm::vec3 old = radiance[i];
      radiance[i] = direct[i] + glm::vec3(surfaces.albedo[i]) * irradiance / std::numbers::pi_v<float>;
      sums.total += luminance(radiance[i]);
      sums.change += double(luminance(radiance[i])) - luminance(old);
    }
    progress("bounce", double(done += end - begin) / double(surfaces.size()));
  });
  Sums sums;
  for (const Sums& p : partial) {
    sums.total += p.total;
    sums.change += p.change;
  }
  return sums;
}

}  // namespace

BounceResult bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct, const BounceOptions& options,
                    const ConeOptions& cone, const MipmapOptions& mipmap_options, const glm::vec3& background,
                    const Progress& progress) {
  return bounce(surfaces, direct, mipmap(surfaces, direct, mipmap_options, progress), options, cone, mipmap_options,
                background, progress);
}

BounceResult bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct, Pyramid&& filtered,
                    const BounceOptions& options, const ConeOptions& cone, const MipmapOptions& mipmap_options,
                    const glm::vec3& background, const Progress& progress) {
  const std::vector<Cone> cones = partition_hemisphere(options.cones);
  BounceResult result;
  result.radiance.assign(direct.begin(), direct.end());
  result.pyramid = std::move(filtered);

  double previous = 0.0;
  for (const int most = options.count.value_or(most_bounces); result.bounces < most;) {
    Medium medium = make_medium(std::move(result.pyramid));
    const Sums sums = gather_bounce(surfaces, direct, medium, cones, cone, background, result.radiance, progress);
    medium = {};  // before the next pyramid is made: only one is held at a time
    result.pyramid = mipmap(surfaces, result.radiance, mipmap_options, progress);
    ++result.bounces;

    if (previous > 0.0) result.gain = sums.change / previous;
    if (result.gain >= 1.0)
      throw Error("bounce.count", "light grows from bounce to bounce (loop gain " + std::to_string(result.gain) +
                                      " after " + std::to_string(result.bounces) +
                                      " bounces), so that there is no limit to gather; is an albedo 1?");
    if (!options.count && sums.change <= negligible_share * sums.total) break;
    previous = sums.change;
  }
  return result;
}

}  // namespace voxref
