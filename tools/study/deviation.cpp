#include "study/deviation.h"

#include <algorithm>
#include <cmath>

namespace voxref {

namespace {

void add_layer(const Image& image, const char* layer, std::vector<double>& values) {
  const auto planes = image.layer(layer);
  values.resize(image.pixel_count());
  for (size_t i = 0; i < values.size(); ++i) values[i] += luminance({planes[0][i], planes[1][i], planes[2][i]});
}

}  // namespace

double Measured::mean() const {
  double sum = 0.0;
  for (const double v : value) sum += v;
  return sum / static_cast<double>(value.size());
}

bool compares_indirect(const Scene& scene, const View& view) {
  return !scene.has_emission() && view.background == glm::vec3(0.0f);
}

Measured measured_cone(const Image& cone, bool indirect) {
  Measured result;
  if (indirect) {
    add_layer(cone, "diffuse", result.value);
    add_layer(cone, "specular", result.value);
  } else {
    add_layer(cone, "", result.value);
  }
  result.standard_error.assign(result.value.size(), 0.0);
  return result;
}

Measured measured_path(const Image& path, bool indirect) {
  Measured result;
  add_layer(path, indirect ? "indirect" : "", result.value);
  const auto errors = path.channel(indirect ? "stderr.indirect.Y" : "stderr.Y");
  result.standard_error.assign(errors.begin(), errors.end());
  return result;
}

Deviation deviation(const Measured& a, const Measured& b) {
  const auto count = static_cast<double>(b.value.size());
  double square = 0.0, noise = 0.0, moved = 0.0;
  for (size_t i = 0; i < b.value.size(); ++i) {
    const double d = a.value[i] - b.value[i];
    const double s2 = a.standard_error[i] * a.standard_error[i] + b.standard_error[i] * b.standard_error[i];
    square += d * d / count;
    noise += s2 / count;
    moved += d * d * s2;
  }
  const double mean = b.mean();
  Deviation result;
  result.bias = a.mean() / mean - 1.0;
  result.rel_error = std::sqrt(std::max(0.0, square - noise)) / mean;
  result.rel_error_error = square > 0.0 ? std::sqrt(moved / square) / count / mean : 0.0;
  return result;
}

}  // namespace voxref
