#include "voxel/npy.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "error.h"
#include "file.h"
#include "temporary_folder.h"
#include "voxel/array_bytes.h"

using namespace voxref;

namespace {

const std::string float_dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";

/// A file of format version 1 with the given dictionary and values.
std::string array_file(const std::string& dictionary, const std::string& values) {
  std::string file("\x93NUMPY\x01\x00", 8);
  file += {char(dictionary.size() & 0xff), char(dictionary.size() >> 8)};
  return file + dictionary + values;
}

std::string complaint(const std::string& content) {
  const TemporaryFolder folder;
  return complaint_of_array(folder.write("a.npy", content));
}

}  // namespace

TEST_CASE("an array comes back bit by bit, denormals, negative zero and extremes included", "[npy]") {
  const TemporaryFolder folder;
  const std::vector<size_t> shape = {3, 2, 2, 1};
  std::vector<float> values = {0.0f,
                               -0.0f,
                               1e-45f,
                               -3.4e38f,
                               0.1f,
                               1.0f / 3.0f,
                               std::numeric_limits<float>::max(),
                               std::numeric_limits<float>::min(),
                               5,
                               6,
                               7,
                               8};
  write_npy(folder.path / "a.npy", ElementType::float32, shape, [&](size_t i, std::span<float> slice) {
    for (const float v : slice) CHECK(v == 0.0f);
    std::copy_n(values.begin() + 4 * i, 4, slice.begin());
  });
  ArrayFile array(folder.path / "a.npy");
  CHECK(array.shape() == std::array<size_t, 4>{3, 2, 2, 1});
  CHECK(array.type() == ElementType::float32);
  REQUIRE(array.slice_size() == 4);
  std::vector<float> slice(4);
  for (const size_t z : {2, 0, 1}) {  // in any order
    array.read_slice(z, slice);
    for (size_t k = 0; k < 4; ++k)
      CHECK(std::bit_cast<uint32_t>(slice[k]) == std::bit_cast<uint32_t>(values[4 * z + k]));
  }
}

TEST_CASE("an array file is laid out as NumPy does it", "[npy]") {
  const TemporaryFolder folder;
  const std::vector<size_t> shape = {2, 3};
  write_npy(folder.path / "a.npy", ElementType::float32, shape,
            [](size_t i, std::span<float> slice) { slice[2] = float(i + 1); });
  const std::string content = read_file(folder.path / "a.npy");
  CHECK(content.starts_with("\x93NUMPY"));
  REQUIRE(content.size() % 64 == 24);  // values start at a multiple of 64
  CHECK(content[content.size() - 24 - 1] == '\n');
  CHECK(contains(content, "'shape': (2,3,)"));
}

TEST_CASE("bytes read as byte times 1/255", "[npy]") {
  const TemporaryFolder folder;
  write_text(folder.path / "a.npy",
             array_file("{'descr': '|u1', 'fortran_order': False, 'shape': (1, 3), }", std::string("\x00\x7f\xff", 3)));
  ArrayFile array(folder.path / "a.npy");
  CHECK(array.type() == ElementType::uint8);
  std::vector<float> slice(3);
  array.read_slice(0, slice);
  CHECK(slice == std::vector<float>{0.0f, 127.0f * (1.0f / 255.0f), 1.0f});
}

TEST_CASE("half floats are written as '<f2', rounded, and read back; too large a value is clamped", "[npy]") {
  const TemporaryFolder folder;
  const std::vector<size_t> shape = {2, 3};  // not in fours
  const std::vector<float> values = {1.0f, 0.1f, -2.0f, 1e9f, 0.0f, 0x1p-24f};
  write_npy(folder.path / "a.npy", ElementType::float16, shape,
            [&](size_t i, std::span<float> slice) { std::copy_n(values.begin() + 3 * long(i), 3, slice.begin()); });
  const std::string content = read_file(folder.path / "a.npy");
  CHECK(contains(content, "'descr': '<f2'"));
  CHECK(content.ends_with(std::string("\x00\x3c\x66\x2e\x00\xc0\xff\x7b\x00\x00\x01\x00", 12)));
  ArrayFile array(folder.path / "a.npy");
  CHECK(array.type() == ElementType::float16);
  CHECK(read_all(array) == std::vector<float>{1.0f, 0x1.998p-4f, -2.0f, 65504.0f, 0.0f, 0x1p-24f});
  write_text(folder.path / "a.npy",
             array_file("{'descr': '<f2', 'fortran_order': False, 'shape': (1, 1), }", std::string("\x00\x7c", 2)));
  ArrayFile infinite(folder.path / "a.npy");
  CHECK(read_all(infinite) == std::vector<float>{INFINITY});
}

