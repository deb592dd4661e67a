#include "image/linear_image.h"

#include <cmath>
#include <cstdlib>

#include "catch.h"
#include "error.h"
#include "temporary_folder.h"
#include "voxel/npy.h"

using namespace voxref;

namespace {

using Names = std::vector<std::string>;

std::string little_endian(std::initializer_list<uint32_t> values, int bytes) {
  std::string text;
  for (const uint32_t value : values)
    for (int i = 0; i < bytes; ++i) text += char(value >> 8 * i & 0xff);
  return text;
}

/// An uncompressed TIFF of one row of RGB, 8 bits, or 32 as floats, that says nothing of its transfer.
std::string tiff(const std::string& row, uint32_t bits) {
  const auto width = uint32_t(row.size() / 3 / (bits / 8));
  const uint32_t end = 8 + uint32_t(row.size()), bits_at = end + 2 + 11 * 12 + 4;
  const auto entry = [](uint32_t tag, uint32_t type, uint32_t count, uint32_t value) {
    return little_endian({tag, type}, 2) + little_endian({count, value}, 4);
  };
  return "II" + little_endian({42}, 2) + little_endian({end}, 4) + row + little_endian({11}, 2) +
         entry(256, 4, 1, width) + entry(257, 4, 1, 1) + entry(258, 3, 3, bits_at) + entry(259, 3, 1, 1) +
         entry(262, 3, 1, 2) + entry(273, 4, 1, 8) + entry(277, 3, 1, 3) + entry(278, 4, 1, 1) +
         entry(279, 4, 1, uint32_t(row.size())) + entry(284, 3, 1, 1) + entry(339, 3, 1, bits == 32 ? 3 : 1) +
         little_endian({0}, 4) + little_endian({bits, bits, bits}, 2);
}

/// Runs OpenImageIO's tool, which is among voxref's dependencies, to make files that voxref does not write.
bool oiiotool(const std::string& arguments) {
  return std::system(("oiiotool " + arguments + " > /dev/null 2>&1").c_str()) == 0;
}

std::string complaint(const std::filesystem::path& file, std::optional<Transfer> transfer = {}) {
  try {
    read_linear_image(file, transfer);
    return "read";
  } catch (const Error& error) {
    const std::string what = error.what();
    CHECK(what.starts_with(file.string() + ": "));
    CHECK(what.find('\n') == what.npos);
    return what;
  }
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

}  // namespace

TEST_CASE("transfers have their published values, and sRGB is undone as it is done", "[transfer]") {
  CHECK(srgb_decode(0.0f) == 0.0f);
  CHECK(srgb_decode(1.0f) == 1.0f);
  CHECK(srgb_decode(188.0f / 255.0f) == Approx(0.502886).epsilon(1e-5));  // worked out by hand from IEC 61966-2-1
  for (int i = 0; i < 256; ++i) CHECK(std::lround(255.0f * srgb_encode(srgb_decode(float(i) / 255.0f))) == i);
  CHECK(decode(Transfer::gamma22, 0.5f) == Approx(0.217638).epsilon(1e-5));
  CHECK(decode(Transfer::gamma22, -0.5f) == -decode(Transfer::gamma22, 0.5f));
  CHECK(std::isnan(decode(Transfer::srgb, std::nanf(""))));
  CHECK(transfer_called("srgb") == Transfer::srgb);
  CHECK(!transfer_called("sRGB8"));
}

TEST_CASE("integers are decoded as sRGB unless the caller says otherwise, floats never", "[linear_image]") {
  const TemporaryFolder folder;
  const auto bytes = folder.write("bytes.tif", tiff(std::string("\x00\xbc\xff\x0a\x7f\x80", 6), 8));
  // By Approx (1e-5 of the value), because OpenImageIO rounds byte / 255 in its own way; so below.
  const Image image = read_linear_image(bytes);
  REQUIRE(image.channels() == Names{"R", "G", "B"});
  CHECK(image.channel("R")[0] == 0.0f);
  CHECK(image.channel("G")[0] == Approx(srgb_decode(188.0f / 255.0f)));
  CHECK(image.channel("B")[0] == 1.0f);
  CHECK(image.channel("R")[1] == Approx(srgb_decode(10.0f / 255.0f)));
  CHECK(read_linear_image(bytes, Transfer::linear).channel("G")[1] == Approx(127.0f / 255.0f));
  CHECK(read_linear_image(bytes, Transfer::gamma22).channel("B")[1] == Approx(std::pow(128.0f / 255.0f, 2.2f)));

  const auto floats = folder.write("floats.tif", tiff(little_endian({0x3f000000, 0xbf800000, 0x7fc00000}, 4), 32));
  const Image as_is = read_linear_image(floats);
  CHECK(as_is.channel("R")[0] == 0.5f);
  CHECK(as_is.channel("G")[0] == -1.0f);
  CHECK(std::isnan(as_is.channel("B")[0]));
  CHECK(read_linear_image(floats, Transfer::srgb).channel("R")[0] == Approx(srgb_decode(0.5f)));
}

TEST_CASE("a Radiance picture is linear", "[linear_image]") {
  const TemporaryFolder folder;
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n";
  const Image image = read_linear_image(folder.write("a.hdr", header + "\x80\x40\x20\x82"));
  // Ward 1991: mantissa / 256 x 2^(exponent - 128); some readers add half a step to the mantissa.
  CHECK(image.channel("R")[0] == Approx(2.0f).epsilon(0.5 / 128));
  CHECK(image.channel("G")[0] == Approx(1.0f).epsilon(0.5 / 64));
  CHECK(image.channel("B")[0] == Approx(0.5f).epsilon(0.5 / 32));
}

TEST_CASE("an image file's own word on its transfer is followed, alpha stays as it is", "[linear_image]") {
  const TemporaryFolder folder;
  const auto make = [&](const std::string& name, const std::string& space) {
    const std::filesystem::path file = folder.path / name;
    const std::string color =
        "--create 2x2 4 --fill:color=0.5,0.25,0.75,0.5 2x2 -d uint8 --attrib oiio:UnassociatedAlpha 1 ";
    return oiiotool(color + "--attrib oiio:ColorSpace " + space + " -o " + file.string()) ? file : "";
  };
  const auto srgb = make("srgb.png", "sRGB"), linear = make("linear.png", "Linear"),
             power = make("power.png", "Gamma2.2"), other = make("other.png", "Gamma1.8");
  if (other.empty()) VOXREF_SKIP("there is no oiiotool");
  const float half = 128.0f / 255.0f, quarter = 64.0f / 255.0f;
  const Image image = read_linear_image(srgb);
  CHECK(image.channels() == Names{"R", "G", "B", "A"});
  CHECK(image.channel("R")[3] == Approx(srgb_decode(half)));
  CHECK(image.channel("G")[0] == Approx(srgb_decode(quarter)));
  CHECK(image.channel("A")[0] == Approx(half));
  CHECK(read_linear_image(linear).channel("R")[0] == Approx(half));
  CHECK(read_linear_image(power).channel("R")[0] == Approx(decode(Transfer::gamma22, half)));
  CHECK(read_linear_image(linear, Transfer::srgb).channel("R")[0] == Approx(srgb_decode(half)));
  CHECK(contains(complaint(other), "transfer: 'gamma1.8' is none that voxref knows"));
  CHECK(complaint(other, Transfer::linear) == "read");
}

TEST_CASE("an EXR of many parts is one image, the parts' names its layers", "[linear_image]") {
  const TemporaryFolder folder;
  const auto part = [](const std::string& name, const std::string& value, const std::string& channels, int count) {
    return "--create 3x2 " + std::to_string(count) + " --fill:color=" + value + " 3x2 --chnames " + channels +
           " --attrib oiio:subimagename " + name + " ";
  };
  const std::string file = (folder.path / "a.exr").string();
  const bool made = oiiotool(part("beauty", "1,2,3", "R,G,B", 3) + part("direct", "4,5,6", "R,G,B", 3) + "--siappend " +
                             part("depth", "7", "Z", 1) + "--siappend " + part("more", "8,9", "direct.R,N.X", 2) +
                             "--siappend -d float -o " + file);
  if (!made) VOXREF_SKIP("there is no oiiotool");
  const Image image = read_linear_image(file);
  CHECK(image.channels() ==
        Names{"R", "G", "B", "direct.R", "direct.G", "direct.B", "depth.Z", "N.X", "more.direct.R"});
  CHECK(image.channel("B")[5] == 3.0f);
  CHECK(image.channel("direct.R")[0] == 4.0f);
  CHECK(image.channel("depth.Z")[0] == 7.0f);
  CHECK(image.channel("more.direct.R")[0] == 8.0f);
  CHECK(image.channel("N.X")[0] == 9.0f);

  const Image some = read_linear_image(file, {}, [](const std::string& name) { return name == "G" || name == "N.X"; });
  CHECK(some.channels() == Names{"G", "N.X"});
  CHECK(some.channel("G")[4] == 2.0f);
  CHECK(some.channel("N.X")[4] == 9.0f);

  // A part that fills less of the display window, which all parts share, and one that leaves it.
  const auto with_part = [&](const std::string& size) {
    const std::string sizes = (folder.path / "sizes.exr").string();
    REQUIRE(oiiotool("--create 3x2 3 --create " + size +
                     " 3 --addc 1 --fullsize 3x2+0+0 --attrib oiio:subimagename b " + "--siappend -o " + sizes));
    return sizes;
  };
  const Image placed = read_linear_image(with_part("2x2"));
  CHECK(placed.channel("b.R")[1] == 1.0f);
  CHECK(placed.channel("b.R")[2] == 0.0f);
  CHECK(contains(complaint(with_part("4x2")), "outside its display window"));
}

TEST_CASE("images in array files get their channels' names by number", "[linear_image]") {
  const TemporaryFolder folder;
  const auto read = [&](std::vector<size_t> shape, std::optional<Transfer> transfer = {}) {
    write_npy(folder.path / "a.npy", ElementType::uint8, shape, [](size_t, std::span<float> row) {
      for (size_t i = 0; i < row.size(); ++i) row[i] = float(i + 1) / 255.0f;
    });
    return read_linear_image(folder.path / "a.npy", transfer);
  };
  CHECK(read({2, 5}).channels() == Names{"Y"});
  CHECK(read({2, 5, 1}).channels() == Names{"Y"});
  CHECK(read({2, 5, 2}).channels() == Names{"R", "G"});
  CHECK(read({2, 5, 3}).channels() == Names{"R", "G", "B"});
  const Image image = read({2, 5, 4});
  CHECK(image.channels() == Names{"R", "G", "B", "A"});
  CHECK(image.width() == 5);
  CHECK(image.height() == 2);
  CHECK(image.channel("B")[6] == 7.0f * (1.0f / 255.0f));  // second pixel of the second row
  const Image decoded = read({2, 5, 4}, Transfer::srgb);
  CHECK(decoded.channel("B")[6] == srgb_decode(7.0f * (1.0f / 255.0f)));
  CHECK(decoded.channel("A")[6] == 8.0f * (1.0f / 255.0f));
  CHECK(complaint(folder.path / "a.npy") == "read");
  read({2, 5, 2});
  write_npy(folder.path / "v.npy", ElementType::uint8, std::vector<size_t>{2, 3, 4, 4},
            [](size_t, std::span<float>) {});
  CHECK(contains(complaint(folder.path / "v.npy"), "is a volume"));
  write_npy(folder.path / "c.npy", ElementType::uint8, std::vector<size_t>{1, 3, 4, 5},
            [](size_t, std::span<float>) {});
  CHECK(contains(complaint(folder.path / "c.npy"), "has 5 channels"));
  write_npy(folder.path / "w.npy", ElementType::uint8, std::vector<size_t>{1, 65537}, [](size_t, std::span<float>) {});
  CHECK(contains(complaint(folder.path / "w.npy"), "image size: 65537x1"));

  folder.write("a.raw.json", R"({"dims": [1, 1], "format": "r8g8b8a8_unorm_srgb"})");
  folder.write("a.raw", "\x80\x80\x80\x80");
  CHECK(read_linear_image(folder.path / "a.raw").channel("R")[0] == srgb_decode(128.0f * (1.0f / 255.0f)));
  CHECK(read_linear_image(folder.path / "a.raw").channel("A")[0] == 128.0f * (1.0f / 255.0f));
}

TEST_CASE("an EXR's data window lies at its place in the display window, and never outside", "[linear_image]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "part.exr";
  const auto write = [&](const std::string& origin) {
    return oiiotool("--create 2x1 1 --chnames Y --fill:color=1.5 2x1 --origin " + origin + " --fullsize 4x3+10+20 -o " +
                    file.string());
  };
  if (!write("+12+21")) VOXREF_SKIP("oiiotool is not installed");
  const Image image = read_linear_image(file);
  REQUIRE(image.width() == 4);
  REQUIRE(image.height() == 3);
  const std::vector<float> expected = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.5f, 1.5f, 0.0f, 0.0f, 0.0f, 0.0f};
  CHECK(std::ranges::equal(image.channel("Y"), expected));
  REQUIRE(write("+13+21"));
  CHECK(contains(complaint(file), "outside its display window"));
}

