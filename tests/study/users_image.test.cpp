#include "study/users_image.h"

#include <cmath>
#include <limits>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "image/image_file.h"
#include "temporary_folder.h"
#include "voxel/npy.h"

using namespace voxref;

namespace {

Image grey(float value) {
  Image image(4, 3);
  image.add_layer("");
  for (const auto& plane : image.layer("")) std::fill(plane.begin(), plane.end(), value);
  return image;
}

std::string complaint(const std::filesystem::path& file) {
  try {
    read_users_image(file);
    return "read";
  } catch (const Error& error) {
    CHECK(std::string(error.what()).starts_with(file.string() + ": "));
    return std::string(error.what()).substr(file.string().size() + 2);
  }
}

}  // namespace

TEST_CASE("A user's image is read as linear light from any file that diff reads", "[ladder]") {
  const TemporaryFolder folder;
  const auto exr = folder.path / "a.exr", npy = folder.path / "a.npy", png = folder.path / "a.png";
  Image image = grey(0.25f);
  image.add("Z");
  write_exr(exr, image);
  CHECK(read_users_image(exr).channel("G")[5] == 0.25f);
  CHECK(!read_users_image(exr).has("Z"));

  const std::array<size_t, 3> shape = {3, 4, 4};  // rows, columns, R,G,B,A
  write_npy(npy, ElementType::float32, shape,
            [](size_t, std::span<float> row) { std::fill(row.begin(), row.end(), 0.125f); });
  CHECK(read_users_image(npy).width() == 4);
  CHECK(read_users_image(npy).height() == 3);
  CHECK(read_users_image(npy).channel("B")[11] == 0.125f);

  // 188 of 255 is sRGB's code for 0.5, within half a step of 0.005.
  const std::vector<uint8_t> bytes(3 * 4 * 3, 188), file = encode_png(4, 3, bytes);
  write_text(png, std::string(file.begin(), file.end()));
  CHECK(read_users_image(png).channel("R")[0] == Approx(0.5f).margin(0.003));
}

TEST_CASE("A user's image without colours, or with a NaN or an infinity, is refused by file, place and number",
          "[ladder]") {
  const TemporaryFolder folder;
  const auto exr = folder.path / "a.exr";
  Image depth(4, 3);
  depth.add("Z");
  write_exr(exr, depth);
  CHECK(complaint(exr) == "channels: R, G and B are needed, and not all there");
  Image image = grey(1.0f);
  image.channel("B")[6] = std::numeric_limits<float>::quiet_NaN();
  image.channel("R")[9] = -std::numeric_limits<float>::infinity();
  write_exr(exr, image);
  CHECK(complaint(exr) == "pixel (2, 1): is not finite; 2 of 12 pixels are not");
  CHECK(complaint(folder.path / "absent.exr") != "read");
}
