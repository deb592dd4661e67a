#include "summary.h"

#include <fmt/format.h>

namespace voxref {

std::string byte_count(size_t bytes) {
  const double count = static_cast<double>(bytes);
  if (count >= 0x1p30) return fmt::format("{:.2f} GiB", count * 0x1p-30);
  if (count >= 0x1p20) return fmt::format("{:.1f} MiB", count * 0x1p-20);
  if (count >= 0x1p10) return fmt::format("{:.1f} KiB", count * 0x1p-10);
  return fmt::format("{} bytes", bytes);
}

void say(Terminal& terminal, const PathResult& result) {
  const double rays = static_cast<double>(result.rays);
  terminal.say(fmt::format("path      {} samples per pixel, {:.2f} s, {:.2f} million rays per second", result.spp,
                           result.seconds, result.seconds > 0 ? 1e-6 * rays / result.seconds : 0.0));
  terminal.say(fmt::format("mean      {:.6g} {:.6g} {:.6g}  +- {:.2g} {:.2g} {:.2g}", result.mean.r, result.mean.g,
                           result.mean.b, result.mean_stderr.r, result.mean_stderr.g, result.mean_stderr.b));
  if (result.nonfinite > 0)
    terminal.warn(fmt::format("voxref: warning: {} contributions were not finite, the first at {}", result.nonfinite,
                              result.first_nonfinite));
}

void warn(Terminal& terminal, const Clamping& clamped, Storage storage, const std::string& stage) {
  if (clamped.voxels == 0) return;
  const auto limit = [](const auto& texel) { return greatest<typename std::decay_t<decltype(texel)>::type>; };
  terminal.warn(fmt::format(
      "voxref: warning: storage {} holds radiance up to {}: after {} that of {} voxels was clamped, "
      "the brightest {:.4g}",
      storage_names[size_t(storage)], with_texel(storage, limit), stage, clamped.voxels, clamped.brightest));
}

void warn_nonfinite(Terminal& terminal, const ConeImage& image) {
  if (image.nonfinite > 0)
    terminal.warn(fmt::format("voxref: warning: {} pixels are not finite, the first at {}", image.nonfinite,
                              image.first_nonfinite));
}

void say(Terminal& terminal, const ConeTraceResult& result, Storage storage) {
  const StageSeconds& s = result.seconds;
  terminal.say(fmt::format("cone      {}x{}x{} grid, {} voxels occupied, {} bounces", result.grid.size.x,
                           result.grid.size.y, result.grid.size.z, result.voxels_occupied, result.bounces));
  terminal.say(
      fmt::format("seconds   voxelize {:.2f}, shade {:.2f}, mipmap {:.2f}, bounce {:.2f}, prepare {:.2f}, "
                  "cone trace {:.2f}, total {:.2f}",
                  s.voxelize, s.shade, s.mipmap, s.bounce, s.prepare, s.cone_trace, s.total));
  std::string memory = "memory   ";
  for (const auto& [volume, bytes] : result.bytes) memory += fmt::format(" {} {},", volume, byte_count(bytes));
  memory.pop_back();  // the last comma
  terminal.say(memory);
  terminal.say(fmt::format("mean      {:.6g} {:.6g} {:.6g}", result.mean.r, result.mean.g, result.mean.b));
  if (const NonfiniteVoxels& voxels = result.nonfinite_voxels; voxels.count > 0)
    terminal.warn(fmt::format("voxref: warning: the light of {} voxels is not finite, the first is ({}, {}, {})",
                              voxels.count, voxels.first.x, voxels.first.y, voxels.first.z));
  warn_nonfinite(terminal, result.image);
  warn(terminal, result.clamped_shade, storage, "shading");
  warn(terminal, result.clamped_bounce, storage, "the last bounce");
}

}  // namespace voxref
