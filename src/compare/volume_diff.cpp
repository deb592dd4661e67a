#include "compare/volume_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "error.h"

#include "voxel/volume_file.h"

namespace voxref {

namespace {

/// |a - b| in units of the last place of what both can be stored in.
double steps_between(float a, float b, ElementType coarser) {
  const double difference = std::abs(double{a} - double{b});
  if (coarser == ElementType::uint8) return 255.0 * difference;
  if (coarser != ElementType::float16) return 0.0;
  constexpr int least_exponent = -14, mantissa_bits = 10;  // of IEEE 754 binary16
  const float larger = std::max(std::abs(a), std::abs(b));
  const int exponent = larger > 0.0f ? std::max(std::ilogb(larger), least_exponent) : least_exponent;
  return difference / std::ldexp(1.0, exponent - mantissa_bits);
}

ElementType coarser(ElementType a, ElementType b) {
  for (const ElementType type : {ElementType::uint8, ElementType::float16})
    if (a == type || b == type) return type;
  return ElementType::float32;
}

void note_texel(VolumeDifference& diff, std::span<const float> a, std::span<const float> b, ElementType storage) {
  const bool in_a = a.back() != 0.0f, in_b = b.back() != 0.0f;
  diff.occupied_a += in_a;
  diff.occupied_b += in_b;
  diff.occupied_only_a += in_a && !in_b;
  diff.occupied_only_b += in_b && !in_a;
  for (size_t c = 0; c < a.size(); ++c)
    if (a[c] != b[c] && std::isfinite(a[c]) && std::isfinite(b[c]))
      diff.steps = std::max(diff.steps, steps_between(a[c], b[c], storage));
}

/// Compares a row of texels. Those that the envelope accepts become those of the reference.
void compare_texels(VolumeDifference& diff, std::span<float> a, std::span<const float> b, const glm::ivec3& at,
                    const Tolerance& tolerance, ElementType storage, const TexelEnvelope& envelope) {
  const size_t channels = diff.entry.shape[3];
  for (size_t i = 0; i < a.size(); i += channels) {
    const std::span<float> texel = a.subspan(i, channels);
    const std::span<const float> expected = b.subspan(i, channels);
    const glm::ivec3 voxel = at + glm::ivec3(int(i / channels), 0, 0);
    if (envelope && !std::ranges::equal(texel, expected) && envelope(voxel, texel)) {
      ++diff.within_envelope;
      std::ranges::copy(expected, texel.begin());
    }
    note_texel(diff, texel, expected, storage);
  }
  compare_row(diff.values, a, b, {at, 0, int(channels)}, tolerance);
}

std::string shape_text(const std::array<size_t, 4>& shape) {
  return fmt::format("{}x{}x{} texels of {} channels", shape[2], shape[1], shape[0], shape[3]);
}

std::string grids_difference(const Grid& a, const Grid& b) {
  constexpr float rounding = 1e-4f;  // of a voxel
  const auto triple = [](const auto& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); };
  if (a.size != b.size) return "dims " + triple(a.size) + " instead of " + triple(b.size);
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(a.min[axis] - b.min[axis]) <= rounding * b.voxel))
      return fmt::format("the least corner is {} instead of {}, {:.3g} voxels off along {}", triple(a.min),
                         triple(b.min), (a.min[axis] - b.min[axis]) / b.voxel, "xyz"[axis]);
  if (!(std::abs(a.voxel - b.voxel) <= rounding * b.voxel / float(std::max({b.size.x, b.size.y, b.size.z}))))
    return fmt::format("voxel_size {} instead of {}", a.voxel, b.voxel);
  return "";
}

VolumeDifference missing(const VolumeEntry& entry, const std::string& problem) {
  VolumeDifference volume;
  volume.entry = entry;
  volume.problem = problem;
  volume.missing = true;
  return volume;
}

