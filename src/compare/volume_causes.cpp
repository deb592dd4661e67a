#include "compare/volume_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "voxel/volume_file.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

constexpr size_t faces = 6;

std::optional<Field> read_field(ArrayFile& file) {
  const auto [depth, height, width, channels] = file.shape();
  constexpr size_t most_channels = 4;
  if (depth * height * width > most_searched_texels || channels > most_channels) return std::nullopt;
  Field field{{int(width), int(height), int(depth)}, int(channels), std::vector<float>(depth * file.slice_size())};
  for (size_t z = 0; z < depth; ++z)
    file.read_slice(z, std::span(field.values).subspan(z * file.slice_size(), file.slice_size()));
  return field;
}

/// Two folders, and what agrees in them.
struct Folders {
  const fs::path &a, &b;
  VolumeIndex index_a, index_b;
  const VolumeLimits& limits;
  const Progress& progress;

  /// Whether volume `name_a` of the first agrees with volume `name_b` of the second; none where one is absent.
  std::optional<bool> agree(const std::string& name_a, const std::string& name_b) const {
    const VolumeEntry *entry_a = index_a.find(name_a), *entry_b = index_b.find(name_b);
    if (!entry_a || !entry_b) return std::nullopt;
    return !diff_volumes(a, *entry_a, b, *entry_b, limits.tolerance, {}, progress).differs(limits);
  }
};

/// Whether every face of a level holds what another face should, each another one.
std::optional<std::string> turned_faces(const Folders& folders, int level, bool bounced) {
  const auto name = [&](size_t face) { return aniso_name(face, size_t(level), bounced); };
  std::string order;
  bool turned = false;
  std::array<bool, faces> taken{};
  for (size_t face = 0; face < faces; ++face) {
    size_t held = faces;
    for (size_t k = 0; k < faces && held == faces; ++k) {
      const size_t candidate = (face + k) % faces;  // its own first: symmetric volumes have several
      if (!taken[candidate] && folders.agree(name(face), name(candidate)).value_or(false)) held = candidate;
    }
    if (held == faces) return std::nullopt;
    taken[held] = true;
    turned |= held != face;
    if (held != face)
      order += fmt::format("{}{} holds {}", order.empty() ? "" : ", ", face_names[face], face_names[held]);
  }
  if (!turned) return std::nullopt;
  return "faces in another order: " + order;
}

/// The first level from the entry's on with at most 64 texels a side: 36 pairs of faces are to be compared.
int cheap_level(const Folders& folders, const VolumeEntry& entry) {
  constexpr size_t most_side = 64;
  const VolumeEntry* cheap = &entry;
  const bool bounced = entry.name.starts_with("aniso_bounce");
  const auto face = size_t(std::ranges::find(face_names, entry.face) - face_names.begin());
  while (face < faces && std::max({cheap->shape[0], cheap->shape[1], cheap->shape[2]}) > most_side) {
    const VolumeEntry* next = folders.index_a.find(aniso_name(face, size_t(cheap->level + 1), bounced));
    if (!next) break;
    cheap = next;
  }
  return cheap->level;
}

/// Whether each level holds what the one before or after it should.
std::optional<std::string> shifted_levels(const Folders& folders, const std::string& face, bool bounced) {
  const auto at = std::ranges::find(face_names, face);
  if (at == face_names.end()) return std::nullopt;
  const auto name = [&](int level) { return aniso_name(size_t(at - face_names.begin()), size_t(level), bounced); };
  for (const int shift : {1, -1}) {
    int compared = 0, agreeing = 0;
    for (int level = 0; level < 16; ++level) {
      if (level + shift < 0) continue;
      const auto agrees = folders.agree(name(level), name(level + shift));
      if (!agrees) continue;
      ++compared;
      agreeing += *agrees;
    }
    if (compared >= 2 && agreeing == compared)
      return fmt::format("mip levels one off: level k holds what level k {} 1 should", shift > 0 ? "+" : "-");
  }
  return std::nullopt;
}

}  // namespace

std::vector<Cause> volume_causes(ArrayFile& a, ArrayFile& b, const Tolerance& tolerance, const Progress& progress) {
  const std::optional<Field> field_a = read_field(a), field_b = read_field(b);
  if (!field_a || !field_b) return {};
  // Half of the last place that a byte rounds away, with a little room, where either side is in bytes.
  constexpr double byte_rounding = 0.6 / 255.0;
  const bool bytes = a.type() == ElementType::uint8 || b.type() == ElementType::uint8;
  const Tolerance loose{10.0 * tolerance.absolute + (bytes ? byte_rounding : 0.0), 10.0 * tolerance.relative};
  return likely_causes(
      *field_a, *field_b, [&](const Mistake& mistake) { return explains(mistake, *field_a, *field_b, loose); },
      progress);
}

std::vector<Cause> volume_causes(const fs::path& a, const fs::path& b, const FolderDifference& folder,
                                 const Progress& progress) {
  const VolumeDifference* first = folder.first_divergence();
  if (!first || first->missing || first->values.nonfinite > 0) return {};
  progress.check();
  const Folders folders{a, b, read_volume_index(a), read_volume_index(b), folder.limits, progress};
  const VolumeEntry& entry = first->entry;
  if (!entry.face.empty() && entry.level >= 0) {
    const bool bounced = entry.name.starts_with("aniso_bounce");
    if (const auto order = turned_faces(folders, cheap_level(folders, entry), bounced)) return {{*order, 1.0, 0.0}};
    if (const auto levels = shifted_levels(folders, entry.face, bounced)) return {{*levels, 1.0, 0.0}};
  }
  ArrayFile file_a = open_volume(a, *folders.index_a.find(entry.name));
  ArrayFile file_b = open_volume(b, *folders.index_b.find(entry.name));
  return volume_causes(file_a, file_b, folder.limits.tolerance, progress);
}

}  // namespace voxref
