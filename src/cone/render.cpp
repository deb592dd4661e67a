#include "cone/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "cone/clearance.h"
#include "parallel.h"
#include "scene/surface.h"

namespace voxref {
namespace {

/// What rays through the image see, summed: the layers of the image.
struct Seen {
  glm::vec3 color{0.0f}, direct{0.0f}, diffuse{0.0f}, specular{0.0f}, emission{0.0f}, albedo{0.0f}, normal{0.0f};
  float ao = 0.0f, depth = 0.0f, rays = 0.0f, hits = 0.0f;

  Seen& operator+=(const Seen& other) {
    color += other.color, direct += other.direct, diffuse += other.diffuse, specular += other.specular;
    emission += other.emission, albedo += other.albedo, normal += other.normal;
    ao += other.ao, depth += other.depth, rays += other.rays, hits += other.hits;
    return *this;
  }
  /// Light is the mean over all rays; albedo, normal and depth are those of what was hit, 0 where nothing was.
  Seen mean() const {
    const float all = 1.0f / rays, hit = hits > 0.0f ? 1.0f / hits : 0.0f;
    return {color * all,  direct * all, diffuse * all, specular * all, emission * all, albedo * hit,
            normal * hit, ao * all,     depth * hit,   1.0f,           hits * all};
  }
};

/// Everything that pixels share.
class Renderer {
 public:
  Renderer(const Scene& scene, const Caster& caster, const Medium& medium, const View& view,
           const RenderOptions& options)
      : scene_(scene),
        surfaces_(scene),
        caster_(caster),
        medium_(medium),
        view_(view),
        options_(options),
        rays_(view),
        cones_(partition_hemisphere(options.cone.diffuse)) {}

  /// Mean over the pixel's sub-positions: its centre, or a regular 4 x 4 grid (as finely as cone tracing, which is
  /// smooth over a voxel, can tell; edges keep 16 shades).
  Seen pixel(int x, int y) const {
    const int side = view_.pixel == PixelSampling::center ? 1 : 4;
    Seen sum;
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const glm::vec2 offset = (glm::vec2(i, j) + 0.5f) / float(side);
        sum += position(glm::vec2(x, y) + offset);
      }
    return sum.mean();
  }

 private:
  Seen position(const glm::vec2& where) const {
    const Ray ray = rays_(where);
    const Hit hit = caster_.closest(ray);
    Seen seen;
    seen.rays = seen.ao = 1.0f;
    if (!hit) {
      seen.color = seen.emission = view_.background;
      return seen;
    }
    seen.hits = 1.0f;
    const glm::vec3 to_viewer = -glm::normalize(ray.direction);
    const SurfacePoint point = surfaces_.point(hit, to_viewer);
    const float n_v = std::clamp(glm::dot(point.shading_normal, to_viewer), 0.0f, 1.0f);
    seen.normal = point.shading_normal;
    seen.depth = glm::dot(point.position - rays_.eye(), rays_.forward());
    seen.emission = point.emission;
    const Reflectance& reflectance = point.reflectance;
    seen.albedo = reflectance.diffuse * (1.0f - reflectance.layer_f0) + reflectance.specular_f0;  // as the path tracer
    seen.direct = direct(point, to_viewer);
    indirect(point, to_viewer, n_v, seen);
    seen.color = (seen.direct + seen.diffuse + seen.specular) * seen.ao + seen.emission;
    return seen;
  }

  glm::vec3 direct(const SurfacePoint& point, const glm::vec3& to_viewer) const {
    glm::vec3 sum(0.0f);
    if (point.reflectance.black()) return sum;
    for (const Light& light : scene_.lights) {
      const Illumination lit = illuminate(light, point.position);
      const float cosine = glm::dot(point.shading_normal, lit.to_light);
      if (lit.irradiance == glm::vec3(0.0f) || cosine <= 0.0f || glm::dot(point.geometric_normal, lit.to_light) <= 0.0f)
        continue;
      const glm::vec3 reflected =
          evaluate(point.reflectance, point.shading_normal, to_viewer, lit.to_light) * cosine * lit.irradiance;
      if (reflected != glm::vec3(0.0f)) sum += reflected * visibility(point, light, lit);
    }
    return sum;
  }

  float visibility(const SurfacePoint& point, const Light& light, const Illumination& lit) const {
    const bool directional = light.type == LightType::directional;
    switch (options_.pixel.shadow) {
      case PixelShadow::none:
        return 1.0f;
      case PixelShadow::rays: {
        const Ray away = caster_.leave(point.position, point.geometric_normal, lit.to_light);
        return (directional ? !caster_.occluded(away) : caster_.visible(away.origin, light.position)) ? 1.0f : 0.0f;
      }
      case PixelShadow::cone: {
        const Grid& grid = medium_.texels.grid;
        const glm::vec3 target = directional  // a point outside the grid
                                     ? point.position + glm::length(grid.max() - grid.min) * lit.to_light
                                     : light.position;
        return gather_visibility(medium_, gather_point(point), target, options_.pixel.shadow_cone_aperture,
                                 options_.cone);
      }
    }
    return 1.0f;
  }

