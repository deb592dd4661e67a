#include "voxel/material_filter.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace voxref {

namespace {

/// Enough for the border between two texels to be seen where it is.
constexpr double points_per_texel = 4.0;

/// The share of cosine-weighted light that leaves again, whatever the directions: what a voxel, which forgets
/// directions, scatters as if it were Lambertian. The diffuse base as the layer over it dims it, plus the specular
/// lobe.
FilteredMaterial at_point(const MaterialPoint& point) {
  return {point.opacity,
          glm::dvec3(glm::clamp(hemispherical_albedo(point.reflectance), glm::vec3(0.0f), glm::vec3(1.0f))),
          glm::dvec3(point.emission)};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Calls visit(uv) for the points of a square lattice in the triangle's plane that lie in a piece. The lattice is
/// anchored in the grid and not in the piece: however a surface is cut, it is looked up at the same points. It is
/// turned against the plane's natural axes so that it does not beat with textures that follow them.
/// @param front unit, of the triangle @param density points per voxel face
template <class Visit>
void for_each_lattice_point(const ClipPolygon& piece, const glm::dvec3& front, double density, Visit&& visit) {
  constexpr double slope = 0.41421356237309503;  // tan(pi / 8): half-way between the axes and the diagonals
  const glm::dvec3 axis = std::abs(front.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 natural = glm::normalize(glm::cross(front, axis));
  const glm::dvec3 along = glm::normalize(natural + slope * glm::cross(front, natural));
  const glm::dvec3 across = glm::cross(front, along);
  const double scale = std::sqrt(density);
  const auto on_lattice = [&](const ClipVertex& vertex) {
    return scale * glm::dvec2(glm::dot(vertex.position, along), glm::dot(vertex.position, across));
  };
  const glm::dvec2 a = on_lattice(piece[0]);
  for (int i = 2; i < piece.size(); ++i) {
    const glm::dvec2 ab = on_lattice(piece[i - 1]) - a, ac = on_lattice(piece[i]) - a;
    const double twice_area = cross(ab, ac);
    if (!(twice_area > 0.0)) continue;
    const glm::dvec2 low = glm::ceil(a + glm::min(glm::dvec2(0.0), glm::min(ab, ac)));
    const glm::dvec2 high = a + glm::max(glm::dvec2(0.0), glm::max(ab, ac));
    for (double y = low.y; y <= high.y; ++y)
      for (double x = low.x; x <= high.x; ++x) {
        const glm::dvec2 point = glm::dvec2(x, y) - a;
        const double b = cross(point, ac) / twice_area, c = cross(ab, point) / twice_area;
        if (b >= 0.0 && c >= 0.0 && b + c < 1.0)
          visit((1.0 - b - c) * piece[0].uv + b * piece[i - 1].uv + c * piece[i].uv);
      }
  }
}

double texels_per_unit_area(const Scene& scene, const TextureBinding& binding) {
  const TextureImage& image = scene.images[binding.image];
  const double scale = cross(glm::dvec2(binding.transform[0]), glm::dvec2(binding.transform[1]));
  return std::abs(scale) * image.width * image.height;
}

}  // namespace

MaterialFilter::MaterialFilter(const Scene& scene)
    : scene_(scene), materials_(scene), entries_(scene.materials.size()) {
  for (size_t i = 0; i < entries_.size(); ++i) {
    if (const MaterialPoint* constant = materials_.constant(static_cast<uint32_t>(i))) {
      entries_[i].constant = at_point(*constant);
      continue;
    }
    entries_[i].varies = true;
    const Material& m = scene.materials[i];
    for (const TextureBinding* binding : {&m.base_color_texture, &m.metallic_roughness_texture, &m.specular_texture,
                                          &m.specular_color_texture, &m.emission_texture})
      if (*binding && !scene.uv[binding->uv_set].empty()) {
        double& texels = entries_[i].texels[binding->uv_set];
        texels = std::max(texels, texels_per_unit_area(scene, *binding));
      }
  }
}

double MaterialFilter::texels_per_voxel(const Entry& entry, uint32_t triangle, double area) const {
  const glm::uvec3& corners = scene_.triangles[triangle];
  double texels = 0.0;
  for (int set = 0; set < 2; ++set) {
    if (entry.texels[set] == 0.0) continue;
    const std::vector<glm::vec2>& uv = scene_.uv[set];
    const glm::dvec2 a(uv[corners.x]), b(uv[corners.y]), c(uv[corners.z]);
    texels = std::max(texels, 0.5 * std::abs(cross(b - a, c - a)) * entry.texels[set]);
  }
  return texels / area;
}

FilteredMaterial MaterialFilter::operator()(const TrianglePlane& plane, const ClipPolygon& piece,
                                            const glm::dvec2& centroid) const {
  const Entry& entry = entries_[scene_.triangle_materials[plane.triangle]];
  if (!entry.varies) return entry.constant;

  FilteredMaterial mean{0.0};
  int count = 0;
  const auto add = [&](const glm::dvec2& uv) {
    const FilteredMaterial sample = at_point(materials_.point(plane.triangle, glm::vec2(uv)));
    mean.coverage += sample.coverage;
    mean.albedo += sample.coverage * sample.albedo;
    mean.emission += sample.coverage * sample.emission;
    ++count;
  };
  const double density =
      std::min(points_per_texel * texels_per_voxel(entry, plane.triangle, plane.area), max_points_per_voxel);
  if (density > 1.0) for_each_lattice_point(piece, plane.front, density, add);
  if (count == 0) add(centroid);
  if (mean.coverage > 0.0) {
    mean.albedo /= mean.coverage;
    mean.emission /= mean.coverage;
  }
  mean.coverage /= count;
  return mean;
}

}  // namespace voxref
