#include "voxel/raw_array.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "error.h"
#include "json_members.h"
#include "voxel/texel_format.h"

namespace voxref {

namespace {

constexpr int64_t largest_side = 65536;              // beyond it a size is a typing error
constexpr int64_t largest_pitch = int64_t{1} << 44;  // bytes; times a side it still fits 63 bits

const std::string axes = "zyx";  // as strides are indexed

/// Index into strides and shape of each axis, the slowest first.
std::array<size_t, 3> read_order(const JsonMembers& members) {
  const auto order = members.get<std::string>("axis_order", "zyxc");
  std::array<size_t, 3> indices{};
  bool known = order.size() == 4 && order[3] == 'c' && std::ranges::is_permutation(order.substr(0, 3), axes);
  if (!known) members.fail("axis_order", "is none of zyxc, zxyc, yzxc, yxzc, xzyc, xyzc");
  std::ranges::transform(order.substr(0, 3), indices.begin(), [](char axis) { return axes.find(axis); });
  return indices;
}

std::array<size_t, 4> read_shape(const JsonMembers& members, size_t channels) {
  auto dims = members.get<std::vector<int64_t>>("dims");
  if (dims.size() == 2) dims.push_back(1);
  if (dims.size() != 3) members.fail("dims", "are not [nx, ny, nz] or [nx, ny]");
  for (const int64_t side : dims)
    if (side < 1 || side > largest_side)
      members.fail("dims", std::to_string(side) + " is outside 1 to " + std::to_string(largest_side));
  return {size_t(dims[2]), size_t(dims[1]), size_t(dims[0]), channels};
}

/// A number of bytes from `least` on; `least` where the key is not there.
int64_t read_pitch(const JsonMembers& members, const std::string& key, int64_t least) {
  const auto pitch = members.get<int64_t>(key, least);
  if (pitch < least || pitch > largest_pitch)
    members.fail(key, std::to_string(pitch) + " is outside " + std::to_string(least) + " to 2^44");
  return pitch;
}

void flip(ArrayLayout& layout, const JsonMembers& members) {
  std::string flipped;
  for (const std::string& axis : members.get<std::vector<std::string>>("flip", {})) {
    const size_t index = axis.size() == 1 ? axes.find(axis) : axes.npos;
    if (index == axes.npos || flipped.find(axis) != flipped.npos)
      members.fail("flip", "is not an array of \"x\", \"y\" and \"z\", each once at most");
    flipped += axis;
    layout.origin += uint64_t(layout.stride[index]) * (layout.shape[index] - 1);
    layout.stride[index] *= -1;
  }
}

}  // namespace

ArrayLayout raw_layout(BinaryFile& file) {
  const std::string sidecar = file.name() + ".json";
  const nlohmann::json description = read_json(sidecar);
  const JsonMembers members(description, sidecar, "");
  members.require_only({"dims", "format", "axis_order", "flip", "row_pitch", "slice_pitch", "offset"});
  const auto name = members.get<std::string>("format");
  const TexelFormat* format = texel_format(name);
  if (!format) members.fail("format", "is none of " + texel_format_names());

  const std::array<size_t, 3> order = read_order(members);
  ArrayLayout layout{format->type, read_shape(members, format->channels)};
  layout.srgb = format->srgb;
  layout.origin = uint64_t(read_pitch(members, "offset", 0));
  const auto texel = int64_t(format->channels * bytes_of(format->type));
  const auto side = [&](size_t i) { return int64_t(layout.shape[order[i]]); };
  const int64_t row = texel * side(2), row_pitch = read_pitch(members, "row_pitch", row);
  const int64_t slice = row_pitch * (side(1) - 1) + row;
  const int64_t slice_pitch =
      members.has("slice_pitch") ? read_pitch(members, "slice_pitch", slice) : row_pitch * side(1);
  if (slice_pitch > largest_pitch) members.fail("row_pitch", "makes slices of more than 2^44 bytes");
  layout.stride[order[2]] = texel;
  layout.stride[order[1]] = row_pitch;
  layout.stride[order[0]] = slice_pitch;

  const auto begin = int64_t(layout.origin), there = int64_t(file.size());
  const int64_t least = begin + slice_pitch * (side(0) - 1) + slice;
  const int64_t after_row = std::max(least, begin + slice_pitch * (side(0) - 1) + row_pitch * side(1));
  const int64_t after_slice = begin + slice_pitch * side(0);
  if (there != least && there != after_row && there != after_slice)
    throw Error(file.name(), "holds " + std::to_string(there) + " bytes instead of " + std::to_string(least) +
                                 (there < least ? ": truncated" : ""));
  flip(layout, members);
  return layout;
}

}  // namespace voxref
