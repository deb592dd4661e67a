#include "voxel/material_filter.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "scene/surface.h"

namespace voxref {

namespace {

constexpr double golden_fraction = 0.6180339887498949;  // (sqrt(5) - 1) / 2: its multiples fill [0,1) most evenly

/// The share of cosine-weighted light that leaves again, whatever the directions: what a voxel, which forgets
/// directions, scatters as if it were Lambertian. The diffuse base as the layer over it dims it, plus the specular
/// lobe.
FilteredMaterial at_point(const MaterialPoint& point) {
  return {point.opacity,
          glm::dvec3(glm::clamp(hemispherical_albedo(point.reflectance), glm::vec3(0.0f), glm::vec3(1.0f))),
          glm::dvec3(point.emission)};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Area in barycentric coordinates; the whole triangle has 1/2.
double barycentric_area(const ClipPolygon& piece) {
  double sum = 0.0;
  for (int i = 2; i < piece.size(); ++i) sum += cross(piece[i - 1].uv - piece[0].uv, piece[i].uv - piece[0].uv);
  return 0.5 * std::abs(sum);
}

/// Point number `i` of `count` spread evenly over a piece. Barycentric coordinates map areas in proportion, so the
/// piece can be sampled there: its fan of triangles by cumulative area, each by the usual square root.
glm::dvec2 spread(const ClipPolygon& piece, double area, int i, int count) {
  double rest = (i + 0.5) / count * area;
  int corner = 2;
  double part = 0.0;
  for (; corner < piece.size(); ++corner) {
    part = 0.5 * std::abs(cross(piece[corner - 1].uv - piece[0].uv, piece[corner].uv - piece[0].uv));
    if (rest <= part || corner + 1 == piece.size()) break;
    rest -= part;
  }
  const double across = part > 0.0 ? std::sqrt(std::clamp(rest / part, 0.0, 1.0)) : 0.0;
  const double along = std::fmod((i + 0.5) * golden_fraction, 1.0);
  const glm::dvec2 edge = glm::mix(piece[corner - 1].uv, piece[corner].uv, along);
  return glm::mix(piece[0].uv, edge, across);
}

double texels_per_unit_area(const Scene& scene, const TextureBinding& binding) {
  const TextureImage& image = scene.images[binding.image];
  const double scale = cross(glm::dvec2(binding.transform[0]), glm::dvec2(binding.transform[1]));
  return std::abs(scale) * image.width * image.height;
}

}  // namespace

MaterialFilter::MaterialFilter(const Scene& scene) : scene_(scene), entries_(scene.materials.size()) {
  for (size_t i = 0; i < entries_.size(); ++i) {
    const Material& m = scene.materials[i];
    entries_[i].varies = !scene.colors.empty();
    for (const TextureBinding* binding : {&m.base_color_texture, &m.metallic_roughness_texture, &m.specular_texture,
                                          &m.specular_color_texture, &m.emission_texture})
      if (*binding && !scene.uv[binding->uv_set].empty()) {
        entries_[i].varies = true;
        double& texels = entries_[i].texels[binding->uv_set];
        texels = std::max(texels, texels_per_unit_area(scene, *binding));
      }
  }
  std::vector<bool> known(entries_.size());
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    const uint32_t material = scene.triangle_materials[t];
    if (known[material] || entries_[material].varies) continue;
    known[material] = true;
    entries_[material].constant = at_point(material_point(scene, uint32_t(t), glm::vec2(1.0f / 3.0f)));
  }
}

int MaterialFilter::sample_count(const Entry& entry, uint32_t triangle, const ClipPolygon& piece, double area) const {
  const glm::uvec3& corners = scene_.triangles[triangle];
  double texels = 0.0;
  for (int set = 0; set < 2; ++set) {
    if (entry.texels[set] == 0.0) continue;
    const std::vector<glm::vec2>& uv = scene_.uv[set];
    const glm::dvec2 a(uv[corners.x]), b(uv[corners.y]), c(uv[corners.z]);
    texels = std::max(texels, std::abs(cross(b - a, c - a)) * barycentric_area(piece) * entry.texels[set]);
  }
  static const double S = getenv("S") ? atof(getenv("S")) : 32;
  return int(std::max(1.0, std::ceil(std::min(texels, S * area))));
}

FilteredMaterial MaterialFilter::operator()(uint32_t triangle, const ClipPolygon& piece, double area) const {
  const Entry& entry = entries_[scene_.triangle_materials[triangle]];
  if (!entry.varies) return entry.constant;

  const int count = sample_count(entry, triangle, piece, area);
  const double within = barycentric_area(piece);
  FilteredMaterial mean{0.0};
  for (int i = 0; i < count; ++i) {
    const FilteredMaterial sample =
        at_point(material_point(scene_, triangle, glm::vec2(spread(piece, within, i, count))));
    mean.coverage += sample.coverage;
    mean.albedo += sample.coverage * sample.albedo;
    mean.emission += sample.coverage * sample.emission;
  }
  if (mean.coverage > 0.0) {
    mean.albedo /= mean.coverage;
    mean.emission /= mean.coverage;
  }
  mean.coverage /= count;
  return mean;
}

}  // namespace voxref