  /// Light gathered by cones, after the BRDF. What the specular lobe reflects is taken off the base (diffuse_albedo),
  /// so that both together send no more than arrives.
  void indirect(const SurfacePoint& point, const glm::vec3& to_viewer, float n_v, Seen& seen) const {
    const Reflectance& reflectance = point.reflectance;
    const GatherPoint from = gather_point(point);
    if (reflectance.has_diffuse() || options_.ao.enabled) {
      const DiffuseGather gathered =
          gather_diffuse(medium_, cones_, from, options_.cone, options_.ao, view_.background);
      seen.diffuse = diffuse_albedo(reflectance, n_v) * gathered.irradiance / std::numbers::pi_v<float>;
      seen.ao = gathered.openness;
    }
    if (reflectance.has_specular())
      seen.specular = specular_albedo(reflectance, n_v) *
                      gather_specular(medium_, from, to_viewer, reflectance.alpha, options_.cone, view_.background);
  }

  GatherPoint gather_point(const SurfacePoint& point) const {
    return {
        point.position, point.geometric_normal, point.shading_normal,
        clearance(scene_, caster_, point.position, point.geometric_normal, options_.cone, medium_.texels.grid.voxel)};
  }

  const Scene& scene_;
  Surfaces surfaces_;
  const Caster& caster_;
  const Medium& medium_;
  const View& view_;
  const RenderOptions& options_;
  RayGenerator rays_;
  std::vector<Cone> cones_;
};

/// The planes that pixels are written to.
class Layers {
 public:
  explicit Layers(Image& image) {
    // All channels first: adding one may move the planes of the others.
    for (const char* layer : {"", "direct", "diffuse", "specular", "emission"}) image.add_layer(layer);
    image.add("ao.Y");
    image.add_layer("albedo");
    for (const char* channel : {"N.X", "N.Y", "N.Z", "Z"}) image.add(channel);
    color_ = image.layer(""), direct_ = image.layer("direct"), diffuse_ = image.layer("diffuse");
    specular_ = image.layer("specular"), emission_ = image.layer("emission"), albedo_ = image.layer("albedo");
    normal_ = {image.channel("N.X"), image.channel("N.Y"), image.channel("N.Z")};
    ao_ = image.channel("ao.Y"), depth_ = image.channel("Z");
  }
  void set(size_t pixel, const Seen& seen) const {
    const auto set3 = [pixel](const std::array<std::span<float>, 3>& planes, const glm::vec3& value) {
      for (int c = 0; c < 3; ++c) planes[size_t(c)][pixel] = value[c];
    };
    set3(color_, seen.color), set3(direct_, seen.direct), set3(diffuse_, seen.diffuse);
    set3(specular_, seen.specular), set3(emission_, seen.emission), set3(albedo_, seen.albedo);
    set3(normal_, seen.normal);
    ao_[pixel] = seen.ao, depth_[pixel] = seen.depth;
  }

 private:
  std::array<std::span<float>, 3> color_, direct_, diffuse_, specular_, emission_, albedo_, normal_;
  std::span<float> ao_, depth_;
};

void count_nonfinite(ConeImage& result) {
  const auto color = std::as_const(result.image).layer("");
  for (size_t i = 0; i < result.image.pixel_count(); ++i) {
    if (std::isfinite(color[0][i]) && std::isfinite(color[1][i]) && std::isfinite(color[2][i])) continue;
    const size_t width = size_t(result.image.width());
    if (result.nonfinite++ == 0)
      result.first_nonfinite = "pixel (" + std::to_string(i % width) + ", " + std::to_string(i / width) + ")";
  }
}

}  // namespace

ConeImage render_cones(const Scene& scene, const Caster& caster, const Medium& medium, const View& view,
                       const RenderOptions& options, const Progress& progress) {
  ConeImage result{Image(view.width, view.height), 0, {}};
  const Layers layers(result.image);
  const Renderer renderer(scene, caster, medium, view, options);

  constexpr int tile = 16;  // pixels: neighbours march through the same bricks
  const int tiles_x = (view.width + tile - 1) / tile, tiles_y = (view.height + tile - 1) / tile;
  const size_t tiles = size_t(tiles_x) * size_t(tiles_y);
  std::atomic<size_t> done{0};
  parallel_for(tiles, 1, [&](size_t index, size_t) {
    progress.check();
    const int x0 = static_cast<int>(index % size_t(tiles_x)) * tile,
              y0 = static_cast<int>(index / size_t(tiles_x)) * tile;
    for (int y = y0; y < std::min(y0 + tile, view.height); ++y)
      for (int x = x0; x < std::min(x0 + tile, view.width); ++x)
        layers.set(size_t(y) * size_t(view.width) + size_t(x), renderer.pixel(x, y));
    progress("cone trace", double(++done) / double(tiles));
  });
  count_nonfinite(result);
  return result;
}

}  // namespace voxref
