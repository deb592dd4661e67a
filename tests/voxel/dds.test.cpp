#include "voxel/dds.h"

#include <cmath>

#include "temporary_folder.h"
#include "voxel/array_bytes.h"

using namespace voxref;

namespace {

constexpr uint32_t dx10 = 0x30315844;  // "DX10", least byte first

/// The fields of the headers that matter, at what they are for a volume as RenderDoc saves it.
struct Dds {
  uint32_t width = 4, height = 3, depth = 2, mips = 1, format = 28, dimension = 4;
  uint32_t caps2 = 0x200000, misc = 0, array_size = 1, four_cc = dx10;
  uint32_t magic = 0x20534444, size = 124, format_size = 32;

  /// The DX10 extension is left out where the four characters are others. @param masks bit count, red, green, blue,
  /// alpha
  std::string header(std::initializer_list<uint32_t> masks = {0, 0, 0, 0, 0}) const {
    const bool masked = four_cc == 0;
    std::string bytes = words({magic, size, 0x80100f, height, width, 0, depth, mips});
    bytes += std::string(44, '\0') + words({format_size, masked ? 0x41u : 4u, four_cc}) + words(masks);
    bytes += words({0x1000, caps2, 0, 0, 0});
    if (four_cc == dx10) bytes += words({format, dimension, misc, array_size, 0});
    return bytes;
  }
};

/// A 2D texture.
Dds picture(uint32_t format) { return {.depth = 1, .format = format, .dimension = 3, .caps2 = 0}; }

std::vector<float> values_of(const std::string& content, int mip = 0) {
  const TemporaryFolder folder;
  ArrayFile array(folder.write("a.dds", content), mip);
  return read_all(array);
}

std::string complaint(const std::string& content, int mip = 0) {
  const TemporaryFolder folder;
  return complaint_of_array(folder.write("a.dds", content), mip);
}

}  // namespace

TEST_CASE("a DDS volume of 4x3x2 texels is read slice by slice, row by row", "[dds]") {
  const TemporaryFolder folder;
  ArrayFile array(folder.write("a.dds", Dds().header() + counting_bytes(96)));
  CHECK(array.shape() == std::array<size_t, 4>{2, 3, 4, 4});
  CHECK(array.type() == ElementType::uint8);
  CHECK(array.mip_count() == 1);
  CHECK(!array.srgb());
  std::vector<float> slice(48);
  for (const size_t z : {1, 0}) {
    array.read_slice(z, slice);
    for (size_t y = 0; y < 3; ++y)
      for (size_t x = 0; x < 4; ++x)
        for (size_t c = 0; c < 4; ++c)
          CHECK(slice[(y * 4 + x) * 4 + c] == float(c + 4 * x + 16 * y + 48 * z) * (1.0f / 255.0f));
  }
}

TEST_CASE("each mip level of a DDS file is read, all slices of one before the next", "[dds]") {
  const Dds volume{.width = 5, .height = 2, .depth = 3, .mips = 3, .format = 61};  // 30 bytes, then 2x1x1, then 1
  const std::string content = volume.header() + counting_bytes(33);
  const TemporaryFolder folder;
  CHECK(ArrayFile(folder.write("a.dds", content), 1).shape() == std::array<size_t, 4>{1, 1, 2, 1});
  CHECK(ArrayFile(folder.path / "a.dds", 2).mip_count() == 3);
  CHECK(values_of(content).size() == 30);
  CHECK(values_of(content)[29] == 29.0f * (1.0f / 255.0f));
  CHECK(values_of(content, 1) == std::vector<float>{30.0f * (1.0f / 255.0f), 31.0f * (1.0f / 255.0f)});
  CHECK(values_of(content, 2) == std::vector<float>{32.0f * (1.0f / 255.0f)});
}

