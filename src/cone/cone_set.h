#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace voxref {

struct Cone {
  glm::vec3 direction{0.0f, 0.0f, 1.0f};  ///< unit, in a frame whose z is the normal
  float weight = 0.0f;                    ///< cosine integral over the cone's cell, sr; a set sums to pi
  float tan_half_angle = 0.0f;            ///< of the circular cone with the cell's solid angle, at most tan 60 degrees
  float texel = 1.0f;                     ///< side of the texels that it samples over its own diameter, in (0, 1]
};

/// In place of a count of cones: the directions and weights that the published shaders use, four at voxels and six at
/// pixels.
inline constexpr int published_cones = 0;
inline constexpr int most_cones = 16384;  ///< over a hemisphere

/// Cones that partition the hemisphere into cells of equal solid angle: a polar cap and rings around it, ring counts
/// chosen so that cells are about as wide as high (after Beckers and Beckers 2012); two and three cones are sectors. A
/// cone points along its cell's cosine-weighted mean direction. @param count 1 to most_cones @throws Error out of range
std::vector<Cone> partition_hemisphere(int count);

/// How well circular cones stand in for their cells, as fractions of the hemisphere's solid angle, by quadrature.
struct Coverage {
  double covered = 0.0;  ///< inside at least one cone
  double overlap = 0.0;  ///< inside two or more
};
Coverage coverage(const std::vector<Cone>& cones);

/// Right-handed orthonormal frame around unit `normal`: columns tangent, bitangent, normal. Duff et al. 2017.
glm::mat3 frame_around(const glm::vec3& normal);

/// Six cones of 30 degrees half-angle that the published shaders gather with at pixels, and four of 26.6 degrees at
/// voxels; in guided_frame. Weights sum to pi (spec sections 5 and 6).
std::vector<Cone> villegas6_cones();
std::vector<Cone> villegas4_cones();

/// The published shaders' frame around unit `normal`: columns R, U = R x n, n, where R is +Y without its part along n,
/// or +Z where |n.y| is exactly 1. Left-handed.
glm::mat3 guided_frame(const glm::vec3& normal);

/// Cones, and how they are turned around a normal.
struct ConeSet {
  std::vector<Cone> cones;
  glm::mat3 (*frame)(const glm::vec3& normal) = frame_around;
};
/// @param count partition_hemisphere's, or published_cones: the six, the four
ConeSet pixel_cones(int count);
ConeSet voxel_cones(int count);

/// Tangent of the half-angle of the cone that a GGX lobe of width alpha is gathered with, at normal incidence: a
/// uniform cone with the same mean direction length as the lobe (Toksvig 2005 turned round). @param alpha in [0,1];
/// below Reflectance::min_alpha as there
float specular_tan_half_angle(float alpha);

/// The published shaders' choice: tan(90 degrees x (1 - s)), at least 1 degree, at most 72. @param glossiness s in
/// [0,1]
float published_specular_tan_half_angle(float glossiness);

}  // namespace voxref
