#pragma once
#include "pipeline.h"
#include "reference/path.h"
#include "terminal.h"

namespace voxref {

/// The result in a few aligned lines, on the terminal as it is configured.
void say(Terminal& terminal, const PathResult& result);
void say(Terminal& terminal, const ConeTraceResult& result, Storage storage);
/// Says what is not finite, if anything.
void warn_nonfinite(Terminal& terminal, const ConeImage& image);
/// Says what a storage clamped, if anything. @param stage that made it
void warn(Terminal& terminal, const Clamping& clamped, Storage storage, const std::string& stage);

/// "1.5 GiB", "12.0 MiB", "340 bytes"
std::string byte_count(size_t bytes);

}  // namespace voxref
