#include "reference/extra_layers.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace voxref {

std::vector<std::string> ExtraLayers::names() const {
  std::vector<std::string> names;
  for (int k = 1; k <= bounces; ++k) names.push_back("bounce." + std::to_string(k));
  if (irradiance) names.emplace_back("irradiance");
  return names;
}

ExtraTracer::ExtraTracer(const Scene& scene, const Surfaces& surfaces, const Caster& caster,
                         const glm::vec3& background, const Transport& transport, const ExtraLayers& layers)
    : layers_(layers) {
  const int most = transport.max_depth.value_or(std::numeric_limits<int>::max());
  cut_.reserve(static_cast<size_t>(layers.bounces));
  for (int k = 1; k <= layers.bounces; ++k)
    cut_.emplace_back(scene, surfaces, caster, background,
                      Transport{std::min(k + 1, most), transport.energy_compensation});
  if (layers.irradiance) onwards_.emplace(scene, surfaces, caster, background, transport);
}

void ExtraTracer::trace(const std::optional<PathVertex>& seen, const Sampler& sampler, std::span<glm::dvec3> sums,
                        PathCounts& counts) const {
  PathCounts own;  // what is not finite here was not so in the path itself, and is counted there
  glm::dvec3 shorter(0.0);
  for (size_t k = 0; k < cut_.size(); ++k) {
    const glm::dvec3 longer(cut_[k].trace(seen, sampler, own).indirect);
    sums[k] += longer - shorter;
    shorter = longer;
  }
  if (onwards_ && seen) {
    std::optional<PathVertex> white = seen;
    white->surface.reflectance = Reflectance{};
    white->surface.reflectance.diffuse = glm::vec3(1.0f);
    const Layers scattered = onwards_->trace(white, sampler, own);
    sums.back() += std::numbers::pi * (glm::dvec3(scattered.direct) + glm::dvec3(scattered.indirect));
  }
  counts.closest_rays += own.closest_rays;
  counts.occlusion_rays += own.occlusion_rays;
}

}  // namespace voxref
