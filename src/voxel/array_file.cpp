#include "voxel/array_file.h"

#include <algorithm>
#include <cassert>
#include <cctype>

#include "error.h"
#include "voxel/dds.h"
#include "voxel/npy.h"
#include "voxel/raw_array.h"

namespace voxref {

namespace {

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}

ArrayLayout layout_of(BinaryFile& file, const std::filesystem::path& path, int mip, ArrayMeaning meaning) {
  const std::string ending = ending_of(path);
  if (ending == ".dds") return dds_layout(file, mip);
  if (ending != ".npy" && ending != ".raw") throw Error(file.name(), "is no array file: .npy, .dds or .raw");
  if (mip != 0)
    throw Error(file.name(), "mip " + std::to_string(mip), "is not there: " + ending + " has no mip levels");
  return ending == ".npy" ? npy_layout(file, meaning) : raw_layout(file);
}

/// Bytes [begin, end) of the file.
struct Range {
  int64_t begin, end;
};

/// What the axes from `first_axis` on span when the indices before lead to byte `at`.
Range extent(const ArrayLayout& layout, int64_t at, size_t first_axis) {
  Range range{at, at + int64_t(layout.shape[3] * bytes_of(layout.type))};
  for (size_t axis = first_axis; axis < 3; ++axis) {
    const int64_t reach = layout.stride[axis] * int64_t(layout.shape[axis] - 1);
    (reach < 0 ? range.begin : range.end) += reach;
  }
  return range;
}

}  // namespace

bool is_array_file(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".npy" || ending == ".dds" || ending == ".raw";
}

ArrayFile::ArrayFile(const std::filesystem::path& file, int mip, ArrayMeaning meaning)
    : file_(file), layout_(layout_of(file_, file, mip, meaning)) {}

/// Makes the window hold slice z.
void ArrayFile::load(size_t z) {
  Range range = extent(layout_, int64_t(layout_.origin) + layout_.stride[0] * int64_t(z), 1);
  if (std::abs(layout_.stride[0]) < range.end - range.begin) range = extent(layout_, int64_t(layout_.origin), 0);
  const auto size = size_t(range.end - range.begin);
  if (window_.size() == size && window_offset_ == uint64_t(range.begin)) return;
  window_offset_ = nowhere;  // until it is read: reading may fail
  window_.resize(size);
  file_.read(uint64_t(range.begin), window_);
  window_offset_ = uint64_t(range.begin);
}

void ArrayFile::read_slice(size_t z, std::span<float> slice) {
  assert(z < shape()[0] && slice.size() == slice_size());
  load(z);
  const auto [_, height, width, channels] = shape();
  const size_t texel_bytes = channels * bytes_of(type());
  const int64_t first = int64_t(layout_.origin) - int64_t(window_offset_) + layout_.stride[0] * int64_t(z);
  for (size_t y = 0; y < height; ++y) {
    const std::byte* row = window_.data() + first + layout_.stride[1] * int64_t(y);
    const std::span<float> decoded = slice.subspan(y * width * channels, width * channels);
    if (layout_.stride[2] == int64_t(texel_bytes)) {
      decode_elements(type(), row, decoded);
      continue;
    }
    for (size_t x = 0; x < width; ++x)
      decode_elements(type(), row + layout_.stride[2] * int64_t(x), decoded.subspan(x * channels, channels));
  }
}

std::string ArrayFile::place_of(size_t z, size_t i) const {
  const size_t channels = shape()[3], texel = i / channels;
  std::string place = "[" + std::to_string(z);
  for (const size_t index : {texel / shape()[2], texel % shape()[2], i % channels})
    place += "," + std::to_string(index);
  return place + "]";
}

}  // namespace voxref
