#pragma once
#include <filesystem>
#include <optional>

#include "study/chart.h"

namespace voxref {

/// Where the plotting program is; none where it is not installed (Debian: gnuplot-nox).
std::optional<std::filesystem::path> find_gnuplot();

/// Draws a small chart of both kinds that goes nowhere: better before hours of measuring than after.
/// @throws Error with gnuplot's message when it cannot
void require_drawing(const std::filesystem::path& gnuplot);

/// Writes NAME.gnuplot, NAME.svg and NAME.png into the folder. @throws Error with gnuplot's message when it fails
void draw(const Chart& chart, const std::filesystem::path& gnuplot, const std::filesystem::path& folder);

}  // namespace voxref
