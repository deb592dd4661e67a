#include "reference/lanes.h"

#include <memory>
#include <random>
#include <vector>

#include "catch.h"
#include "reference/light_sampling.h"
#include "reference/sampler.h"
#include "reference/small_scenes.h"
#include "reference/vertices.h"

namespace voxref {

namespace {

/// Vertices of all sorts, as many as fit no instruction's width, and what each of them is made of.
struct SomeVertices {
  std::vector<SurfacePoint> points;
  std::vector<glm::vec3> out;
  std::unique_ptr<Vertices> vertices = std::make_unique<Vertices>();
  std::mt19937 random{3};

  float uniform(float from, float to) { return std::uniform_real_distribution<float>(from, to)(random); }
  glm::vec3 color() { return {uniform(0.0f, 1.0f), uniform(0.0f, 1.0f), uniform(0.0f, 1.0f)}; }
  glm::vec3 direction() {
    const glm::vec3 v(uniform(-1.0f, 1.0f), uniform(-1.0f, 1.0f), uniform(-1.0f, 1.0f));
    return glm::normalize(v + glm::vec3(1e-3f));
  }

  explicit SomeVertices(bool all_lambertian) {
    vertices->clear();
    for (int i = 0; i < 301; ++i) {
      SurfacePoint point;
      point.position = {uniform(-1.0f, 1.0f), uniform(0.0f, 1.0f), uniform(-1.0f, 1.0f)};
      point.geometric_normal = direction();
      point.shading_normal = glm::normalize(point.geometric_normal + 0.3f * direction());
      point.reflectance.diffuse = color();
      if (!all_lambertian && i % 3 > 0) {
        point.reflectance.specular_f0 = color();
        point.reflectance.specular_f1 = 1.0f - point.reflectance.specular_f0;
        point.reflectance.alpha = uniform(0.01f, 1.0f);
        if (i % 3 == 2) point.reflectance.diffuse = glm::vec3(0.0f);
        if (i % 4 == 0) {  // a coated base, as glTF's dielectrics are
          point.reflectance.layer_f0 = uniform(0.02f, 0.1f);
          point.reflectance.layer_f1 = uniform(0.5f, 1.0f);
        }
      }
      points.push_back(point);
      out.push_back(glm::normalize(point.shading_normal + 0.9f * direction()));
      vertices->add(point, out.back());
    }
  }
};

std::vector<uint32_t> bits(std::mt19937& random, size_t count) {
  std::vector<uint32_t> numbers(count);
  for (uint32_t& number : numbers) number = static_cast<uint32_t>(random());
  return numbers;
}

/// A floor under some lights.
Scene lit_floor(int emitters, bool spot) {
  Scene scene;
  add_floor(scene, 5.0f, add_material(scene, lambert(glm::vec3(0.5f))));
  for (int i = 0; i < emitters; ++i) {
    Material lamp = lambert(glm::vec3(0.2f));
    lamp.emission = glm::vec3(1.0f + static_cast<float>(i), 2.0f, 3.0f);
    lamp.double_sided = i % 2 == 1;
    const auto x = static_cast<float>(i);
    add_quad(scene, {x, 0.5f, 0.0f}, {0.4f, 0.1f, 0.1f}, {0.1f, -0.1f, 0.6f}, add_material(scene, lamp));
  }
  Light light;
  light.type = spot ? LightType::spot : LightType::point;
  light.position = {0.1f, 0.9f, 0.2f};
  light.direction = {0.0f, -1.0f, 0.0f};
  scene.lights.push_back(light);
  return scene;
}

}  // namespace

TEST_CASE("BSDFs evaluated and sampled side by side are those of one after the other, to the bit", "[lanes]") {
  for (const bool all_lambertian : {true, false}) {
    SomeVertices some(all_lambertian);
    const size_t count = some.points.size();
    const auto in = std::make_unique<Lanes3>(), value = std::make_unique<Lanes3>(), weight = std::make_unique<Lanes3>();
    const auto pdf = std::make_unique<Lanes<float>>();
    for (size_t i = 0; i < count; ++i) in->set(i, some.direction());
    some.vertices->evaluate(*in, *value, *pdf);
    for (size_t i = 0; i < count; ++i) {
      const Bsdf bsdf(some.points[i], some.out[i]);
      REQUIRE((*value)[i] == bsdf.value((*in)[i]));
      REQUIRE((*pdf)[i] == bsdf.pdf((*in)[i]));
    }
    const std::vector<uint32_t> choice = bits(some.random, count), x = bits(some.random, count),
                                y = bits(some.random, count);
    some.vertices->sample(choice.data(), x.data(), y.data(), *in, *weight, *pdf);
    for (size_t i = 0; i < count; ++i) {
      const Bsdf bsdf(some.points[i], some.out[i]);
      const BsdfSample sample = bsdf.sample(unit_float(choice[i]), {unit_float(x[i]), unit_float(y[i])});
      REQUIRE((*in)[i] == sample.in);
      REQUIRE((*weight)[i] == sample.weight);
      REQUIRE((*pdf)[i] == sample.pdf);
    }
  }
}

TEST_CASE("Lights sampled side by side are those of one after the other, to the bit", "[lanes]") {
  for (const int emitters : {1, 2, 9})  // squares: two triangles, four, and many
    for (const bool spot : {false, true}) {
      SomeVertices some(true);
      const size_t count = some.points.size();
      const Scene scene = lit_floor(emitters, spot);
      const Materials materials(scene);
      const LightSampler lights(scene, materials);
      const std::vector<uint32_t> x = bits(some.random, count), y = bits(some.random, count);
      const auto found = std::make_unique<LightLanes>();
      lights.sample_emitter(*some.vertices, x.data(), y.data(), *found);
      for (size_t i = 0; i < count; ++i) {
        const auto sample = lights.sample_emitter(some.vertices->receiver(i), {x[i], y[i]});
        REQUIRE(found->light[i] == (sample ? sample->radiance : glm::vec3(0.0f)));
        if (!sample) continue;
        REQUIRE(found->to_light[i] == sample->to_light);
        REQUIRE(found->position[i] == sample->position);
        REQUIRE(found->normal[i] == sample->normal);
        REQUIRE(found->pdf[i] == sample->pdf);
      }
      lights.sample_punctual(*some.vertices, x.data(), *found);
      for (size_t i = 0; i < count; ++i) {
        const auto sample = lights.sample_punctual(some.vertices->receiver(i), x[i]);
        if (!sample) continue;  // from behind the surface, which only the BSDF sees here
        REQUIRE(found->light[i] == sample->irradiance);
        REQUIRE(found->to_light[i] == sample->to_light);
        REQUIRE(found->distance[i] == sample->distance);
      }
    }
}

}  // namespace voxref
