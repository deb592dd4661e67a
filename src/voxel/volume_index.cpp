#include "voxel/volume_index.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "error.h"
#include "file.h"
#include "json_members.h"
#include "voxel/array_file.h"
#include "voxel/mipmap.h"
#include "voxel/texel_format.h"

namespace voxref {

namespace {

using nlohmann::json;

constexpr int largest_side = 4096;  // voxels; beyond it a size is damage
constexpr size_t most_channels = 16;

json to_json(const VolumeEntry& entry) {
  json j = {{"name", entry.name}, {"shape", entry.shape}, {"dtype", dtype_name(entry.type)}, {"stage", entry.stage}};
  if (entry.file != entry.name + ".npy") j["file"] = entry.file;
  if (entry.mip != 0) j["mip"] = entry.mip;
  if (!entry.face.empty()) j["face"] = entry.face;
  if (entry.level >= 0) j["level"] = entry.level;
  if (entry.shape[3] == 4) j["premultiplied"] = entry.premultiplied;
  if (!entry.alpha.empty()) j["alpha"] = entry.alpha;
  if (!entry.encoding.empty()) j["encoding"] = entry.encoding;
  return j;
}

Grid read_grid(const JsonMembers& members) {
  Grid grid;
  const auto dims = members.get<std::array<int, 3>>("dims");
  const auto bounds = members.get<std::array<std::array<double, 3>, 2>>("bounds");
  grid.voxel = float(members.get<double>("voxel_size", (bounds[1][0] - bounds[0][0]) / std::max(dims[0], 1)));
  if (!(grid.voxel > 0.0f) || !std::isfinite(grid.voxel)) members.fail("voxel_size", "is not a positive number");
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 1 || dims[axis] > largest_side)
      members.fail("dims", std::to_string(dims[axis]) + " is outside 1 to " + std::to_string(largest_side));
    grid.size[axis] = dims[axis];
    grid.min[axis] = float(bounds[0][axis]);
    const double extent = bounds[1][axis] - bounds[0][axis], voxels = double(grid.voxel) * dims[axis];
    if (!std::isfinite(grid.min[axis]) || !(std::abs(extent - voxels) <= 1e-3 * voxels))
      members.fail("bounds", "do not span dims cubic voxels of voxel_size");
  }
  return grid;
}

/// The file of an entry: inside the folder, so that a folder from elsewhere cannot name what else is on this machine.
std::string read_file_name(const JsonMembers& members, const std::string& name) {
  auto text = members.get<std::string>("file", name + ".npy");
  const std::filesystem::path file(text);
  const bool leaves = file.is_absolute() || std::ranges::find(file, "..") != file.end();
  if (leaves || !file.has_filename() || text.find('\0') != text.npos) members.fail("file", "is no file of this folder");
  if (!is_array_file(file)) members.fail("file", "is none of .npy, .dds and .raw");
  return text;
}

/// A NumPy name, or that of a texel format.
ElementType read_type(const JsonMembers& members, size_t channels) {
  const auto dtype = members.get<std::string>("dtype");
  if (const std::optional<ElementType> type = dtype_called(dtype)) return *type;
  const TexelFormat* format = texel_format(dtype);
  if (!format) members.fail("dtype", "is none of float32, float16, uint8, " + texel_format_names());
  if (format->channels != channels) members.fail("dtype", "has another channel count than shape");
  return format->type;
}

/// Which of the directional volumes a name is.
struct AnisoPlace {
  std::string face;
  int level = -1;
  bool bounced = false;
};

std::optional<AnisoPlace> aniso_place(const std::string& name) {
  for (const bool bounced : {false, true})
    for (size_t face = 0; face < face_names.size(); ++face)
      for (int level = 0; (1 << level) < largest_side; ++level)
        if (name == aniso_name(face, size_t(level), bounced))
          return AnisoPlace{std::string(face_names[face]), level, bounced};
  return std::nullopt;
}

