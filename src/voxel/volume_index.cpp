#include "voxel/volume_index.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "error.h"
#include "file.h"
#include "voxel/mipmap.h"

namespace voxref {

namespace {

using nlohmann::json;

constexpr int largest_side = 4096;  // voxels; beyond it a size is damage
constexpr size_t most_channels = 16;

json to_json(const VolumeEntry& entry) {
  json j = {{"name", entry.name}, {"shape", entry.shape}, {"dtype", dtype_name(entry.type)}, {"stage", entry.stage}};
  if (!entry.face.empty()) j["face"] = entry.face;
  if (entry.level >= 0) j["level"] = entry.level;
  if (entry.shape[3] == 4) j["premultiplied"] = entry.premultiplied;
  if (!entry.alpha.empty()) j["alpha"] = entry.alpha;
  if (!entry.encoding.empty()) j["encoding"] = entry.encoding;
  return j;
}

/// Reads members of an object, and says where and what is wrong.
class Members {
 public:
  Members(const json& object, std::string file, std::string place)
      : object_(object), file_(std::move(file)), place_(std::move(place)) {
    if (!object.is_object()) fail("", "is not an object");
  }
  template <class T>
  T get(const std::string& key) const {
    if (!object_.contains(key)) fail(key, "is missing");
    try {
      return object_.at(key).get<T>();
    } catch (const json::exception&) {
      fail(key, "has the wrong type");
    }
  }
  template <class T>
  T get(const std::string& key, const T& absent) const {
    return object_.contains(key) ? get<T>(key) : absent;
  }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw Error(file_, place_ + (place_.empty() || key.empty() ? "" : ".") + key, what);
  }

 private:
  const json& object_;
  std::string file_, place_;
};

Grid read_grid(const Members& members) {
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

VolumeEntry read_entry(const Members& members) {
  VolumeEntry entry;
  entry.name = members.get<std::string>("name");
  if (entry.name.empty() || entry.name.find_first_of("/\\") != std::string::npos)
    members.fail("name", "'" + entry.name + "' is not the name of a file");
  entry.shape = members.get<std::array<size_t, 4>>("shape");
  for (int d = 0; d < 3; ++d)
    if (entry.shape[d] < 1 || entry.shape[d] > largest_side) members.fail("shape", "has a side out of range");
  if (entry.shape[3] < 1 || entry.shape[3] > most_channels) members.fail("shape", "has a channel count out of range");
  const auto dtype = members.get<std::string>("dtype");
  const std::optional<NpyType> type = dtype_called(dtype);
  if (!type) members.fail("dtype", "'" + dtype + "' is not float32, float16 or uint8");
  entry.type = *type;
  entry.stage = members.get<std::string>("stage", "");
  entry.face = members.get<std::string>("face", "");
  entry.level = members.get<int>("level", -1);
  entry.premultiplied = members.get<bool>("premultiplied", false);
  entry.alpha = members.get<std::string>("alpha", "");
  entry.encoding = members.get<std::string>("encoding", "");
  return entry;
}

json parse(const std::filesystem::path& file) {
  try {
    return json::parse(read_file(file));
  } catch (const json::parse_error& error) {
    throw Error(file.string(), "byte " + std::to_string(error.byte), "is not valid JSON");
  }
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
  const json document = parse(file);
  const Members members(document, file, "");
  VolumeIndex index;
  index.grid = read_grid(members);
  index.format = members.get<std::string>("format", "float32");
  if (members.get<std::string>("axis_order", "zyxc") != "zyxc") members.fail("axis_order", "is not zyxc");
  const auto volumes = members.get<json::array_t>("volumes");
  for (size_t i = 0; i < volumes.size(); ++i) {
    const Members entry(volumes[i], file, "volumes[" + std::to_string(i) + "]");
    index.volumes.push_back(read_entry(entry));
    if (index.find(index.volumes.back().name) != &index.volumes.back()) entry.fail("name", "is there twice");
  }
  return index;
}

}  // namespace voxref