nlohmann::json voxel_json(const glm::ivec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

bool VolumeDifference::differs(const VolumeLimits& limits) const {
  if (missing) return limits.strict;
  return !problem.empty() || values.nonfinite > 0 || values.fraction() > limits.fraction;
}

VolumeDifference diff_volumes(const VolumeEntry& entry, ArrayFile& a, ArrayFile& b, const Tolerance& tolerance,
                              const TexelEnvelope& envelope, const Progress& progress) {
  VolumeDifference diff;
  diff.entry = entry;
  diff.entry.shape = a.shape();
  if (a.shape() != b.shape()) {
    diff.problem = shape_text(a.shape()) + " instead of " + shape_text(b.shape());
    return diff;
  }
  const ElementType storage = coarser(a.type(), b.type());
  std::vector<float> slice_a(a.slice_size()), slice_b(b.slice_size());
  const auto [depth, height, width, channels] = a.shape();
  for (size_t z = 0; z < depth; ++z) {
    progress.check();
    progress("comparing", double(z) / double(depth));
    a.read_slice(z, slice_a);
    b.read_slice(z, slice_b);
    const size_t row = width * channels;
    for (size_t y = 0; y < height; ++y)
      compare_texels(diff, std::span(slice_a).subspan(y * row, row), std::span(slice_b).subspan(y * row, row),
                     {0, int(y), int(z)}, tolerance, storage, envelope);
  }
  return diff;
}

TexelEnvelope texel_envelope(std::vector<VoxelEnvelope> envelopes, const std::string& volume) {
  std::array<AverageEnvelope, 3> VoxelEnvelope::*channels = nullptr;
  if (volume == "albedo") channels = &VoxelEnvelope::albedo;
  if (volume == "normal") channels = &VoxelEnvelope::normal;
  if (volume == "emission") channels = &VoxelEnvelope::emission;
  if (!channels) throw Error("envelope", "'" + volume + "' is no average of fragments");
  const auto sorted = std::make_shared<const std::vector<VoxelEnvelope>>(std::move(envelopes));
  return [sorted, channels](const glm::ivec3& voxel, std::span<const float> texel) {
    const auto key = [](const glm::ivec3& v) { return std::array{v.z, v.y, v.x}; };
    const auto found =
        std::lower_bound(sorted->begin(), sorted->end(), voxel,
                         [&](const VoxelEnvelope& e, const glm::ivec3& v) { return key(e.voxel) < key(v); });
    if (found == sorted->end() || found->voxel != voxel) return false;
    const auto byte = [](float value) { return std::isfinite(value) ? std::lround(255.0f * value) : -1; };
    if (byte(texel[3]) != found->count) return false;
    for (size_t c = 0; c < 3; ++c)
      if (byte(texel[c]) < 0 || !((*found).*channels)[c].contains(uint8_t(byte(texel[c])))) return false;
    return true;
  };
}

int stage_rank(const VolumeEntry& entry) {
  constexpr std::array<const char*, 5> stages = {"voxelize", "shade", "mipmap", "bounce", "mipmap after bounce"};
  const auto found = std::find(stages.begin(), stages.end(), entry.stage);
  return int(found - stages.begin());
}

const VolumeDifference* FolderDifference::first_divergence() const {
  const auto found = std::ranges::find_if(volumes, [&](const VolumeDifference& v) { return v.differs(limits); });
  return found == volumes.end() ? nullptr : &*found;
}

FolderDifference diff_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                              const VolumeLimits& limits, const Progress& progress) {
  const VolumeIndex index_a = read_volume_index(a), index_b = read_volume_index(b);
  FolderDifference folder;
  folder.limits = limits;
  folder.grids = grids_difference(index_a.grid, index_b.grid);
  for (const VolumeEntry& entry : index_a.volumes) {
    if (const VolumeEntry* other = index_b.find(entry.name)) {
      ArrayFile file_a = open_volume(a, entry), file_b = open_volume(b, *other);
      folder.volumes.push_back(diff_volumes(entry, file_a, file_b, limits.tolerance, {}, progress));
    } else {
      folder.volumes.push_back(missing(entry, "only the first side has it"));
    }
  }
  for (const VolumeEntry& entry : index_b.volumes)
    if (!index_a.find(entry.name)) folder.volumes.push_back(missing(entry, "only the second side has it"));
  std::ranges::stable_sort(folder.volumes, {}, [](const VolumeDifference& v) { return stage_rank(v.entry); });
  if (folder.first_divergence() || !folder.grids.empty()) folder.verdict = Verdict::different;
  return folder;
}

nlohmann::json divergence_json(const VolumeDifference& volume) {
  const VolumeEntry& entry = volume.entry;
  nlohmann::json json = {{"stage", entry.stage}, {"volume", entry.name}, {"face", nullptr},
                         {"level", nullptr},     {"voxel", nullptr},     {"channel", nullptr},
                         {"a", nullptr},         {"b", nullptr},         {"problem", nullptr}};
  if (!entry.face.empty()) json["face"] = entry.face;
  if (entry.level >= 0) json["level"] = entry.level;
  if (!volume.problem.empty()) json["problem"] = volume.problem;
  if (const auto& first = volume.values.first) {
    const nlohmann::json mismatch = to_json(*first, true);
    json["voxel"] = voxel_json(first->at);
    json["channel"] = first->channel;
    json["a"] = mismatch["a"];
    json["b"] = mismatch["b"];
  }
  return json;
}

nlohmann::json to_json(const VolumeDifference& volume, const VolumeLimits& limits) {
  nlohmann::json json = to_json(volume.values, true);
  json.update(divergence_json(volume));
  json["name"] = volume.entry.name;
  json["verdict"] = verdict_name(volume.differs(limits) ? Verdict::different : Verdict::same);
  json["missing"] = volume.missing;
  json["occupied"] = {{"a", volume.occupied_a},
                      {"b", volume.occupied_b},
                      {"only_a", volume.occupied_only_a},
                      {"only_b", volume.occupied_only_b}};
  json["steps"] = volume.steps;
  json["within_envelope"] = volume.within_envelope;
  return json;
}

nlohmann::json to_json(const FolderDifference& folder) {
  Difference all;
  for (const VolumeDifference& volume : folder.volumes) all.append(volume.values);
  nlohmann::json json = to_json(all, true);
  for (const char* key : {"worst", "worst_places", "first", "first_nonfinite"}) json.erase(key);  // of which volume?
  const VolumeDifference* worst = nullptr;
  json["per_volume"] = nlohmann::json::array();
  json["missing"] = nlohmann::json::array();
  for (const VolumeDifference& volume : folder.volumes) {
    json["per_volume"].push_back(to_json(volume, folder.limits));
    if (volume.missing) json["missing"].push_back(volume.entry.name);
    if (!volume.values.worst.empty() && (!worst || volume.values.max_abs > worst->values.max_abs)) worst = &volume;
  }
  json["worst"] = nullptr;
  if (worst) {
    json["worst"] = to_json(worst->values.worst.front(), true);
    json["worst"]["volume"] = worst->entry.name;
  }
  json["verdict"] = verdict_name(folder.verdict);
  json["grids"] = folder.grids.empty() ? nlohmann::json() : nlohmann::json(folder.grids);
  const VolumeDifference* first = folder.first_divergence();
  json["first_divergence"] = first ? divergence_json(*first) : nlohmann::json();
  return json;
}

}  // namespace voxref