VolumeEntry read_entry(const JsonMembers& members) {
  VolumeEntry entry;
  entry.name = members.get<std::string>("name");
  if (entry.name.empty() || entry.name.find_first_of(std::string("/\\\0", 3)) != std::string::npos)
    members.fail("name", "is not the name of a file");
  entry.file = read_file_name(members, entry.name);
  entry.mip = members.get<int>("mip", 0);
  if (entry.mip < 0) members.fail("mip", std::to_string(entry.mip) + " is below 0");
  entry.shape = members.get<std::array<size_t, 4>>("shape");
  for (int d = 0; d < 3; ++d)
    if (entry.shape[d] < 1 || entry.shape[d] > largest_side) members.fail("shape", "has a side out of range");
  if (entry.shape[3] < 1 || entry.shape[3] > most_channels) members.fail("shape", "has a channel count out of range");
  entry.type = read_type(members, entry.shape[3]);
  const AnisoPlace place = aniso_place(entry.name).value_or(AnisoPlace{});
  entry.stage = members.get<std::string>("stage", stage_making(entry.name));
  entry.face = members.get<std::string>("face", place.face);
  entry.level = members.get<int>("level", place.level);
  entry.premultiplied = members.get<bool>("premultiplied", false);
  entry.alpha = members.get<std::string>("alpha", "");
  entry.encoding = members.get<std::string>("encoding", "");
  return entry;
}

}  // namespace

const VolumeEntry* VolumeIndex::find(const std::string& name) const {
  const auto found = std::find_if(volumes.begin(), volumes.end(), [&](const VolumeEntry& e) { return e.name == name; });
  return found == volumes.end() ? nullptr : &*found;
}

std::string radiance_name(bool bounced) { return bounced ? "radiance_bounce" : "radiance"; }

std::string aniso_name(size_t face, size_t level, bool bounced) {
  return std::string(bounced ? "aniso_bounce_" : "aniso_") + std::string(face_names[face]) + "_" +
         std::to_string(level);
}

std::string stage_making(const std::string& volume) {
  for (const char* name : {"albedo", "normal", "emission", "centroid", "static_flag"})
    if (volume == name) return "voxelize";
  if (volume == "visibility" || volume == radiance_name(false)) return "shade";
  if (volume == radiance_name(true)) return "bounce";
  const std::optional<AnisoPlace> place = aniso_place(volume);
  return !place ? "" : place->bounced ? "mipmap after bounce" : "mipmap";
}

std::filesystem::path index_file(const std::filesystem::path& folder) { return folder / "volumes.json"; }

void write_volume_index(const std::filesystem::path& folder, const VolumeIndex& index) {
  const Grid& grid = index.grid;
  const auto triple = [](const auto& v) { return json{v.x, v.y, v.z}; };
  json j = {{"dims", triple(grid.size)}, {"bounds", {triple(grid.min), triple(grid.max())}},
            {"voxel_size", grid.voxel},  {"axis_order", "zyxc"},
            {"format", index.format},    {"volumes", json::array()}};
  for (const VolumeEntry& entry : index.volumes) j["volumes"].push_back(to_json(entry));
  write_text(index_file(folder), j.dump(1) + "\n");
}

VolumeIndex read_volume_index(const std::filesystem::path& folder) {
  const std::string file = index_file(folder).string();
  const json document = read_json(file);
  const JsonMembers members(document, file, "");
  VolumeIndex index;
  index.grid = read_grid(members);
  index.format = members.get<std::string>("format", "float32");
  if (members.get<std::string>("axis_order", "zyxc") != "zyxc") members.fail("axis_order", "is not zyxc");
  const auto volumes = members.get<json::array_t>("volumes");
  for (size_t i = 0; i < volumes.size(); ++i) {
    const JsonMembers entry(volumes[i], file, "volumes[" + std::to_string(i) + "]");
    index.volumes.push_back(read_entry(entry));
    if (index.find(index.volumes.back().name) != &index.volumes.back()) entry.fail("name", "is there twice");
  }
  return index;
}

}  // namespace voxref
