#include <array>
#include <fstream>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "cone/render.h"
#include "parity/gpu_image.h"
#include "scene/gltf.h"
#include "settings.h"
#include "voxel/volume_file.h"

// Images against those of the published shaders, from the shaders' own volumes, so that what differs is the image
// stage. Tolerances are those of shared/gpu/README.md, which an independent re-implementation met.

using namespace voxref;

namespace {

const std::array<const char*, 2> configurations = {"cornell_64", "glossy_64"};

/// One configuration: scene, settings, the shaders' volumes after the bounce.
struct Configuration {
  std::filesystem::path folder;
  Scene scene;
  Caster caster;
  Settings settings;
  LitVolume volume;
  View view;

  explicit Configuration(const std::filesystem::path& from)
      : folder(from),
        scene(load_gltf(from / "scene.glb")),
        caster(scene),
        volume(VolumeFolder(from / "volumes").pyramid<Rgba8>(true)) {
    apply_json(settings, nlohmann::json::parse(std::ifstream(from / "settings.json")));
    view.camera = scene.cameras.at(0);
    view.width = view.height = 256;
  }
  LitScene lit() const { return {scene, caster, volume, settings.grid.bounds.value(), settings.light}; }
};

/// The shaders' G-buffer. Depth has 24 bits; the position follows from it and the camera.
std::vector<GBufferPoint> gpu_gbuffer(const Configuration& c) {
  const GpuImage albedo = gpu_image(c.folder, "gbuffer_albedo"), normal = gpu_image(c.folder, "gbuffer_normal"),
                 specular = gpu_image(c.folder, "gbuffer_specular"), emissive = gpu_image(c.folder, "gbuffer_emissive"),
                 depth = gpu_image(c.folder, "gbuffer_depth");
  const RayGenerator rays(c.view);
  const double near = c.view.camera.znear, far = c.view.camera.zfar;
  std::vector<GBufferPoint> points(albedo.width * albedo.height);
  for (size_t i = 0; i < points.size(); ++i) {
    const Ray ray = rays(glm::vec2(i % albedo.width, i / albedo.width) + 0.5f);
    GBufferPoint& p = points[i];
    // depth = (1 - near / z) / (1 - near / far)
    p.depth = static_cast<float>(near / (1.0 - depth(i, 0) * (1.0 - near / far)));
    p.position = ray.origin + p.depth / glm::dot(ray.direction, rays.forward()) * ray.direction;
    p.to_viewer = -ray.direction;
    p.normal = p.geometric_normal = glm::normalize(normal.rgb(i));
    p.emission = emissive.rgb(i);
    p.phong = {albedo.rgb(i), specular.rgb(i), specular(i, 3), emissive.rgb(i)};
  }
  return points;
}

/// All pictures that the shaders' output has, by name.
using Pictures = std::map<std::string, std::vector<glm::vec3>>;

glm::vec3 power(const glm::vec3& v, const Settings& settings) {
  return glm::pow(v, glm::vec3(settings.render.composite.indirect_power));
}

Pictures shade(const Configuration& c, const std::vector<GBufferPoint>& points) {
  RenderOptions with_ao = c.settings.render;
  with_ao.ao.enabled = true;
  const PixelShader shade_pixel(c.lit(), with_ao, glm::vec3(0.0f));
  const float strength = c.settings.render.composite.bounce_strength;
  Pictures pictures;
  for (const GBufferPoint& point : points) {
    const PixelLight light = shade_pixel(point);
    const glm::vec3 indirect = strength * (light.diffuse + light.specular);
    pictures["direct_linear"].push_back(light.direct + light.emission);
    pictures["indirect_before_power"].push_back(indirect);
    pictures["diffuse_linear"].push_back(power(indirect, c.settings) + light.emission);
    pictures["total_linear"].push_back(light.direct + power(indirect, c.settings) + light.emission);
    pictures["total_ao_linear"].push_back(light.color);
    pictures["ao_linear"].push_back(light.ao + light.emission);

    GBufferPoint white = point;
    white.phong.diffuse = white.phong.specular = glm::vec3(1.0f);
    const PixelLight on_white = shade_pixel(white);
    pictures["indirect_white_linear"].push_back(power(strength * (on_white.diffuse + on_white.specular), c.settings) +
                                                light.emission);
  }
  return pictures;
}

constexpr double most_median = 6e-6, most_99 = 1e-4, most_99_9 = 1e-3, most = 0.02;

}  // namespace