TEST_CASE("a damaged array file is refused with its name and the reason", "[npy]") {
  const std::string values(24, '\0');
  CHECK(complaint(array_file(float_dictionary, values)) == "read");
  CHECK(contains(complaint(""), "NumPy"));
  CHECK(contains(complaint("\x93NUMPZ" + values), "NumPy"));
  CHECK(contains(complaint("\x93NUM"), "NumPy"));
  CHECK(contains(complaint(std::string("\x93NUMPY\x07\x00", 8) + values), "version 7"));
  CHECK(contains(complaint(std::string("\x93NUMPY\x01\x00\xff\xff", 10) + values), "ends too early"));
  CHECK(contains(complaint(std::string("\x93NUMPY\x02\x00\xff\xff\xff\xff", 12) + values), "length is wrong"));
  CHECK(contains(complaint(array_file(float_dictionary, values.substr(1))), "truncated"));
  CHECK(contains(complaint(array_file(float_dictionary, values + "x")), "25 bytes of values instead of 24"));
  CHECK(
      contains(complaint(array_file("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }", values)), "'<f8'"));
  CHECK(
      contains(complaint(array_file("{'descr': '>f4', 'fortran_order': False, 'shape': (2, 3), }", values)), "'>f4'"));
  CHECK(
      contains(complaint(array_file("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }", values)), "Fortran"));
  CHECK(contains(complaint(array_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2, -3), }", values)), "-3"));
  const auto with_shape = [&](const std::string& shape) {
    return complaint(array_file("{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }", values));
  };
  CHECK(contains(with_shape("()"), "0 dimensions"));
  CHECK(contains(with_shape("(6,)"), "1 dimensions"));
  CHECK(contains(with_shape("(1, 1, 1, 2, 3)"), "5 dimensions"));
  CHECK(contains(with_shape("(0, 999999999)"), "side '0'"));
  CHECK(contains(complaint(array_file("{'descr': '<f4', 'fortran_order': False, }", values)), "no 'shape'"));
  CHECK(contains(complaint(array_file("{'descr': '<f4', 'fortran_order': False, 'shape': "
                                      "(999999999, 999999999, 999999999), }",
                                      values)),
                 "counted"));
  CHECK(contains(complaint("a text file"), "NumPy"));
  CHECK_THROWS_AS(ArrayFile("/nowhere/a.npy"), Error);
}

TEST_CASE("two sides are an image, four a volume, and three what was asked for", "[npy]") {
  const TemporaryFolder folder;
  using Shape = std::array<size_t, 4>;
  const auto shape_of = [&](std::initializer_list<size_t> sides, ArrayMeaning meaning = ArrayMeaning::by_shape) {
    write_npy(folder.path / "a.npy", ElementType::uint8, std::vector(sides), [](size_t, std::span<float>) {});
    return ArrayFile(folder.path / "a.npy", 0, meaning).shape();
  };
  CHECK(shape_of({2, 3}) == Shape{1, 2, 3, 1});
  CHECK(shape_of({2, 3, 4}) == Shape{1, 2, 3, 4});
  CHECK(shape_of({2, 3, 5}) == Shape{2, 3, 5, 1});
  CHECK(shape_of({2, 3, 4}, ArrayMeaning::volume) == Shape{2, 3, 4, 1});
  CHECK(shape_of({2, 3, 4, 5}) == Shape{2, 3, 4, 5});
}

TEST_CASE("NaN and infinity are read as they are, and found by their place", "[npy]") {
  const TemporaryFolder folder;
  std::string values(24, '\0');
  const float nan = std::nanf(""), infinite = INFINITY;
  std::memcpy(values.data() + 4 * 5, &nan, 4);
  std::memcpy(values.data() + 4, &infinite, 4);
  write_text(folder.path / "a.npy", array_file(float_dictionary, values));
  ArrayFile array(folder.path / "a.npy");
  std::vector<float> slice(6);
  array.read_slice(0, slice);
  CHECK(slice[1] == infinite);
  CHECK(std::isnan(slice[5]));
  CHECK(array.place_of(0, 5) == "[0,1,2,0]");
}

TEST_CASE("an array that cannot be written leaves nothing behind", "[npy]") {
  const TemporaryFolder folder;
  const std::vector<size_t> shape = {2, 3};
  CHECK_THROWS_AS(
      write_npy(folder.path / "none" / "a.npy", ElementType::float32, shape, [](size_t, std::span<float>) {}), Error);
  CHECK_THROWS_AS(write_npy(folder.path / "a.npy", ElementType::float32, shape,
                            [](size_t, std::span<float>) { throw Interrupted(); }),
                  Interrupted);
  CHECK(std::filesystem::is_empty(folder.path));
}
