#include "scene/light.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "catch.h"

using namespace voxref;

TEST_CASE("a point light's irradiance falls with the square of the distance", "[light]") {
  Light light;
  light.position = {0.0f, 4.0f, 0.0f};
  light.intensity = {2.0f, 4.0f, 8.0f};
  const Illumination near = illuminate(light, {0.0f, 2.0f, 0.0f});
  CHECK(near.irradiance == glm::vec3(0.5f, 1.0f, 2.0f));
  CHECK(near.to_light == glm::vec3(0.0f, 1.0f, 0.0f));
  CHECK(near.distance == 2.0f);
  CHECK(illuminate(light, {0.0f, 0.0f, 0.0f}).irradiance == near.irradiance / 4.0f);
  CHECK(illuminate(light, light.position).irradiance == glm::vec3(0.0f));
}

TEST_CASE("a spot light fades between its cones by the square of the cosine's ramp", "[light]") {
  Light light;
  light.type = LightType::spot;
  light.direction = {0.0f, -1.0f, 0.0f};
  light.cos_inner = 0.9f;
  light.cos_outer = 0.5f;
  const auto at_cosine = [&](float c) {
    return illuminate(light, {std::sqrt(1.0f - c * c), -c, 0.0f}).irradiance.x;  // at distance 1
  };
  CHECK(at_cosine(1.0f) == Approx(1.0f));
  CHECK(at_cosine(0.95f) == Approx(1.0f));
  CHECK(at_cosine(0.7f) == Approx(0.25f).epsilon(1e-4));  // half way: (1/2)^2; float rounding of the root
  CHECK(at_cosine(0.4f) == 0.0f);
  CHECK(at_cosine(-1.0f) == 0.0f);
}

TEST_CASE("glTF keeps a narrow ramp 0.001 wide, the published shaders' is as narrow as it is", "[light]") {
  Light light;
  light.type = LightType::spot;
  light.direction = {0.0f, -1.0f, 0.0f};
  light.cos_outer = 0.5f;
  light.cos_inner = 0.5f + 0.000244140625f;  // 2^-12
  const glm::vec3 middle(std::sqrt(1.0f - 0.5f * 0.5f), -0.5f - 0.0001220703125f, 0.0f);
  LightOptions published;
  published.falloff = LightFalloff::attenuated;
  // Directions are good to 1e-7, which is 1e-3 of this ramp.
  const float cosine = -glm::dot(light.direction, illuminate(light, middle).to_light);
  const float t = (cosine - light.cos_outer) / (light.cos_inner - light.cos_outer);
  REQUIRE(t > 0.2f);
  REQUIRE(t < 0.8f);
  CHECK(illuminate(light, middle, published).attenuation == Approx(t * t * (3.0f - 2.0f * t)).epsilon(0.01));
  CHECK(illuminate(light, middle).irradiance.x < 0.06f);  // (2^-12 / 0.001)^2
  light.cos_inner = light.cos_outer;
  CHECK(illuminate(light, middle, published).attenuation == 1.0f);
  CHECK(illuminate(light, {1.0f, 0.0f, 0.0f}, published).attenuation == 0.0f);
}

TEST_CASE("lights are put in the published order, those of a type as they were", "[light]") {
  std::vector<Light> lights(5);
  const LightType types[] = {LightType::spot, LightType::point, LightType::directional, LightType::spot,
                             LightType::point};
  for (size_t i = 0; i < lights.size(); ++i) lights[i].type = types[i], lights[i].name = std::to_string(i);
  std::string order;
  for (const Light& light : by_type(lights)) order += light.name;
  CHECK(order == "21403");
}

TEST_CASE("a directional light is the same everywhere", "[light]") {
  Light light;
  light.type = LightType::directional;
  light.direction = {0.0f, 0.0f, 1.0f};
  light.intensity = {3.0f, 3.0f, 3.0f};
  const Illumination a = illuminate(light, {0.0f, 0.0f, 0.0f}), b = illuminate(light, {1e6f, -5.0f, 3.0f});
  CHECK(a.irradiance == glm::vec3(3.0f));
  CHECK(b.irradiance == a.irradiance);
  CHECK(a.to_light == glm::vec3(0.0f, 0.0f, -1.0f));
  CHECK(std::isinf(a.distance));
}
