#include "cone/blinn_phong.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace voxref {

glm::vec3 evaluate(const PhongMaterial& material, const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in,
                   const BlinnPhongOptions& options) {
  glm::vec3 diffuse = material.diffuse;
  if (options.albedo_power != 1.0f) diffuse = glm::pow(diffuse, glm::vec3(options.albedo_power));
  if (options.divide_by_pi) diffuse *= std::numbers::inv_pi_v<float>;
  if (material.specular == glm::vec3(0.0f) && options.specular_twice) return diffuse;  // the lobe is black too

  const glm::vec3 half = glm::normalize(out + in);
  const float n_h = std::max(glm::dot(normal, half), 0.0f), l_h = std::max(glm::dot(in, half), 0.0f);
  const float power = std::exp2(11.0f * material.glossiness + 1.0f);
  const float lobe = std::pow(n_h, power) * (0.0397f * power + 0.3183f);
  const glm::vec3 fresnel = material.specular + (1.0f - material.specular) * std::pow(1.0f - l_h, 5.0f);
  return diffuse + (options.specular_twice ? material.specular : glm::vec3(1.0f)) * lobe * fresnel;
}

}  // namespace voxref
