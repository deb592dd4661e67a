#include "compare/volume_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

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

}  // namespace

bool VolumeDifference::differs(const VolumeLimits& limits) const {
  if (missing) return limits.strict;
  return !problem.empty() || values.nonfinite > 0 || values.fraction() > limits.fraction;
}

VolumeDifference diff_volumes(const VolumeEntry& entry, const VolumeSource& a, const VolumeSource& b,
                              const Tolerance& tolerance, const TexelEnvelope& envelope, const Progress& progress) {
  VolumeDifference diff;
  diff.entry = entry;
  diff.a = a;
  diff.b = b;
  ArrayFile file_a = a.open(), file_b = b.open();
  diff.entry.shape = file_a.shape();
  if (file_a.shape() != file_b.shape()) {
    diff.problem = shape_text(file_a.shape()) + " instead of " + shape_text(file_b.shape());
    return diff;
  }
  const ElementType storage = coarser(file_a.type(), file_b.type());
  std::vector<float> slice_a(file_a.slice_size()), slice_b(file_b.slice_size());
  const auto [depth, height, width, channels] = file_a.shape();
  const size_t row = width * channels;
  for (size_t z = 0; z < depth; ++z) {
    progress.check();
    progress("comparing", double(z) / double(depth));
    file_a.read_slice(z, slice_a);
    file_b.read_slice(z, slice_b);
    for (size_t y = 0; y < height; ++y)
      compare_texels(diff, std::span(slice_a).subspan(y * row, row), std::span(slice_b).subspan(y * row, row),
                     {0, int(y), int(z)}, tolerance, storage, envelope);
  }
  return diff;
}

VolumeDifference diff_volumes(const std::filesystem::path& folder_a, const VolumeEntry& a,
                              const std::filesystem::path& folder_b, const VolumeEntry& b, const Tolerance& tolerance,
                              const TexelEnvelope& envelope, const Progress& progress) {
  open_volume(folder_a, a);
  open_volume(folder_b, b);
  return diff_volumes(a, {folder_a / a.file, a.mip}, {folder_b / b.file, b.mip}, tolerance, envelope, progress);
}

VolumeDifference not_compared(const VolumeEntry& entry, const std::string& why) {
  VolumeDifference volume;
  volume.entry = entry;
  volume.problem = why;
  volume.missing = true;
  return volume;
}

TexelEnvelope texel_envelope(std::shared_ptr<const std::vector<VoxelEnvelope>> envelopes, const std::string& volume) {
  std::array<AverageEnvelope, 3> VoxelEnvelope::*channels = nullptr;
  if (volume == "albedo") channels = &VoxelEnvelope::albedo;
  if (volume == "normal") channels = &VoxelEnvelope::normal;
  if (volume == "emission") channels = &VoxelEnvelope::emission;
  if (!channels) throw Error("envelope", "'" + volume + "' is no average of fragments");
  return [sorted = std::move(envelopes), channels](const glm::ivec3& voxel, std::span<const float> texel) {
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
  const auto rank = [&](const std::string& stage) { return int(std::ranges::find(stages, stage) - stages.begin()); };
  return std::min(rank(entry.stage), rank(stage_making(entry.name)));  // others have other words for a stage
}

const VolumeDifference* FolderDifference::first_divergence() const {
  const auto found = std::ranges::find_if(volumes, [&](const VolumeDifference& v) { return v.differs(limits); });
  return found == volumes.end() ? nullptr : &*found;
}

void FolderDifference::conclude(const std::string& whose) {
  if (std::ranges::all_of(volumes, [](const VolumeDifference& v) { return v.missing; }))
    throw Error(whose, "volumes", "has none that could be compared");
  std::ranges::stable_sort(volumes, {}, [](const VolumeDifference& v) { return stage_rank(v.entry); });
  verdict = first_divergence() || !grids.empty() ? Verdict::different : Verdict::same;
}

FolderDifference diff_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                              const VolumeLimits& limits, const Progress& progress) {
  const VolumeIndex index_a = read_volume_index(a), index_b = read_volume_index(b);
  FolderDifference folder;
  folder.limits = limits;
  folder.grids = grids_difference(index_a.grid, index_b.grid);
  for (const VolumeEntry& entry : index_a.volumes) {
    if (const VolumeEntry* other = index_b.find(entry.name))
      folder.volumes.push_back(diff_volumes(a, entry, b, *other, limits.tolerance, {}, progress));
    else
      folder.volumes.push_back(not_compared(entry, "only the first side has it"));
  }
  for (const VolumeEntry& entry : index_b.volumes)
    if (!index_a.find(entry.name)) folder.volumes.push_back(not_compared(entry, "only the second side has it"));
  folder.conclude(index_file(a).string());
  return folder;
}

FolderDifference find_nonfinite(const std::filesystem::path& folder, const VolumeLimits& limits,
                                const Progress& progress) {
  FolderDifference found;
  found.limits = limits;
  for (const VolumeEntry& entry : read_volume_index(folder).volumes) {
    VolumeDifference& volume = found.volumes.emplace_back();
    volume.entry = entry;
    ArrayFile file = open_volume(folder, entry);
    const auto [depth, height, width, channels] = file.shape();
    std::vector<float> slice(file.slice_size()), finite;
    for (size_t z = 0; z < depth; ++z) {
      progress.check();
      progress("looking for NaN", double(z) / double(depth));
      file.read_slice(z, slice);
      finite = slice;
      std::ranges::replace_if(
          finite, [](float v) { return !std::isfinite(v); }, 0.0f);
      for (size_t y = 0, row = width * channels; y < height; ++y)
        compare_row(volume.values, std::span(slice).subspan(y * row, row), std::span(finite).subspan(y * row, row),
                    {{0, int(y), int(z)}, 0, int(channels)}, limits.tolerance);
    }
    if (const auto& first = volume.values.first_nonfinite)
      volume.problem =
          fmt::format("{} values are NaN or infinite, the first at voxel ({}, {}, {}) channel {}: {}",
                      volume.values.nonfinite, first->at.x, first->at.y, first->at.z, first->channel, first->a);
  }
  found.conclude(index_file(folder).string());
  return found;
}

}  // namespace voxref
