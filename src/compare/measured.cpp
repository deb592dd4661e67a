#include "compare/measured.h"

#include "compare/statistics.h"

namespace voxref {

namespace {

void add_layer(const Image& image, const char* layer, std::vector<double>& values) {
  const auto planes = image.layer(layer);
  values.resize(image.pixel_count());
  for (size_t i = 0; i < values.size(); ++i) values[i] += double{luminance({planes[0][i], planes[1][i], planes[2][i]})};
}

}  // namespace

double Measured::mean() const { return voxref::mean(value); }

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

}  // namespace voxref
