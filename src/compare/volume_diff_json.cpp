#include <nlohmann/json.hpp>

#include "compare/volume_diff.h"

namespace voxref {

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
    json["voxel"] = {first->at.x, first->at.y, first->at.z};
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
