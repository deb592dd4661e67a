#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/image_diff.h"
#include "compare/volume_diff.h"
#include "image/transfer.h"
#include "options.h"
#include "terminal.h"

namespace voxref {

/// What the command line of `diff` says.
struct DiffOptions {
  CommonOptions common;
  std::string a, b, output;  ///< empty: not given
  std::string layer_a, layer_b;
  std::optional<Transfer> transfer_a, transfer_b;
  std::optional<double> absolute, relative;
  double fraction = 0.0;
  ImageDiffOptions image;
  std::optional<int> mip;  ///< of files with several levels of detail; none: all
  bool volume = false;     ///< arrays of three sides are volumes whatever their shape
  bool strict = false;
  SceneOptions scene;  ///< of --recompute
  SettingsOptions settings;
  glm::vec3 background{0.0f};

  Tolerance tolerance() const {
    const Tolerance usual;
    return {absolute.value_or(usual.absolute), relative.value_or(usual.relative)};
  }
  VolumeLimits volume_limits() const { return {tolerance(), fraction, strict}; }
};

void add_diff_options(CLI::App& command, const std::shared_ptr<DiffOptions>& options);

/// What was compared, for reports.
nlohmann::json diff_origin(const DiffOptions& options);
std::string diff_title(const DiffOptions& options);

/// Which level of detail of A is held against which of B.
struct MipPair {
  int a = 0, b = 0;
};
/// All, or the one that was asked for. @throws Error where the two files have not as many
std::vector<MipPair> mip_pairs(const DiffOptions& options);

void say_causes(Terminal& terminal, const std::vector<Cause>& causes);
/// Writes where the report is and the result. @return the exit status
int finish_diff(Terminal& terminal, const DiffOptions& options, const nlohmann::json& result, Verdict verdict);

// The three that `diff` can compare. Each returns the exit status.
int diff_images_of(const DiffOptions& options, Terminal& terminal);
/// Two files.
int diff_volumes_of(const DiffOptions& options, Terminal& terminal);
/// Both folders, or one against what voxref makes of its own input, or both of these.
int diff_folders_of(const DiffOptions& options, Terminal& terminal);

}  // namespace voxref