TEST_CASE("each format of a DDS file is decoded", "[dds]") {
  Dds one = picture(0);
  one.width = one.height = 1;
  const auto texel = [&](uint32_t format, std::initializer_list<uint32_t> content) {
    one.format = format;
    return values_of(one.header() + words(content));
  };
  const std::vector<float> bytes = {17.0f * (1.0f / 255.0f), 34.0f * (1.0f / 255.0f), 51.0f * (1.0f / 255.0f), 1.0f};
  for (const uint32_t eight_bits : {28, 29, 42}) CHECK(texel(eight_bits, {0xff332211}) == bytes);  // red is lowest
  CHECK(texel(10, {0xc0003c00, 0x7c000001}) == std::vector<float>{1.0f, -2.0f, 0x1p-24f, INFINITY});
  CHECK(texel(2, {0x3f800000, 0xc0000000, 0x7f800000, 1}) == std::vector<float>{1.0f, -2.0f, INFINITY, 0x1p-149f});
  CHECK(texel(6, {0x3f800000, 0xc0000000, 0}) == std::vector<float>{1.0f, -2.0f, 0.0f});
  CHECK(texel(41, {0x40490fdb}) == std::vector<float>{3.14159274f});
  CHECK(std::isnan(texel(41, {0x7fc00000})[0]));

  const TemporaryFolder folder;
  one.format = 29;
  CHECK(ArrayFile(folder.write("a.dds", one.header() + words({0}))).srgb());
}

TEST_CASE("a DDS file without the DX10 header, as RenderDoc writes r8g8b8a8_unorm and r8_unorm, is read", "[dds]") {
  const std::initializer_list<uint32_t> rgba = {32, 0xff, 0xff00, 0xff0000, 0xff000000}, red = {8, 0xff, 0, 0, 0};
  const Dds volume{.four_cc = 0};
  CHECK(values_of(volume.header(rgba) + counting_bytes(96)) == values_of(Dds().header() + counting_bytes(96)));
  CHECK(values_of(volume.header(red) + counting_bytes(24))[23] == 23.0f * (1.0f / 255.0f));
  CHECK(contains(complaint(volume.header({32, 0xff0000, 0xff00, 0xff, 0xff000000}) + counting_bytes(96)),
                 "header: bit masks of 32 bits"));
  CHECK(contains(complaint(volume.header({16, 0xff, 0xff00, 0, 0}) + counting_bytes(96)), "bit masks of 16 bits"));
}

TEST_CASE("a malformed DDS file is refused with its name and the reason", "[dds]") {
  const std::string texels = counting_bytes(96);
  CHECK(complaint(Dds().header() + texels) == "read");
  CHECK(complaint("") == "header: ends too early");
  CHECK(complaint(Dds().header().substr(0, 140)) == "header: ends too early");
  const std::string short_header = Dds{.four_cc = 0}.header();
  CHECK(contains(complaint(short_header.substr(0, short_header.size() - 1)), "ends too early"));
  CHECK(contains(complaint(Dds().header() + texels.substr(1)), "holds 243 bytes instead of 244: truncated"));
  CHECK(complaint(Dds().header() + texels + "x") == "holds 245 bytes instead of 244");
  CHECK(contains(complaint(Dds().header() + texels, 1), "mip 1: is not there: the file has 1"));
  CHECK(contains(complaint(Dds().header() + texels, -1), "mip -1: is not there"));

  struct Case {
    Dds file;
    std::string reason;
  };
  const Case cases[] = {
      {{.magic = 0x20534445}, "is not that of a DDS file"},
      {{.size = 123}, "is not that of a DDS file"},
      {{.format_size = 31}, "is not that of a DDS file"},
      {{.width = 0}, "side of 0"},
      {{.height = 0}, "side of 0"},
      {{.depth = 0}, "is of a volume without depth"},
      {{.width = 0xffffffff}, "side of 4294967295"},
      {{.width = 65536, .height = 65536, .depth = 65536, .format = 2}, "truncated"},
      {{.mips = 4}, "4 mip levels"},
      {{.mips = 0xffffffff}, "4294967295 mip levels"},
      {{.format = 98}, "DXGI format 98 is none of r8g8b8a8_unorm, "},
      {{.dimension = 2}, "dimension 2"},
      {{.dimension = 3}, "is of a 2D texture and of a volume"},
      {{.misc = 4}, "cube map"},
      {{.caps2 = 0xfe00}, "cube map"},
      {{.array_size = 6}, "array of 6 textures"},
      {{.array_size = 0}, "array of 0 textures"},
      {{.four_cc = 0x31545844}, "format 'DXT1' is none of"},
      {{.four_cc = 10}, "format '....' is none of"},
      {{.caps2 = 0, .four_cc = 0}, "bit masks of 0 bits"},
  };
  for (const Case& test : cases) {
    CAPTURE(test.reason);
    CHECK(contains(complaint(test.file.header() + texels), test.reason));
  }
}
