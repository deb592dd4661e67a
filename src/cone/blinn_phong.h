#pragma once
#include <glm/vec3.hpp>

#include "scene/phong_material.h"

namespace voxref {

/// What the published shaders' Blinn-Phong does that a BRDF would not; each can be switched alone.
struct BlinnPhongOptions {
  bool divide_by_pi = true;     ///< Lambert's albedo / pi
  float albedo_power = 1.0f;    ///< exponent on Kd, which stands in for decoding it
  bool specular_twice = false;  ///< Ks multiplies the lobe, though its Fresnel term begins with it
};

/// Kd^power (/ pi) + (Ks) D F without the cosine: thesis eq. 1.11, 1.12 with P = 2^(11 s + 1), D = (n.h)^P (0.0397 P +
/// 0.3183), which are (P + 8) / (8 pi), F = Ks + (1 - Ks) (1 - l.h)^5. Cosines below 0 count as 0.
/// @param normal,out,in unit; out and in point away from the surface
glm::vec3 evaluate(const PhongMaterial& material, const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in,
                   const BlinnPhongOptions& options);

}  // namespace voxref
