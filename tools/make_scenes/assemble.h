#pragma once
#include <string>

#include "make_scenes/mesh.h"
#include "scene/scene.h"

namespace voxref {

/// Appends a mesh as one object. @param material index into Scene::materials
void add_object(Scene& scene, const std::string& name, const Mesh& mesh, uint32_t material);
/// @returns its index
uint32_t add_material(Scene& scene, const Material& material);

/// Scatters by Lambert's law alone: not metallic, and without the dielectric layer that glTF's materials have
/// otherwise.
Material lambertian(const std::string& name, const glm::vec3& albedo);
/// The same, with radiance `emission`, W/(sr m^2), from its front.
Material emitter(const std::string& name, const glm::vec3& albedo, const glm::vec3& emission);

/// @param intensity W/sr
Light point_light(const std::string& name, const glm::vec3& position, const glm::vec3& intensity);
/// @param direction the way the light travels, any length @param irradiance of a facing surface, W/m^2
Light sun(const std::string& name, const glm::vec3& direction, const glm::vec3& irradiance);

/// A named perspective camera. @param yfov_degrees the whole vertical angle @param aspect width / height
Camera camera(const std::string& name, const glm::vec3& eye, const glm::vec3& target, float yfov_degrees, float aspect,
              const glm::vec3& up = {0.0f, 1.0f, 0.0f});

}  // namespace voxref
