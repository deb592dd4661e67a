#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace voxref {

/// The files that a command line names: what is read, and what is written.
struct NamedFiles {
  std::filesystem::path scene, config;            ///< read; empty: none
  std::vector<std::filesystem::path> written;     ///< by -o
  std::optional<std::filesystem::path> volumes;   ///< the folder of --volumes
  std::vector<std::filesystem::path> compared{};  ///< read
};

/// Checks before work begins that nothing which is written would replace what is read, or what else is written.
/// @throws Error with the flag
void require_no_clash(const NamedFiles& files);

/// Whether both name one file or folder, be it there or not.
bool same_place(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace voxref
