#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "closed_form/polygon.h"
#include "parallel.h"
#include "scene/scene.h"

// A second solution of diffuse global illumination, for tests: deterministic, in float64, without rays that are drawn
// at random, without Embree and without the reflectance code. Of the product it uses Scene and parallel_for.
namespace voxref {

using Corners = std::array<glm::dvec3, 3>;

/// Where the ray meets the triangle, in multiples of `direction`; infinity where it does not. Moeller, Trumbore 1997.
inline double intersect(const Corners& t, const glm::dvec3& origin, const glm::dvec3& direction) {
  constexpr double miss = std::numeric_limits<double>::infinity();
  const glm::dvec3 u = t[1] - t[0], v = t[2] - t[0], p = glm::cross(direction, v);
  const double determinant = glm::dot(u, p);
  if (determinant == 0.0) return miss;
  const glm::dvec3 from = origin - t[0], q = glm::cross(from, u);
  const double a = glm::dot(from, p) / determinant, b = glm::dot(direction, q) / determinant;
  return a < 0.0 || b < 0.0 || a + b > 1.0 ? miss : glm::dot(v, q) / determinant;
}

/// Diffuse radiosity with constant elements, collocated at their centres (thesis 1.5.2.1; Goral et al. 1984):
///
///   B_i = rho_i (D_i + sum_j F_ij B_j),
///
/// F_ij by Lambert's formula from the centre of i to the part of j above its horizon, seen or not seen along one ray; D
/// the direct light, likewise, of lamps cut finer. Solved by Gauss-Seidel sweeps.
class Radiosity {
 public:
  /// @param scene Lambertian, without textures; materials' backs are never seen
  /// @param occluders names of the objects that may come between two points
  /// @param refinement each scene triangle, halved until no edge is above 0.3, is cut in 4^refinement
  Radiosity(const Scene& scene, const std::vector<std::string>& occluders, int refinement) {
    for (const Object& object : scene.objects)
      for (uint32_t i = 0; i < object.triangle_count; ++i) {
        const uint32_t triangle = object.first_triangle + i;
        const glm::uvec3 c = scene.triangles[triangle];
        const Corners corners = {scene.positions[c.x], scene.positions[c.y], scene.positions[c.z]};
        const Material& material = scene.materials[scene.triangle_materials[triangle]];
        surfaces_.push_back({corners, normal_of(corners), glm::dvec3(material.base_color), glm::dvec3(0.0)});
        for (const std::string& name : occluders)
          if (name == object.name) occluders_.push_back(corners);
        cut(surfaces_.back(), refinement, elements_);
        if (!material.emissive()) continue;
        Element lamp = surfaces_.back();
        lamp.radiosity = std::numbers::pi * glm::dvec3(material.emission);
        cut(lamp, lamp_refinement, lamps_);
      }
    solve();
  }

  size_t size() const { return elements_.size(); }

  /// Radiance that the surface seen along a ray reflects, its own emission left out; none where there is no surface, or
  /// where the next that faces it is nearer than `clearance`: there the elements look coarse.
  std::optional<glm::dvec3> radiance(const glm::dvec3& origin, const glm::dvec3& direction, double clearance) const {
    double nearest = std::numeric_limits<double>::infinity();
    const Element* seen = nullptr;
    for (const Element& surface : surfaces_) {
      const double t = intersect(surface.corners, origin, direction);
      if (t > 0.0 && t < nearest) {
        nearest = t;
        seen = &surface;
      }
    }
    if (!seen) return std::nullopt;
    const glm::dvec3 point = origin + nearest * direction;
    for (const Element& element : elements_)
      if (std::abs(glm::dot(element.normal, point - element.corners[0])) > in_plane &&
          glm::distance(point, element.center()) < clearance)
        return std::nullopt;
    return seen->reflectance / std::numbers::pi * irradiance(point, seen->normal);
  }

 private:
  static constexpr double largest_edge = 0.3;  // metres: half of the box
  static constexpr int lamp_refinement = 4;    // 512 pieces of the lamp, so many steps has a penumbra
  static constexpr double in_plane = 1e-9;     // metres, rounding
  static constexpr size_t rows_per_task = 16;

  struct Element {
    Corners corners;
    glm::dvec3 normal;
    glm::dvec3 reflectance, radiosity;

    glm::dvec3 center() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
  };

