#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reference/integrator.h"

namespace voxref {

/// Layers that cost rays of their own, on request.
struct ExtraLayers {
  int bounces = 0;          ///< bounce.1 ... bounce.N: the indirect light by its number of bounces, W/(sr m^2)
  bool irradiance = false;  ///< what arrives at the first hit, on the shading normal's side, W/m^2

  size_t count() const { return static_cast<size_t>(bounces) + (irradiance ? 1 : 0); }
  std::vector<std::string> names() const;  ///< count() of them; irradiance is the last
};

/// Estimates them along with a path, from the same random numbers; the path itself stays as it is without them.
///
/// A path with the same random numbers that is cut one bounce later only has more of them: bounce.k is the difference
/// of the indirect light of two paths, cut after k and k - 1 bounces. Irradiance is pi times what the surface would
/// scatter if it were white and Lambertian, whose BSDF is 1 / pi.
class ExtraTracer {
 public:
  ExtraTracer(const Scene& scene, const Surfaces& surfaces, const Caster& caster, const glm::vec3& background,
              const Transport& transport, const ExtraLayers& layers);

  size_t count() const { return layers_.count(); }
  /// Adds one sample to `sums`, count() of them.
  /// @param sampler the one of the path @param counts its rays are added to
  void trace(const std::optional<PathVertex>& seen, const Sampler& sampler, std::span<glm::dvec3> sums,
             PathCounts& counts) const;

 private:
  ExtraLayers layers_;
  std::vector<Integrator> cut_;        // after 1, 2, ... bounces
  std::optional<Integrator> onwards_;  // where irradiance is asked for
};

}  // namespace voxref
