#include "cone/bounce.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

#include "cone/raw_bounce.h"
#include "error.h"
#include "image/image.h"
#include "parallel.h"

namespace voxref {
namespace {

constexpr int most_bounces = 1000;         // an albedo of 0.99 needs 460 to come within 1 %
constexpr double negligible_share = 0.01;  // of the total: what one more bounce may leave out
constexpr int usual_bounces = 6;           // until the first tells more: an albedo of about a half
constexpr size_t grain = 256;              // voxels per task, some milliseconds

/// What a bounce gathers from: radiometric cones at the centroid.
template <class Texel>
class MediumGather {
 public:
  MediumGather(const SurfaceGrid& surfaces, BasicMedium<Texel>&& medium, const BounceOptions& options,
               const ConeOptions& cone, const glm::vec3& background)
      : surfaces_(surfaces),
        medium_(std::move(medium)),
        cones_(voxel_cones(options.cones)),
        cone_(cone),
        background_(background) {}

  /// Albedo/pi x irradiance at voxel i.
  glm::vec3 reflected(size_t i) const {
    return glm::vec3(surfaces_.albedo[i]) * irradiance(i) / std::numbers::pi_v<float>;
  }

 private:
  glm::vec3 irradiance(size_t i) const {
    const auto gather = [&](const glm::vec3& n) {
      return gather_diffuse(medium_, cones_, {surfaces_.centroid[i], n, n}, cone_, AoOptions{}, background_).irradiance;
    };
    const float length = glm::length(surfaces_.normal[i]);
    if (length >= two_sided_length) return gather(surfaces_.normal[i] / length);
    const glm::vec3 n = length > 0.0f ? surfaces_.normal[i] / length : glm::vec3(0.0f, 1.0f, 0.0f);
    return 0.5f * (gather(n) + gather(-n));
  }

  const SurfaceGrid& surfaces_;
  BasicMedium<Texel> medium_;
  ConeSet cones_;
  const ConeOptions& cone_;
  glm::vec3 background_;
};

/// The published shaders' cones at the voxel's corner, without the 1/pi.
template <class Texel>
class RawGather {
 public:
  RawGather(const SurfaceGrid& surfaces, BasicRawVolume<Texel>&& volume, const BounceOptions& options)
      : surfaces_(surfaces), volume_(std::move(volume)), gatherer_(volume_, options.max_distance) {}

  /// Albedo x irradiance at voxel i.
  glm::vec3 reflected(size_t i) const {
    const glm::vec4& albedo = surfaces_.albedo[i];
    const glm::vec3& normal = surfaces_.normal[i];
    if (albedo.a == 0.0f || normal == glm::vec3(0.0f)) return glm::vec3(0.0f);
    return glm::vec3(albedo) * gatherer_.irradiance(surfaces_.voxels[i], glm::normalize(normal));
  }

 private:
  const SurfaceGrid& surfaces_;
  BasicRawVolume<Texel> volume_;
  RawVoxelGatherer<Texel> gatherer_;
};

struct Sums {
  double total = 0.0;   ///< luminance of the new radiance over all voxels
  double change = 0.0;  ///< of what it has more than the old one
  Clamping clamped;
};

/// How far the bounces are, as one fraction. Each bounce takes an equal share of what is left by the estimate of its
/// time: the estimate may change, the fraction never falls.
class BounceProgress {
 public:
  explicit BounceProgress(const Progress& progress) : progress_(progress) {}

  /// @param left how many there will be, this one included
  void begin(int left) {
    begin_ += share_;
    share_ = (1.0 - begin_) / left;
  }
  void operator()(double fraction_of_this) const { progress_("bounce", begin_ + share_ * fraction_of_this); }
  void check() const { progress_.check(); }