  static glm::dvec3 normal_of(const Corners& c) { return glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0])); }

  static void cut(Element element, int refinement, std::vector<Element>& parts) {
    const Corners c = element.corners;
    const auto with = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& d, int further) {
      Element part = element;
      part.corners = {a, b, d};
      cut(part, further, parts);
    };
    for (size_t i = 0; i < 3; ++i) {
      const glm::dvec3 &a = c[i], &b = c[(i + 1) % 3], &d = c[(i + 2) % 3];
      const double edge = glm::distance(a, b);
      if (edge < glm::distance(b, d) || edge < glm::distance(d, a) || edge <= largest_edge) continue;
      with(a, 0.5 * (a + b), d, refinement);
      return with(0.5 * (a + b), b, d, refinement);
    }
    if (refinement == 0) return parts.push_back(element);
    const glm::dvec3 ab = 0.5 * (c[0] + c[1]), bc = 0.5 * (c[1] + c[2]), ca = 0.5 * (c[2] + c[0]);
    with(c[0], ab, ca, refinement - 1);
    with(ab, c[1], bc, refinement - 1);
    with(ca, bc, c[2], refinement - 1);
    with(ab, bc, ca, refinement - 1);
  }

  bool visible(const glm::dvec3& from, const glm::dvec3& to) const {
    constexpr double on_surface = 1e-6;  // of the way: the surfaces of the two ends themselves
    for (const Corners& occluder : occluders_) {
      const double t = intersect(occluder, from, to - from);
      if (t > on_surface && t < 1.0 - on_surface) return false;
    }
    return true;
  }

  /// From a point to the part of the element that it sees: the point's irradiance where the element's radiosity is 1.
  double form_factor(const glm::dvec3& point, const glm::dvec3& normal, const Element& element) const {
    if (glm::dot(element.normal, point - element.corners[0]) <= in_plane) return 0.0;  // behind it, or in its plane
    std::array<glm::dvec3, 4> above;
    size_t count = 0;
    glm::dvec3 center(0.0);
    for (size_t i = 0; i < 3; ++i) {
      const glm::dvec3 &a = element.corners[i], &b = element.corners[(i + 1) % 3];
      const double height_a = glm::dot(normal, a - point), height_b = glm::dot(normal, b - point);
      if (height_a >= 0.0) above[count++] = a;
      if ((height_a > 0.0 && height_b < 0.0) || (height_a < 0.0 && height_b > 0.0))
        above[count++] = glm::mix(a, b, height_a / (height_a - height_b));
    }
    if (count < 3) return 0.0;
    for (size_t i = 0; i < count; ++i) center += above[i] / static_cast<double>(count);
    if (!visible(point, center)) return 0.0;
    return polygon_irradiance(std::span(above).first(count), point, normal) / std::numbers::pi;
  }

  glm::dvec3 gather(const std::vector<Element>& from, const glm::dvec3& point, const glm::dvec3& normal) const {
    glm::dvec3 sum(0.0);
    for (const Element& element : from) sum += form_factor(point, normal, element) * element.radiosity;
    return sum;
  }
  glm::dvec3 irradiance(const glm::dvec3& point, const glm::dvec3& normal) const {
    return gather(lamps_, point, normal) + gather(elements_, point, normal);
  }

  void solve() {
    const size_t count = elements_.size();
    std::vector<double> factors(count * count);
    std::vector<glm::dvec3> direct(count);
    parallel_for(count, rows_per_task, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const glm::dvec3 center = elements_[i].center(), &normal = elements_[i].normal;
        direct[i] = gather(lamps_, center, normal);
        for (size_t j = 0; j < count; ++j) factors[i * count + j] = form_factor(center, normal, elements_[j]);
      }
    });
    // Each sweep leaves at most the largest reflectance of the error, 0.78; much less in a box that is open.
    constexpr double small_change = 1e-7;
    for (double change = 1.0; change > small_change;) {
      change = 0.0;
      for (size_t i = 0; i < count; ++i) {
        glm::dvec3 arriving = direct[i];
        for (size_t j = 0; j < count; ++j) arriving += factors[i * count + j] * elements_[j].radiosity;
        const glm::dvec3 radiosity = elements_[i].reflectance * arriving;
        change = std::max(change, glm::distance(radiosity, elements_[i].radiosity) / (1e-30 + glm::length(radiosity)));
        elements_[i].radiosity = radiosity;
      }
    }
  }

  std::vector<Element> surfaces_, elements_, lamps_;  // the scene's triangles; their parts; those of what emits
  std::vector<Corners> occluders_;
};

}  // namespace voxref
