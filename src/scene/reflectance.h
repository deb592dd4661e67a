#pragma once
#include <glm/vec3.hpp>

namespace voxref {

/// How a surface point scatters light, textures looked up: glTF 2.0 appendix B, KHR_materials_specular and
/// KHR_materials_pbrSpecularGlossiness brought to one form. With s = (1 - |v.h|)^5 (Schlick 1994), D the GGX
/// distribution and V the height-correlated Smith visibility (Heitz 2014) of width alpha:
///
///   f = diffuse / pi x (1 - (layer_f0 + layer_f1 s)) + D V (specular_f0 + specular_f1 s)
struct Reflectance {
  glm::vec3 diffuse{0.0f};      ///< albedo of the Lambertian base, before what the layer over it reflects is taken off
  float layer_f0 = 0.0f;        ///< share that the dielectric layer takes from the base at normal incidence ...
  float layer_f1 = 0.0f;        ///< ... and what is added at grazing
  glm::vec3 specular_f0{0.0f};  ///< Fresnel reflectance of the lobe at normal incidence ...
  glm::vec3 specular_f1{0.0f};  ///< ... and what is added at grazing
  float alpha = 1.0f;           ///< GGX width: perceptual roughness squared, at least min_alpha

  /// Below this width (perceptual roughness 0.03) float32 no longer resolves the lobe; a smoother material is rendered
  /// as if it had it.
  static constexpr float min_alpha = 0.001f;

  bool has_diffuse() const { return diffuse != glm::vec3(0.0f); }
  bool has_specular() const { return specular_f0 != glm::vec3(0.0f) || specular_f1 != glm::vec3(0.0f); }
  bool black() const { return !has_diffuse() && !has_specular(); }
};

/// The BSDF, 1/sr, without the cosine. Zero unless both directions lie on the side of `normal`.
/// @param normal,out,in unit; out and in point away from the surface
glm::vec3 evaluate(const Reflectance& reflectance, const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in);

/// GGX distribution of normals, D, Walter et al. 2007 eq. 33. @param normal,half unit, on the same side
float ggx_distribution(const glm::vec3& normal, const glm::vec3& half, float alpha);
/// Height-correlated Smith masking-shadowing over 4 (n.l)(n.v): Heitz 2014 eq. 99. @param n_l,n_v in (0,1]
float ggx_visibility(float n_l, float n_v, float alpha);

/// Directional albedo of the specular lobe: the share of the light from a direction of cosine `n_v` that it scatters
/// (or, by reciprocity, of uniform light that it sends there), per channel. Numerical integration, tabulated once;
/// error below 0.002. @param n_v in [0,1]
glm::vec3 specular_albedo(const Reflectance& reflectance, float n_v);
/// The same of the diffuse base, less what the layer over it reflects.
glm::vec3 diffuse_albedo(const Reflectance& reflectance, float n_v);
/// Adds to the specular lobe, as seen from a direction of cosine `n_v`, what microfacets throw at each other
/// and single scattering loses: Turquin 2019, "Practical multiple scattering compensation for microfacet models",
/// f = f_single (1 + f0 (1 - E) / E) with the lobe's directional albedo E at reflectance 1. Exact for a lobe that
/// absorbs nothing; not reciprocal, since E is that of the viewer alone. @param n_v in [0,1]
void compensate_energy(Reflectance& reflectance, float n_v);
/// The specular lobe's and the diffuse base's albedo together, averaged over the cosine-weighted hemisphere: what a
/// voxel keeps, which forgets where light goes.
glm::vec3 hemispherical_albedo(const Reflectance& reflectance);

}  // namespace voxref
