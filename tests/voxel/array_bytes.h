#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "catch.h"
#include "error.h"
#include "voxel/array_file.h"

/// Little-endian 32-bit words.
inline std::string words(std::initializer_list<uint32_t> values) {
  std::string bytes;
  for (const uint32_t value : values)
    for (int shift = 0; shift < 32; shift += 8) bytes += char(value >> shift & 0xff);
  return bytes;
}

/// `count` bytes that count up, so that nearby ones differ.
inline std::string counting_bytes(size_t count) {
  std::string bytes(count, '\0');
  for (size_t i = 0; i < count; ++i) bytes[i] = char(i % 251);
  return bytes;
}

/// All values, slice after slice.
inline std::vector<float> read_all(voxref::ArrayFile& array) {
  std::vector<float> values(array.shape()[0] * array.slice_size());
  for (size_t z = 0; z < array.shape()[0]; ++z)
    array.read_slice(z, std::span(values).subspan(z * array.slice_size(), array.slice_size()));
  return values;
}

/// What the message says, but for the file, when an array is read; "read" when it can be. The file that the message
/// begins with is `file`, or one whose name begins so.
inline std::string complaint_of_array(const std::filesystem::path& file, int mip = 0) {
  try {
    voxref::ArrayFile array(file, mip);
    read_all(array);
    return "read";
  } catch (const voxref::Error& error) {
    const std::string what = error.what();
    CHECK(what.starts_with(file.string()));
    CHECK(what.find('\n') == what.npos);
    return what.substr(what.find(": ") + 2);
  }
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }
