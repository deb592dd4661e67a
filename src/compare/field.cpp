#include "compare/field.h"

namespace voxref {

Field field_of(const Image& image) {
  const auto planes = image.layer("");
  Field field{{image.width(), image.height(), 1}, 3, std::vector<float>(3 * image.pixel_count())};
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (size_t c = 0; c < 3; ++c) field.values[3 * i + c] = planes[c][i];
  return field;
}

}  // namespace voxref
