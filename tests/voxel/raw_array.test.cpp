#include "voxel/raw_array.h"

#include <algorithm>
#include <cstring>

#include "temporary_folder.h"
#include "voxel/array_bytes.h"

using namespace voxref;

namespace {

/// 4x3x2 texels of r32_float, every one different: the value says where it belongs.
constexpr int nx = 4, ny = 3, nz = 2;
float value(int x, int y, int z) { return float(100 * z + 10 * y + x + 1); }

/// @param order of the axes, slowest first, for instance "zyx" @param flipped axes that run backwards
std::string laid_out(const std::string& order, const std::string& flipped, size_t offset, size_t row_pitch,
                     size_t slice_pitch) {
  const auto place = [&](char axis, int index) {
    const int side = axis == 'x' ? nx : axis == 'y' ? ny : nz;
    const auto i = size_t(flipped.find(axis) == flipped.npos ? index : side - 1 - index);
    return i * (order[0] == axis ? slice_pitch : order[1] == axis ? row_pitch : 4);
  };
  std::string bytes;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const size_t at = offset + place('x', x) + place('y', y) + place('z', z);
        bytes.resize(std::max(bytes.size(), at + 4), '\x7f');
        const float v = value(x, y, z);
        std::memcpy(&bytes[at], &v, 4);
      }
  return bytes;
}

void check_values(const TemporaryFolder& folder, const std::string& content, const std::string& description) {
  CAPTURE(description);
  folder.write("a.raw.json", description);
  ArrayFile array(folder.write("a.raw", content));
  REQUIRE(array.shape() == std::array<size_t, 4>{nz, ny, nx, 1});
  const std::vector<float> values = read_all(array);
  bool same = true;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) same &= values[size_t((z * ny + y) * nx + x)] == value(x, y, z);
  CHECK(same);
}

const std::string dims = "\"dims\": [4, 3, 2]", format = "\"format\": \"r32_float\"";

/// @param members of a description of 4x3x2 floats; those named replace the usual ones
std::string complaint(const std::string& members, size_t bytes = 96) {
  const TemporaryFolder folder;
  folder.write("a.raw.json", members);
  return complaint_of_array(folder.write("a.raw", std::string(bytes, '\0')));
}
std::string with(const std::string& member) { return "{" + dims + ", " + format + ", " + member + "}"; }

}  // namespace

