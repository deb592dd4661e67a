#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "reference/tiles.h"

namespace voxref {

/// "I/N" with 1 <= I <= N; nothing where the text is anything else.
std::optional<Part> parse_part(std::string_view text);

/// Compares what two renders depend on, each one JSON object.
/// @returns nothing where they agree, else the first value that differs, by its place: "path.seed: 7, but 0"
std::optional<std::string> difference_of(const std::string& expected, const std::string& found);

}  // namespace voxref
