#include "reference/bsdf.h"

#include <algorithm>
#include <cmath>

#include "image/image.h"

namespace voxref {

float specular_share_of(const Reflectance& reflectance, float n_out) {
  // Where both lobes are there each gets at least a tenth of the samples: the albedos are those of the whole
  // hemisphere, and what a lobe gives in one direction may be far more than its share.
  constexpr float least_share = 0.1f;
  if (!reflectance.has_diffuse()) return 1.0f;
  const float specular = luminance(specular_albedo(reflectance, n_out));
  const float diffuse = luminance(diffuse_albedo(reflectance, n_out));
  const float share = specular / (specular + diffuse);
  return std::isfinite(share) ? std::clamp(share, least_share, 1.0f - least_share) : 0.5f;
}

}  // namespace voxref
