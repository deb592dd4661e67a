#pragma once
// The one file that knows which Catch2 is installed.
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
#include <catch2/catch_approx.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

/// Ends the test as skipped: CTest looks for the word.
#define VOXREF_SKIP(reason)                       \
  do {                                            \
    std::cout << "SKIPPED: " << (reason) << "\n"; \
    return;                                       \
  } while (false)

/// A file of the shared real scenes: in VOXREF_ASSETS, or in ../shared beside the checkout; none where they are absent.
/// @param path relative to the folder that holds `assets` and `gpu`, for instance "assets/scenes/sponza.glb"
inline std::optional<std::filesystem::path> shared_file(const std::filesystem::path& path) {
  const char* assets = std::getenv("VOXREF_ASSETS");
  for (const std::filesystem::path& root : {assets ? std::filesystem::path(assets) : std::filesystem::path(),
                                            std::filesystem::path(VOXREF_SOURCE_DIR).parent_path() / "shared"})
    if (!root.empty() && std::filesystem::exists(root / path)) return root / path;
  return std::nullopt;
}
