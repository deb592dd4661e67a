#pragma once
#include <array>
#include <string>
#include <string_view>

/// What is done with an input of a fuzzer: it is read as a file of one format, in every way that the format can be
/// read. A reader may succeed, or refuse with an Error of one line that begins with the file's name.
/// @returns what else it did; empty: nothing
struct FuzzTarget {
  std::string_view name;  ///< of its folder in corpus/
  std::string (*run)(std::string_view input);
};

std::string fuzz_npy(std::string_view input);
std::string fuzz_dds(std::string_view input);
std::string fuzz_raw(std::string_view input);       ///< a raw array's description, for a file of 96 bytes
std::string fuzz_volumes(std::string_view input);   ///< volumes.json
std::string fuzz_settings(std::string_view input);  ///< --config
std::string fuzz_gltf(std::string_view input);      ///< .gltf or .glb
std::string fuzz_image(std::string_view input);     ///< OpenEXR, PNG, TIFF or Radiance's HDR, as its first bytes say

inline constexpr std::array<FuzzTarget, 7> fuzz_targets = {{{"npy", fuzz_npy},
                                                            {"dds", fuzz_dds},
                                                            {"raw", fuzz_raw},
                                                            {"volumes", fuzz_volumes},
                                                            {"settings", fuzz_settings},
                                                            {"gltf", fuzz_gltf},
                                                            {"image", fuzz_image}}};