 private:
  const Progress& progress_;
  double begin_ = 0.0, share_ = 0.0;
};

/// How many further bounces bring the addition, which shrinks by the factor `gain` each time, down to a negligible one.
int bounces_left(const Sums& sums, double gain) {
  if (!(gain > 0.0) || gain >= 1.0) return 1;
  const double left = std::ceil(std::log(negligible_share * sums.total / sums.change) / std::log(gain));
  return static_cast<int>(std::clamp(left, 1.0, double(most_bounces)));
}

/// One bounce: replaces `radiance` by direct + what is reflected of what `gather` sees.
template <class Texel, class Gather>
Sums gather_bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct, const Gather& gather,
                   std::vector<glm::vec3>& radiance, const BounceProgress& progress) {
  std::vector<Sums> partial((surfaces.size() + grain - 1) / grain);  // merged by index: the same bits for any threads
  std::atomic<size_t> done{0};
  parallel_for(surfaces.size(), grain, [&](size_t begin, size_t end) {
    progress.check();
    Sums& sums = partial[begin / grain];
    for (size_t i = begin; i < end; ++i) {
      const glm::vec3 old = radiance[i];
      radiance[i] = sums.clamped.store<Texel>(direct[i] + gather.reflected(i));
      sums.total += luminance(radiance[i]);
      sums.change += double(luminance(radiance[i])) - luminance(old);
    }
    progress(double(done += end - begin) / double(surfaces.size()));
  });
  Sums sums;
  for (const Sums& p : partial) {
    sums.total += p.total;
    sums.change += p.change;
    sums.clamped += p.clamped;
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

template <class Texel>
BasicBounceResult<Texel> bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct,
                                BasicPyramid<Texel>&& filtered, const BounceOptions& options, const ConeOptions& cone,
                                const MipmapOptions& mipmap_options, const glm::vec3& background,
                                const Progress& progress) {
  BasicBounceResult<Texel> result;
  result.radiance.assign(direct.begin(), direct.end());
  result.pyramid = std::move(filtered);
  // Each bounce takes over the pyramid's memory and frees it before the next is made: only one is held at a time.
  const auto gather = [&](const BounceProgress& so_far) {
    if (options.cones == published_cones)
      return gather_bounce<Texel>(surfaces, direct,
                                  RawGather(surfaces, BasicRawVolume(std::move(result.pyramid)), options),
                                  result.radiance, so_far);
    BasicMedium<Texel> medium = make_medium(std::move(result.pyramid), mipmap_options.filter);
    result.depth_bytes = medium.depth_bytes;
    return gather_bounce<Texel>(surfaces, direct, MediumGather(surfaces, std::move(medium), options, cone, background),
                                result.radiance, so_far);
  };
  // Bytes cannot hold more than 1, and the published cones clamp what arrives: then light does not grow for ever.
  const bool bounded = std::is_same_v<Texel, Rgba8> || options.cones == published_cones;
  BounceProgress so_far(progress);
  const Progress silent{{}, progress.cancel};  // filtering is a part of the bounce
  double previous = 0.0;
  int left = options.count.value_or(usual_bounces);
  for (const int most = options.count.value_or(most_bounces); result.bounces < most;) {
    so_far.begin(left);
    const Sums sums = gather(so_far);
    result.pyramid = mipmap<Texel>(surfaces, result.radiance, mipmap_options, silent);
    result.clamped = sums.clamped;
    ++result.bounces;

    if (!std::isfinite(sums.total))
      throw Error("bounce.count", "light is not finite after bounce " + std::to_string(result.bounces) +
                                      "; is a light too bright or too close to a surface?");
    if (previous > 0.0) result.gain = sums.change / previous;
    if (result.gain >= 1.0 && !bounded)
      throw Error("bounce.count", "light grows from bounce to bounce (loop gain " + std::to_string(result.gain) +
                                      " after " + std::to_string(result.bounces) +
                                      " bounces), so that there is no limit to gather; is an albedo 1?");
    if (!options.count && sums.change <= negligible_share * sums.total) break;
    // After the first bounce, what it added to the direct light stands in for the gain.
    const double gain = previous > 0.0 ? result.gain : sums.change / (sums.total - sums.change);
    left = options.count ? *options.count - result.bounces : bounces_left(sums, gain);
    previous = sums.change;
  }
  progress("bounce", 1.0);
  return result;
}

template BounceResult bounce(const SurfaceGrid&, std::span<const glm::vec3>, Pyramid&&, const BounceOptions&,
                             const ConeOptions&, const MipmapOptions&, const glm::vec3&, const Progress&);
template BasicBounceResult<Rgba16f> bounce(const SurfaceGrid&, std::span<const glm::vec3>, Pyramid16&&,
                                           const BounceOptions&, const ConeOptions&, const MipmapOptions&,
                                           const glm::vec3&, const Progress&);
template BasicBounceResult<Rgba8> bounce(const SurfaceGrid&, std::span<const glm::vec3>, Pyramid8&&,
                                         const BounceOptions&, const ConeOptions&, const MipmapOptions&,
                                         const glm::vec3&, const Progress&);

}  // namespace voxref
