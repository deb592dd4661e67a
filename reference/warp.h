#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace voxref {

// Maps of the unit square to where light goes. Directions are in a local frame whose z axis is the normal; each map's
// density is stated with it. All keep stratification: neighbouring inputs have neighbouring outputs.

/// Two unit vectors that complete `z` (unit) to a right-handed orthonormal frame: Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited".
struct Frame {
  explicit Frame(const glm::vec3& normal) : z(normal) {
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    x = {1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    y = {b, sign + normal.y * normal.y * a, -normal.y};
  }
  glm::vec3 to_world(const glm::vec3& local) const { return local.x * x + local.y * y + local.z * z; }
  glm::vec3 to_local(const glm::vec3& world) const {
    return {glm::dot(world, x), glm::dot(world, y), glm::dot(world, z)};
  }

  glm::vec3 x, y, z;
};

/// (cos, sin) of 2 pi `turns`, for turns in [0,1]; error below 1e-7. Taylor series of the angle to the nearest
/// quarter turn, at most pi / 4: the first terms left out are 2.5e-8 and 1.8e-9. No call, and
/// the same bits whatever the C library.
inline glm::vec2 cos_sin_of_turns(float turns) {
  // A conversion rounds down what is above 0, in one instruction.
  const int quarter = static_cast<int>(4.0f * turns + 0.5f);  // NOLINT(bugprone-incorrect-roundings)
  const float x = 2.0f * std::numbers::pi_v<float> * (turns - 0.25f * static_cast<float>(quarter));
  const float x2 = x * x;
  const float c = 1.0f + x2 * (-1.0f / 2 + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  const float s = x * (1.0f + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
  // A quarter turn takes (c, s) to (-s, c). Without branches, which would be guessed wrong half the time.
  const bool odd = (quarter & 1) != 0;
  return {static_cast<float>(1 - ((quarter + 1) & 2)) * (odd ? s : c),
          static_cast<float>(1 - (quarter & 2)) * (odd ? c : s)};
}

/// Hemisphere about +z with density cos / pi per solid angle (Malley: a uniform disk, lifted).
inline glm::vec3 cosine_hemisphere(const glm::vec2& u) {
  const float radius = std::sqrt(u.x);
  const glm::vec2 disk = radius * cos_sin_of_turns(u.y);
  return {disk.x, disk.y, std::sqrt(1.0f - u.x)};
}

/// Barycentric coordinates (u,v) of a uniform point of a triangle, as in Hit; density 1 / area.
inline glm::vec2 uniform_triangle(const glm::vec2& u) {
  const float root = std::sqrt(u.x);
  return {root * (1.0f - u.y), root * u.y};
}

/// A microfacet normal of the GGX distribution of width `alpha`, as often as `out` sees it; density per solid angle
/// G1(out) D(h) max(out.h, 0) / out.z. Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
/// @param out unit, z above 0
inline glm::vec3 visible_ggx_normal(const glm::vec3& out, float alpha, const glm::vec2& u) {
  // Stretched by alpha the facets become a hemisphere, whose reflections of `out` fill a spherical cap evenly.
  const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * out.x, alpha * out.y, out.z));
  const float z = (1.0f - u.y) * (1.0f + stretched.z) - stretched.z;
  const float radius = std::sqrt(std::max(1.0f - z * z, 0.0f));
  const glm::vec3 half = stretched + glm::vec3(radius * cos_sin_of_turns(u.x), z);
  return glm::normalize(glm::vec3(alpha * half.x, alpha * half.y, std::max(half.z, 0.0f)));
}

}  // namespace voxref