TEST_CASE("a damaged image file is refused with its name and the reason", "[linear_image]") {
  const TemporaryFolder folder;
  CHECK(contains(complaint(folder.path / "none.exr"), "cannot be read as an image"));
  CHECK(contains(complaint(folder.write("empty.png", "")), "cannot be read as an image"));
  CHECK(contains(complaint(folder.write("text.txt", "text")), "cannot be read as an image"));
  Image image(64, 64);
  image.add_layer("");
  for (size_t i = 0; i < image.pixel_count(); ++i) image.channel("G")[i] = float(i);
  const auto file = folder.path / "a.exr";
  write_exr(file, image);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  CHECK(contains(complaint(file), "cannot be read as an image"));

  // An EXR of version 2 that asks for 65536 x 65536 pixels and holds none: header attributes as OpenEXR's documentation
  // of the file layout has them.
  const auto attribute = [](const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + little_endian({uint32_t(value.size())}, 4) + value;
  };
  const std::string zero(1, '\0'), box = little_endian({0, 0, 65535, 65535}, 4);
  std::string header = little_endian({20000630, 2}, 4);
  header += attribute("channels", "chlist", "G" + zero + little_endian({2, 0, 1, 1}, 4) + zero);
  header += attribute("compression", "compression", zero) + attribute("dataWindow", "box2i", box);
  header += attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", zero);
  header += attribute("pixelAspectRatio", "float", little_endian({0x3f800000}, 4));
  header += attribute("screenWindowCenter", "v2f", little_endian({0, 0}, 4));
  header += attribute("screenWindowWidth", "float", little_endian({0x3f800000}, 4)) + zero;
  CHECK(contains(complaint(folder.write("huge.exr", header + std::string(1000, '\0'))), "cannot be read as an image"));
}
