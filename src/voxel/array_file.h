#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "voxel/array_layout.h"
#include "voxel/binary_file.h"

namespace voxref {

/// What an array is meant to be: decides how a NumPy array of three sides is read, and nothing else.
enum class ArrayMeaning : uint8_t {
  by_shape,  ///< (Y, X, C) where the last side is at most 4, else (Z, Y, X) of one channel
  volume     ///< (Z, Y, X) of one channel
};

/// True where the name's ending is that of a file that ArrayFile reads.
bool is_array_file(const std::filesystem::path& file);

/// A volume or an image in a file, read a slice at a time; the ending of the name says in which format: .npy (npy.h;
/// two sides are Y, X, three are as ArrayMeaning says, four are Z, Y, X, C), .dds (dds.h) or .raw (raw_array.h).
class ArrayFile {
 public:
  /// @param mip level of detail, 0 the largest
  /// @throws Error `FILE: PLACE: what is wrong`: a format that is not known, a malformed header, a length that is not
  /// what the header asks for, no such mip level
  explicit ArrayFile(const std::filesystem::path& file, int mip = 0, ArrayMeaning meaning = ArrayMeaning::by_shape);

  const std::string& name() const { return file_.name(); }              ///< the path, for messages
  const std::array<size_t, 4>& shape() const { return layout_.shape; }  ///< Z, Y, X, C; an image has Z = 1
  ElementType type() const { return layout_.type; }
  bool srgb() const { return layout_.srgb; }  ///< the format says so; values are read as stored
  int mip_count() const { return layout_.mip_count; }
  size_t slice_size() const { return shape()[1] * shape()[2] * shape()[3]; }  ///< values
  /// Slice z as [y][x][c]; uint8 as byte x (1/255) (spec section 4). NaN and infinity come as they are. Slices may be
  /// asked for in any order. Where z is not the slowest axis of the file, the whole array is held in memory.
  void read_slice(size_t z, std::span<float> slice);
  /// "[2,0,5,1]": z, y, x and channel of value `i` of slice z, for messages.
  std::string place_of(size_t z, size_t i) const;

 private:
  void load(size_t z);

  BinaryFile file_;
  ArrayLayout layout_;
  static constexpr uint64_t nowhere = UINT64_MAX;
  uint64_t window_offset_ = nowhere;  ///< in the file
  std::vector<std::byte> window_;     ///< a slice with what lies between its rows, or all of the array
};

}  // namespace voxref