TEST_CASE("a raw array of every axis order, flip and pitch gives each texel its place", "[raw_array]") {
  const TemporaryFolder folder;
  std::string order = "xyz";
  do {
    for (const std::string flipped : {"", "x", "y", "z", "xz", "xyz"})
      for (const size_t gap : {0, 8}) {
        const auto side = [&](char axis) { return size_t(axis == 'x' ? nx : axis == 'y' ? ny : nz); };
        const size_t row_pitch = 4 * side(order[2]) + gap, slice_pitch = row_pitch * side(order[1]) + 3 * gap;
        std::string list, members = "{" + dims + ", " + format + ", \"axis_order\": \"" + order + "c\"";
        for (const char axis : flipped) list += (list.empty() ? "\"" : ", \"") + std::string(1, axis) + "\"";
        members += ", \"flip\": [" + list + "]";
        if (gap != 0)
          members += ", \"row_pitch\": " + std::to_string(row_pitch) +
                     ", \"slice_pitch\": " + std::to_string(slice_pitch) + ", \"offset\": " + std::to_string(gap);
        check_values(folder, laid_out(order, flipped, gap, row_pitch, slice_pitch), members + "}");
      }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("a raw array needs dims and format only, and an image two dims", "[raw_array]") {
  const TemporaryFolder folder;
  check_values(folder, laid_out("zyx", "", 0, 16, 48), "{" + dims + ", " + format + "}");
  folder.write("b.raw.json", R"({"dims": [2, 1], "format": "r8g8b8a8_unorm_srgb"})");
  ArrayFile image(folder.write("b.raw", counting_bytes(8)));
  CHECK(image.shape() == std::array<size_t, 4>{1, 1, 2, 4});
  CHECK(image.srgb());
  CHECK(read_all(image)[7] == 7.0f * (1.0f / 255.0f));
}

TEST_CASE("a raw array may end with its last texel, row gap or slice gap, and nowhere else", "[raw_array]") {
  const std::string gaps = with("\"row_pitch\": 20, \"slice_pitch\": 70");
  for (const size_t bytes : {70 + 56, 70 + 60, 70 + 70}) CHECK(complaint(gaps, bytes) == "read");
  CHECK(complaint(gaps, 125) == "holds 125 bytes instead of 126: truncated");
  for (const size_t bytes : {127, 139, 141}) CHECK(contains(complaint(gaps, bytes), " bytes instead of 126"));
  CHECK(contains(complaint("{" + dims + ", " + format + "}", 97), "holds 97 bytes instead of 96"));
}

TEST_CASE("a malformed description of a raw array is refused with the key", "[raw_array]") {
  CHECK(complaint("{" + dims + ", " + format + "}") == "read");
  CHECK(contains(complaint("{"), "byte 2: is not valid JSON"));
  CHECK(contains(complaint("[]"), "is not an object"));
  CHECK(contains(complaint("{" + format + "}"), "dims: is missing"));
  CHECK(contains(complaint("{" + dims + "}"), "format: is missing"));
  const auto with_dims = [](const std::string& text) { return complaint("{\"dims\": " + text + ", " + format + "}"); };
  CHECK(contains(with_dims("[4, 3, 2, 1]"), "dims: are not [nx, ny, nz]"));
  CHECK(contains(with_dims("[4]"), "dims: are not [nx, ny, nz]"));
  CHECK(contains(with_dims("24"), "dims: has the wrong type"));
  CHECK(contains(with_dims("[4.5, 3, 2]"), "dims: has the wrong type"));
  CHECK(contains(with_dims("[4, 3, 1e300]"), "dims: has the wrong type"));
  CHECK(contains(with_dims("[4, 3, 1e999]"), "number"));
  CHECK(contains(with_dims("[4, 3, 18446744073709551615]"), "dims: has the wrong type"));
  CHECK(contains(with_dims("[4, 3, 0]"), "dims: 0 is outside 1 to 65536"));
  CHECK(contains(with_dims("[4, 3, -2]"), "dims: -2 is outside"));
  CHECK(contains(with_dims("[65536, 65536, 65536]"), "truncated"));
  CHECK(contains(complaint("{" + dims + R"(, "format": "bc7"})"), "format: is none of r8g8b8a8_unorm, "));
  CHECK(contains(complaint(with("\"axis_order\": \"czyx\"")), "axis_order: is none of zyxc"));
  CHECK(contains(complaint(with("\"axis_order\": \"zzxc\"")), "axis_order: is none of"));
  CHECK(contains(complaint(with("\"flip\": [\"w\"]")), "flip: is not an array"));
  CHECK(contains(complaint(with("\"flip\": [\"\"]")), "flip: is not an array"));
  CHECK(contains(complaint(with("\"flip\": [\"x\", \"x\"]")), "flip: is not an array"));
  CHECK(contains(complaint(with("\"flip\": \"x\"")), "flip: has the wrong type"));
  CHECK(contains(complaint(with("\"row_pitch\": 15")), "row_pitch: 15 is outside 16"));
  CHECK(contains(complaint(with("\"slice_pitch\": 47")), "slice_pitch: 47 is outside 48"));
  CHECK(
      contains(complaint(with("\"slice_pitch\": 9223372036854775807")), "slice_pitch: 9223372036854775807 is outside"));
  CHECK(contains(with_dims("[1, 65536, 65536], \"row_pitch\": 4398046511104"), "row_pitch: makes slices"));
  CHECK(contains(complaint(with("\"offset\": -1")), "offset: -1 is outside 0"));
  CHECK(contains(complaint(with("\"row_ptich\": 16")), "row_ptich: is no key"));
  const TemporaryFolder folder;
  CHECK(contains(complaint_of_array(folder.write("a.raw", "")), "there is no such file"));
}
