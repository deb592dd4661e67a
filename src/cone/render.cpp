#include "cone/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "parallel.h"

namespace voxref {
namespace {

/// What rays through the image see, summed: the layers of the image.
struct Seen {
  PixelLight light{.ao = 0.0f};
  glm::vec3 albedo{0.0f}, normal{0.0f};
  float depth = 0.0f, rays = 0.0f, hits = 0.0f;

  Seen& operator+=(const Seen& other) {
    light.color += other.light.color, light.direct += other.light.direct, light.diffuse += other.light.diffuse;
    light.specular += other.light.specular, light.emission += other.light.emission, light.ao += other.light.ao;
    albedo += other.albedo, normal += other.normal;
    depth += other.depth, rays += other.rays, hits += other.hits;
    return *this;
  }
  /// Light is the mean over all rays; albedo, normal and depth are those of what was hit, 0 where nothing was.
  Seen mean() const {
    const float all = 1.0f / rays, hit = hits > 0.0f ? 1.0f / hits : 0.0f;
    return {{light.color * all, light.direct * all, light.diffuse * all, light.specular * all, light.emission * all,
             light.ao * all},
            albedo * hit,
            normal * hit,
            depth * hit,
            1.0f,
            hits * all};
  }
};

/// Everything that pixels share.
class Renderer {
 public:
  Renderer(const LitScene& lit, const View& view, const RenderOptions& options)
      : view_(view),
        gbuffer_(lit.scene, lit.caster, view, options.gbuffer),
        shade_(lit, options, view.background),
        phong_(options.pixel.brdf == PixelBrdf::blinn_phong) {}

  /// Mean over the pixel's positions.
  Seen pixel(int x, int y) const {
    const int side = positions_per_side(view_.pixel);
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
    Seen seen;
    seen.rays = seen.light.ao = 1.0f;
    const std::optional<GBufferPoint> point = gbuffer_(where);
    if (!point) {
      seen.light.color = seen.light.emission = view_.background;
      return seen;
    }
    seen.hits = 1.0f;
    seen.light = shade_(*point);
    seen.normal = point->normal;
    seen.depth = point->depth;
    const Reflectance& reflectance = point->reflectance;  // as the path tracer
    seen.albedo =
        phong_ ? point->phong.diffuse : reflectance.diffuse * (1.0f - reflectance.layer_f0) + reflectance.specular_f0;
    return seen;
  }

  const View& view_;
  GBuffer gbuffer_;
  PixelShader shade_;
  bool phong_;
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
    const PixelLight& light = seen.light;
    set3(color_, light.color), set3(direct_, light.direct), set3(diffuse_, light.diffuse);
    set3(specular_, light.specular), set3(emission_, light.emission), set3(albedo_, seen.albedo);
    set3(normal_, seen.normal);
    ao_[pixel] = light.ao, depth_[pixel] = seen.depth;
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

ConeImage render_cones(const LitScene& lit, const View& view, const RenderOptions& options, const Progress& progress) {
  ConeImage result{Image(view.width, view.height), 0, {}};
  const Layers layers(result.image);
  const Renderer renderer(lit, view, options);

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
