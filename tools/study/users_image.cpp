#include "study/users_image.h"

#include <fmt/format.h>

#include <cmath>

#include "error.h"
#include "image/linear_image.h"

namespace voxref {

Image read_users_image(const std::filesystem::path& file) {
  const auto wanted = [](std::string_view channel) { return channel == "R" || channel == "G" || channel == "B"; };
  Image image = read_linear_image(file, std::nullopt, wanted);
  if (!image.has_layer("")) throw Error(file.string(), "channels", "R, G and B are needed, and not all there");
  const auto planes = image.layer("");
  size_t count = 0, first = 0;
  for (size_t i = image.pixel_count(); i-- > 0;) {
    if (std::isfinite(planes[0][i]) && std::isfinite(planes[1][i]) && std::isfinite(planes[2][i])) continue;
    ++count;
    first = i;
  }
  if (count == 0) return image;
  const auto width = static_cast<size_t>(image.width());
  throw Error(file.string(), fmt::format("pixel ({}, {})", first % width, first / width),
              fmt::format("is not finite; {} of {} pixels are not", count, image.pixel_count()));
}

}  // namespace voxref