TEST_CASE("From the published shaders' volumes and G-buffer come their images", "[parity]") {
  for (const char* name : configurations) {
    const auto folder = shared_file(std::filesystem::path("gpu") / name);
    if (!folder) VOXREF_SKIP("the published shaders' output is absent");
    const Configuration c(*folder);
    for (const auto& [picture, ours] : shade(c, gpu_gbuffer(c))) {
      const Differences d = differences(ours, gpu_image(c.folder, picture));
      INFO(name << ' ' << picture << ", worst at pixel (" << d.worst % 256 << ", " << d.worst / 256 << ')');
      CHECK(d.median <= most_median);
      CHECK(d.percentile_99 <= most_99);
      CHECK(d.percentile_99_9 <= most_99_9);
      CHECK(d.largest <= most);
    }
  }
}

TEST_CASE("The ray caster's G-buffer is the rasterizer's, but for silhouettes", "[parity]") {
  for (const char* name : configurations) {
    const auto folder = shared_file(std::filesystem::path("gpu") / name);
    if (!folder) VOXREF_SKIP("the published shaders' output is absent");
    const Configuration c(*folder);
    const std::vector<GBufferPoint> theirs = gpu_gbuffer(c);
    const GBuffer gbuffer(c.scene, c.caster, c.view, c.settings.render.gbuffer);
    size_t different = 0;
    for (size_t i = 0; i < theirs.size(); ++i) {
      const auto ours = gbuffer(glm::vec2(i % 256, i / 256) + 0.5f);
      const bool same = ours && ours->phong.diffuse == theirs[i].phong.diffuse &&
                        ours->phong.specular == theirs[i].phong.specular &&
                        ours->phong.glossiness == theirs[i].phong.glossiness && ours->normal == theirs[i].normal &&
                        ours->emission == theirs[i].emission;
      different += !same;
      // The rasterizer interpolates depth in float32: it errs by up to three of its 2^-24 steps, each 0.001 units here.
      if (same) CHECK(std::abs(ours->depth - theirs[i].depth) < 0.004f);
    }
    INFO(name);
    CHECK(different <= 2);  // one pixel on an edge of the tall block, whose centre lies on it within rounding
  }
}

TEST_CASE("From the published shaders' volumes alone come their images, but for 0.1 % of the pixels", "[parity]") {
  for (const char* name : configurations) {
    const auto folder = shared_file(std::filesystem::path("gpu") / name);
    if (!folder) VOXREF_SKIP("the published shaders' output is absent");
    Configuration c(*folder);
    c.settings.render.ao.enabled = true;
    const ConeImage seen = render_cones(c.lit(), c.view, c.settings.render);
    const auto color = seen.image.layer("");
    std::vector<glm::vec3> ours;
    for (size_t i = 0; i < seen.image.pixel_count(); ++i) ours.emplace_back(color[0][i], color[1][i], color[2][i]);
    const Differences d = differences(ours, gpu_image(c.folder, "total_ao_linear"));
    INFO(name);
    CHECK(d.median <= most_median);
    CHECK(d.percentile_99 <= most_99);
    CHECK(double(std::ranges::count_if(d.per_pixel, [](double e) { return !(e <= most_99_9); })) <=
          0.001 * double(ours.size()));
  }
}

TEST_CASE("The published picture in bytes is the tone-mapped total without ambient occlusion", "[parity]") {
  const auto folder = shared_file("gpu/glossy_64");
  if (!folder) VOXREF_SKIP("the published shaders' output is absent");
  const GpuImage linear = gpu_image(*folder, "total_linear"), bytes = gpu_image(*folder, "total_tonemapped_u8");
  size_t different = 0;
  for (size_t i = 0; i < linear.width * linear.height; ++i)
    for (size_t channel = 0; channel < 3; ++channel)
      different += std::lround(255.0f * tone_mapped(linear(i, channel))) != std::lround(255.0f * bytes(i, channel));
  CHECK(different <= 4);  // halves between two bytes
}
