#include "study/plan_unused.h"

#include <glm/geometric.hpp>

#include "reference/sampler.h"
#include "reference/warp.h"
#include "scene/surface.h"

namespace voxref {

namespace {

bool has_specular(const Scene& scene) {
  const Materials materials(scene);
  for (uint32_t m = 0; m < scene.materials.size(); ++m) {
    const MaterialPoint* constant = materials.constant(m);
    if (!constant || constant->reflectance.has_specular()) return true;
  }
  return false;
}

}  // namespace

bool view_sees_surfaces(const Scene& scene, const Caster& caster, const View& view) {
  constexpr uint32_t side = 64, directions = 4;
  const RayGenerator generate(view);
  const Surfaces surfaces(scene);
  for (uint32_t i = 0; i < side * side; ++i) {
    const glm::vec2 position = (glm::vec2(i % side, i / side) + 0.5f) / float(side);
    const Ray primary = generate(position * glm::vec2(view.width, view.height));
    const Hit hit = caster.closest(primary);
    if (!hit) continue;
    const SurfacePoint point = surfaces.point(hit, -primary.direction);
    for (uint32_t k = 0; k < directions; ++k) {
      const Sampler sampler(randomization_key(0, 0, 0, 0), i * directions + k);
      const glm::vec3 direction = Frame(point.geometric_normal).to_world(cosine_hemisphere(sampler.get_2d(0)));
      if (caster.closest(caster.leave(point.position, point.geometric_normal, direction))) return true;
    }
  }
  return false;
}

std::vector<std::string> drop_unused(SettingSpace& space, const Scene& scene, bool sees, const glm::vec3& background) {
  std::vector<std::string> dropped;
  if (!has_specular(scene)) dropped.emplace_back("no surface is specular: no specular cones are traced");
  if (!scene.has_emission()) dropped.emplace_back("no surface emits: there is no volume of emission");
  if (sees) return dropped;
  space.bounces.resize(1);
  space.cones.resize(1);
  space.steps.resize(1);
  dropped.emplace_back(background == glm::vec3(0.0f)
                           ? "no surface in view sees another: the fewest bounces, and the fewest cones, which find "
                             "nothing"
                           : "no surface in view sees another: the fewest bounces, and the fewest cones, which see the "
                             "background alone");
  return dropped;
}

}  // namespace voxref
