#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/causes.h"
#include "compare/volume_diff.h"

namespace voxref {

/// What a comparison of volumes found; one of the two differences at least is there.
struct VolumeReport {
  std::string title;                             ///< what was compared
  std::optional<FolderDifference> against{};     ///< A against B
  std::optional<FolderDifference> recomputed{};  ///< each stage of A against voxref on that stage's own input
  std::string not_recomputed{};                  ///< why not, where it was asked for; empty: it was, or was not
  std::vector<Cause> causes{};                   ///< of what differs from B
  nlohmann::json provenance{};                   ///< object

  /// `same` where all that was compared is.
  Verdict verdict() const;
  /// What differs from B, or else from voxref.
  const FolderDifference& first() const { return against ? *against : *recomputed; }
};

/// The keys of cli.md: of A against B where there is a B, else of the recomputation, which is in `recomputed` in any
/// case. The verdict is that of both; first_divergence is where the recomputation differs first, else where B does.
nlohmann::json to_json(const VolumeReport& report);

/// Into a folder, which is made where it is not there: for every volume that differs NAME.png (from B, or from voxref
/// where there is no B) and NAME.recomputed.png (from voxref where there is), the slice across z with the largest
/// difference: a, b, and the difference of the luminances; result.json; report.html, which shows the first of them.
/// The files of both sides must still be there. @throws Error with the path of what cannot be written
void write_volume_report(const std::filesystem::path& folder, const VolumeReport& report);

}  // namespace voxref
