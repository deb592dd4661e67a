#include "voxel/raster_fragments.h"

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>
#include <optional>

#include "parallel.h"
#include "scene/phong_material.h"
#include "voxel/raster.h"

namespace voxref {

namespace {

/// Rows of one triangle's pixels: large triangles are cut, so that several threads can draw them.
struct Rows {
  uint32_t triangle;
  int begin, end;
  size_t most_fragments;
};
constexpr int rows_per_task = 16;
constexpr size_t tasks_per_chunk = 32;  // small triangles are a task each

/// Texture, factors and the rest of what the published fragment shader does.
class FragmentShader {
 public:
  FragmentShader(const Scene& scene, const Grid& grid) : scene_(scene), grid_(grid) {
    for (const Material& material : scene.materials) {
      bindings_.push_back(material.base_color_texture);
      bindings_.back().srgb = false;
    }
  }

  RasterTriangle triangle(uint32_t index) const {
    RasterTriangle result;
    const auto& uv = scene_.uv[size_t(bindings_[scene_.triangle_materials[index]].uv_set)];
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t vertex = scene_.triangles[index][int(i)];
      result.positions[i] = scene_.positions[vertex];
      result.normals[i] = scene_.normals[vertex];
      result.uv[i] = uv.empty() ? glm::vec2(0.0f) : uv[vertex];
    }
    if (!scene_.colors.empty()) {
      const glm::uvec3& corners = scene_.triangles[index];
      result.colors = {scene_.colors[corners.x], scene_.colors[corners.y], scene_.colors[corners.z]};
    }
    return result;
  }

  /// What the pixel writes, if anything.
  std::optional<FragmentValue> operator()(uint32_t triangle, const RasterFragment& pixel) const {
    const uint32_t index = scene_.triangle_materials[triangle];
    const Material& material = scene_.materials[index];
    const glm::vec4 texel = texture(bindings_[index], pixel.uv);
    const float opacity = material.base_color.a * texel.a * pixel.color.a;
    if (!(opacity > 0.0f)) return std::nullopt;
    const glm::vec3 color(texel);
    return FragmentValue{diffuse(material, pixel.uv) * glm::vec3(pixel.color) * color * opacity,
                         0.5f * unit(pixel.normal) + 0.5f, material.emission * color};
  }
  bool textured(uint32_t triangle) const {
    const uint32_t index = scene_.triangle_materials[triangle];
    return bindings_[index] || scene_.materials[index].metallic_roughness_texture;
  }
  const Grid& grid() const { return grid_; }

 private:
  /// Where the normals of corners cancel there is no direction, and the shader's result is undefined: zero.
  static glm::vec3 unit(const glm::vec3& normal) {
    return glm::dot(normal, normal) > 0.0f ? glm::normalize(normal) : glm::vec3(0.0f);
  }
  glm::vec4 texture(const TextureBinding& binding, const glm::vec2& uv) const {
    return binding ? lookup(scene_.images[size_t(binding.image)], binding, uv) : glm::vec4(1.0f);
  }
  /// Kd without its texture.
  glm::vec3 diffuse(const Material& material, const glm::vec2& uv) const {
    return glm::vec3(material.base_color) * diffuse_share(material, texture(material.metallic_roughness_texture, uv).b);
  }

  const Scene& scene_;
  const Grid& grid_;
  std::vector<TextureBinding> bindings_;  // of the base colour, one per material
};

/// Writes the pixels of one triangle.
class FragmentWriter {
 public:
  FragmentWriter(const FragmentShader& shader, uint32_t triangle, VoxelFragments& written)
      : shader_(shader), triangle_(triangle), textured_(shader.textured(triangle)), written_(written) {}

  void operator()(const RasterFragment& pixel) {
    if (!shader_.grid().contains(pixel.voxel)) return;
    if (!shaded_ || !same_value(pixel)) shade(pixel);
    if (visible_) written_.fragments.push_back({glm::u16vec3(pixel.voxel), uint32_t(written_.values.size() - 1)});
  }

 private:
  /// As the pixel that was shaded last.
  bool same_value(const RasterFragment& pixel) const {
    return pixel.normal == last_.normal && pixel.color == last_.color && (!textured_ || pixel.uv == last_.uv);
  }
  void shade(const RasterFragment& pixel) {
    shaded_ = true;
    last_ = pixel;
    const std::optional<FragmentValue> value = shader_(triangle_, pixel);
    visible_ = value.has_value();
    if (visible_) written_.values.push_back(*value);
  }

  const FragmentShader& shader_;
  uint32_t triangle_;
  bool textured_, shaded_ = false, visible_ = false;
  RasterFragment last_;
  VoxelFragments& written_;
};

}  // namespace

std::vector<VoxelFragments> draw_fragments(const Scene& scene, const Grid& grid, bool dynamic,
                                           const Progress& progress) {
  const RasterViews views(grid);
  const FragmentShader shader(scene, grid);
  std::vector<Rows> tasks;
  for (const Object& object : scene.objects)
    if (object.dynamic == dynamic)
      for (uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t)
        if (const auto triangle = DilatedTriangle::make(shader.triangle(t), views))
          for (int row = triangle->rows()[0]; row < triangle->rows()[1]; row += rows_per_task)
            tasks.push_back(
                {t, row, std::min(row + rows_per_task, triangle->rows()[1]), triangle->most_per_row() * rows_per_task});

  std::vector<VoxelFragments> chunks((tasks.size() + tasks_per_chunk - 1) / tasks_per_chunk);
  std::atomic<size_t> done = 0;
  parallel_for(tasks.size(), tasks_per_chunk, [&](size_t begin, size_t end) {
    progress.check();
    VoxelFragments& written = chunks[begin / tasks_per_chunk];
    size_t most = 0;
    for (size_t i = begin; i < end; ++i) most += tasks[i].most_fragments;
    written.fragments.reserve(most);  // pages that are not used are never touched
    for (size_t i = begin; i < end; ++i) {
      const Rows& rows = tasks[i];
      const auto triangle = DilatedTriangle::make(shader.triangle(rows.triangle), views);
      triangle->for_each_fragment(rows.begin, rows.end, FragmentWriter(shader, rows.triangle, written));
    }
    progress("voxelize", double(done += end - begin) / double(tasks.size()));
  });
  return chunks;
}

}  // namespace voxref
