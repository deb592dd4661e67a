#pragma once
#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "voxel/grid.h"

namespace voxref {

/// A triangle as the published vertex shader hands it on.
struct RasterTriangle {
  std::array<glm::vec3, 3> positions;  ///< world
  std::array<glm::vec3, 3> normals;
  std::array<glm::vec2, 3> uv;
  std::optional<std::array<glm::vec4, 3>> colors{};  ///< linear; none: white
};

/// One pixel of a triangle.
struct RasterFragment {
  glm::ivec3 voxel{0};     ///< may lie outside the grid
  glm::vec3 normal{0.0f};  ///< interpolated, not normalized
  glm::vec2 uv{0.0f};
  glm::vec4 color{1.0f};
};

/// The axis along which a triangle is drawn: the one with the strictly greatest component of its normal, z if none.
int dominant_axis(const std::array<glm::vec3, 3>& positions);

/// Three orthographic views of a cubic grid, from its +x, +y and +z sides, as many pixels wide as the grid has voxels.
/// They look at the centre of the box that the grid covers: where the box is no cube, pixels and voxels are not in
/// line.
class RasterViews {
 public:
  /// @param grid a cube
  explicit RasterViews(const Grid& grid);
  const Grid& grid() const { return grid_; }
  const glm::mat4& project(int axis) const { return project_[size_t(axis)]; }      ///< world to NDC
  const glm::mat4& unproject(int axis) const { return unproject_[size_t(axis)]; }  ///< NDC to world

 private:
  Grid grid_;
  std::array<glm::mat4, 3> project_, unproject_;
};

/// A triangle grown by half a pixel on each side, ready to be drawn: thesis 2.1 after Hasselgren et al. 2005,
/// "Conservative Rasterization". All of spec section 2 (raster), steps 1 to 4: float32 like the shaders, whose rounding
/// decides where a plane passes close to a voxel's face.
class DilatedTriangle {
 public:
  /// None where the triangle has no area or is seen edge-on, and so vanishes.
  static std::optional<DilatedTriangle> make(const RasterTriangle& triangle, const RasterViews& views);

  /// Rows of pixels that it may cover: [first, second), inside the view.
  std::array<int, 2> rows() const { return rows_; }
  size_t most_per_row() const { return size_t(columns_[1] - columns_[0]); }  ///< pixels
  /// Calls visit(fragment) for its pixels in rows [begin, end), row by row.
  template <class Visit>
  void for_each_fragment(int begin, int end, Visit&& visit) const;

 private:
  static constexpr size_t attributes = 8;  // position in voxels, normal, texture coordinate
  /// Linear over the view: at (x, y), in pixels from the centre of pixel (0, 0), it is a + b x + c y.
  struct Linear {
    double a = 0.0, b = 0.0, c = 0.0;
    double operator()(double x, double y) const { return a + b * x + c * y; }
  };
  /// Positive inside; on the line itself a pixel belongs to the triangle on one side alone.
  struct Edge {
    Linear distance;
    bool owns_line = false;
    bool operator()(double x, double y) const {
      const double d = distance(x, y);
      return d > 0.0 || (d == 0.0 && owns_line);
    }
  };

  void set_edges(const std::array<glm::vec2, 3>& window);

  std::array<int, 2> rows_{}, columns_{};
  std::array<Edge, 3> edges_;
  Linear depth_;  ///< NDC
  std::array<Linear, attributes> values_;
  std::optional<std::array<Linear, 4>> color_;
};

template <class Visit>
void DilatedTriangle::for_each_fragment(int begin, int end, Visit&& visit) const {
  for (int row = begin; row < end; ++row)
    for (int column = columns_[0]; column < columns_[1]; ++column) {
      const double x = column, y = row;
      if (!edges_[0](x, y) || !edges_[1](x, y) || !edges_[2](x, y)) continue;
      const double z = depth_(x, y);
      if (!(z >= -1.0 && z <= 1.0)) continue;  // near and far plane
      std::array<float, attributes> v;
      for (size_t i = 0; i < attributes; ++i) v[i] = float(values_[i](x, y));
      // Conversion truncates towards zero, and so would take (-1,0) into voxel 0, as the shader's does.
      RasterFragment fragment{{int(v[0]), int(v[1]), int(v[2])}, {v[3], v[4], v[5]}, {v[6], v[7]}};
      if (color_)
        for (size_t i = 0; i < 4; ++i) fragment.color[int(i)] = float((*color_)[i](x, y));
      visit(fragment);
    }
}

}  // namespace voxref
