#include "image/image_file.h"

#include <cmath>
#include <fstream>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "temporary_folder.h"

using namespace voxref;

TEST_CASE("an EXR returns every channel's bits and the attributes", "[image_file]") {
  const TemporaryFolder folder;
  Image image(5, 3);
  image.add_layer("");
  image.add("stderr.R")[7] = 1e-30f;
  image.layer("")[2][14] = 3.1415927f;
  image.channel("R")[0] = std::nanf("");
  image.channel("G")[1] = INFINITY;
  image.attributes["voxref:settings"] = "{\"grid\": {\"resolution\": 64}}";
  write_exr(folder.path / "image.exr", image);
  const Image read = read_image(folder.path / "image.exr");
  CHECK(read.width() == 5);
  CHECK(read.height() == 3);
  CHECK(read.channel("stderr.R")[7] == 1e-30f);
  CHECK(read.channel("B")[14] == 3.1415927f);
  CHECK(std::isnan(read.channel("R")[0]));
  CHECK(std::isinf(read.channel("G")[1]));
  CHECK(read.attributes.at("voxref:settings") == image.attributes["voxref:settings"]);
}

TEST_CASE("files appear whole or not at all", "[file]") {
  const TemporaryFolder folder;
  const auto file = folder.path / "text.txt";
  write_text(file, "first");
  CHECK_THROWS_AS(write_atomically(file,
                                   [](const std::filesystem::path& temporary) {
                                     std::ofstream(temporary) << "half";
                                     throw Error("writer", "failed half way");
                                   }),
                  Error);
  CHECK(read_file(file) == "first");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("places that cannot be written are refused before any work, and nothing is left there", "[file]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(require_writable(folder.path / "absent" / "image.exr"), Error);
  CHECK_THROWS_AS(require_writable(folder.path), Error);
  CHECK_THROWS_AS(require_writable("/proc/image.exr"), Error);
  CHECK_NOTHROW(require_writable(folder.path / "image.exr"));
  CHECK(std::filesystem::is_empty(folder.path));
}

TEST_CASE("unreadable images and files name themselves", "[image_file]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(read_image(folder.path / "none.exr"), Error);
  write_text(folder.path / "text.exr", "this is no image");
  CHECK_THROWS_AS(read_image(folder.path / "text.exr"), Error);
  CHECK_THROWS_AS(read_file(folder.path / "none.txt"), Error);
  CHECK_THROWS_AS(read_file(folder.path), Error);
  write_text(folder.path / "empty.txt", "");
  CHECK(read_file(folder.path / "empty.txt").empty());
}

TEST_CASE("display bytes are clipped, sRGB-encoded and scaled by powers of two", "[image_file]") {
  Image image(4, 1);
  image.add_layer("");
  const float values[] = {0.0f, 0.5f, 2.0f, -1.0f};
  for (size_t i = 0; i < 4; ++i) image.channel("R")[i] = values[i];
  const std::vector<uint8_t> bytes = display_bytes(image, "", 0.0f);
  CHECK(int(bytes[0]) == 0);
  CHECK(int(bytes[3]) == 188);  // 0.5 linear is code 187.5 of sRGB
  CHECK(int(bytes[6]) == 255);
  CHECK(int(bytes[9]) == 0);
  CHECK(int(display_bytes(image, "", -2.0f)[6]) == 188);
}

TEST_CASE("a PNG made in memory reads back byte for byte", "[image_file]") {
  const TemporaryFolder folder;
  const std::vector<uint8_t> rgb = {0, 1, 2, 253, 254, 255};
  const std::vector<uint8_t> png = encode_png(2, 1, rgb);
  write_atomically(folder.path / "picture.png", std::as_bytes(std::span(png)));
  const Image read = read_image(folder.path / "picture.png");
  REQUIRE(read.pixel_count() == 2);
  CHECK(std::lround(255.0f * read.channel("G")[1]) == 254);
  CHECK(std::lround(255.0f * read.channel("B")[0]) == 2);
}

TEST_CASE("SHA-256 agrees with the standard's examples", "[file]") {
  // FIPS 180-4 example "abc", and the digest of the empty message.
  const std::string abc = "abc";
  CHECK(sha256(std::as_bytes(std::span(abc.data(), 3))) ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256({}) == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}
