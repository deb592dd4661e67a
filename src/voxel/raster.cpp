#include "voxel/raster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace voxref {

namespace {

constexpr float subpixels = 256.0f;  // positions of vertices are known to 8 bits

/// The line through two points of the view, growing by half a pixel `p` away from the inside.
glm::vec3 dilated_line(const glm::vec4& from, const glm::vec4& to, float p) {
  const glm::vec3 a(from.x, from.y, from.w), b(to.x, to.y, to.w);
  glm::vec3 line = glm::cross(b - a, a);
  line.z -= p * (std::abs(line.x) + std::abs(line.y));
  return line;
}

glm::vec2 intersection(const glm::vec3& line, const glm::vec3& next) {
  const glm::vec3 point = glm::cross(line, next);
  return glm::vec2(point) / point.z;
}

/// First and last pixel whose centre is in [low, high] NDC, inside a view of `size` pixels, as a half-open range.
std::array<int, 2> pixels_between(float low, float high, int size) {
  const auto center = [size](int pixel) { return (float(pixel) + 0.5f) * (2.0f / float(size)) - 1.0f; };
  const auto near = [size](float ndc) { return int(std::clamp((ndc + 1.0f) * 0.5f * float(size), 0.0f, float(size))); };
  int begin = std::max(near(low) - 1, 0), end = std::min(near(high) + 1, size);
  while (begin < end && center(begin) < low) ++begin;
  while (end > begin && center(end - 1) > high) --end;
  return {begin, end};
}

}  // namespace

int dominant_axis(const std::array<glm::vec3, 3>& positions) {
  const glm::vec3 n = glm::abs(glm::cross(positions[1] - positions[0], positions[2] - positions[0]));
  if (n.x > n.y && n.x > n.z) return 0;
  if (n.y > n.x && n.y > n.z) return 1;
  return 2;
}

RasterViews::RasterViews(const Grid& grid) : grid_(grid) {
  const float side = grid.voxel * float(grid.size.x), half = 0.5f * side;
  const glm::vec3 center = grid.box_center.value_or(grid.min + half);
  const glm::vec3 up[3] = {{0, 1, 0}, {0, 0, -1}, {0, 1, 0}};
  const glm::mat4 projection = glm::ortho(-half, half, -half, half, 0.0f, side);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 eye = center;
    eye[axis] += half;
    project_[size_t(axis)] = projection * glm::lookAt(eye, center, up[axis]);
    unproject_[size_t(axis)] = glm::inverse(project_[size_t(axis)]);
  }
}

void DilatedTriangle::set_edges(const std::array<glm::vec2, 3>& window) {
  std::array<glm::dvec2, 3> v;
  for (size_t i = 0; i < 3; ++i)
    v[i] = glm::dvec2(std::nearbyint(window[i].x * subpixels), std::nearbyint(window[i].y * subpixels)) /
           double(subpixels);
  const double area = (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (v[1].y - v[0].y);
  if (area < 0.0) std::swap(v[1], v[2]);
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec2 from = v[i], along = v[(i + 1) % 3] - from;
    // Counter-clockwise with y upwards: left edges go down, and top edges lie level and go left.
    edges_[i] = {{along.y * from.x - along.x * from.y, -along.y, along.x},
                 along.y < 0.0 || (along.y == 0.0 && along.x < 0.0)};
  }
}

std::optional<DilatedTriangle> DilatedTriangle::make(const RasterTriangle& triangle, const RasterViews& views) {
  const int axis = dominant_axis(triangle.positions), size = views.grid().size.x;
  std::array<glm::vec4, 3> corner;
  std::array<glm::vec2, 3> uv = triangle.uv;
  std::optional<std::array<glm::vec4, 3>> colors = triangle.colors;
  for (size_t i = 0; i < 3; ++i) corner[i] = views.project(axis) * glm::vec4(triangle.positions[i], 1.0f);
  const glm::vec3 first(corner[0]);
  const glm::vec3 normal = glm::normalize(glm::cross(glm::vec3(corner[1]) - first, glm::vec3(corner[2]) - first));
  if (!(normal.z != 0.0f) || std::isnan(normal.z)) return std::nullopt;
  if (normal.z < 0.0f) {  // the normals keep their places: the published shader forgets them
    std::swap(corner[1], corner[2]);
    std::swap(uv[1], uv[2]);
    if (colors) std::swap((*colors)[1], (*colors)[2]);
  }

  const float p = 1.0f / float(size);
  const glm::vec2 low = glm::min(glm::min(glm::vec2(corner[0]), glm::vec2(corner[1])), glm::vec2(corner[2])) - p;
  const glm::vec2 high = glm::max(glm::max(glm::vec2(corner[0]), glm::vec2(corner[1])), glm::vec2(corner[2])) + p;
  const glm::vec3 lines[3] = {dilated_line(corner[2], corner[0], p), dilated_line(corner[0], corner[1], p),
                              dilated_line(corner[1], corner[2], p)};

  DilatedTriangle result;
  result.columns_ = pixels_between(low.x, high.x, size);
  result.rows_ = pixels_between(low.y, high.y, size);
  const float plane = -glm::dot(first, normal);
  std::array<glm::vec2, 3> window;  // in pixels, from the centre of pixel (0, 0)
  std::array<std::array<float, attributes>, 3> value;
  std::array<float, 3> depth;
  const glm::vec3 minimum = views.grid().min;
  const float scale = 1.0f / (views.grid().voxel * float(size));  // a product: a quotient may round a wall away
  for (size_t i = 0; i < 3; ++i) {
    const glm::vec2 xy = intersection(lines[i], lines[(i + 1) % 3]);
    depth[i] = -(xy.x * normal.x + xy.y * normal.y + plane) / normal.z;
    window[i] = (xy * 0.5f + 0.5f) * float(size) - 0.5f;
    const glm::vec4 world = views.unproject(axis) * glm::vec4(xy, depth[i], 1.0f);
    const glm::vec3 voxel = (glm::vec3(world) / world.w - minimum) * scale * float(size);
    value[i] = {voxel.x, voxel.y, voxel.z, triangle.normals[i].x, triangle.normals[i].y, triangle.normals[i].z,
                uv[i].x, uv[i].y};
  }
  result.set_edges(window);

  const glm::dvec2 origin(window[0]), along = glm::dvec2(window[1]) - origin, across = glm::dvec2(window[2]) - origin;
  const double area = along.x * across.y - across.x * along.y;
  const auto linear = [&](float at0, float at1, float at2) {
    const double d1 = double(at1) - at0, d2 = double(at2) - at0;
    const double b = (d1 * across.y - d2 * along.y) / area, c = (d2 * along.x - d1 * across.x) / area;
    return Linear{at0 - b * origin.x - c * origin.y, b, c};
  };
  result.depth_ = linear(depth[0], depth[1], depth[2]);
  for (size_t k = 0; k < attributes; ++k) result.values_[k] = linear(value[0][k], value[1][k], value[2][k]);
  if (colors) {
    std::array<Linear, 4> channels;
    for (int k = 0; k < 4; ++k) channels[size_t(k)] = linear((*colors)[0][k], (*colors)[1][k], (*colors)[2][k]);
    result.color_ = channels;
  }
  return result;
}

}  // namespace voxref
