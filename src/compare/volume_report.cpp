#include "compare/volume_report.h"

#include <fmt/format.h>

#include <array>

#include "compare/comparison_page.h"
#include "compare/metrics.h"
#include "compare/picture.h"
#include "compare/report_parts.h"
#include "file.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

PageTable volume_table(const std::string& title, const FolderDifference& folder) {
  PageTable table{title,
                  {"volume", "stage", "verdict", "values differing", "largest |a - b|", "PSNR, dB", "steps",
                   "occupied a / b", "on one side only", "within the envelope", "first"},
                  {}};
  for (const VolumeDifference& volume : folder.volumes) {
    const bool differs = volume.differs(folder.limits);
    std::string first = volume.problem;
    if (const auto& m = volume.values.first)
      first = fmt::format("({}, {}, {}) channel {}: {:.6g} instead of {:.6g}", m->at.x, m->at.y, m->at.z, m->channel,
                          m->a, m->b);
    table.rows.push_back({volume.entry.name, volume.entry.stage,
                          differs          ? "different"
                          : volume.missing ? "not compared"
                                           : "same",
                          fmt::format("{}", volume.values.differing), number_text(volume.values.max_abs),
                          number_text(volume.values.psnr()), fmt::format("{:g}", volume.steps),
                          fmt::format("{} / {}", volume.occupied_a, volume.occupied_b),
                          fmt::format("{} + {}", volume.occupied_only_a, volume.occupied_only_b),
                          fmt::format("{}", volume.within_envelope), first});
  }
  return table;
}

/// Slice z as an image; fewer than three channels stand for all colours.
Image slice_image(ArrayFile& file, size_t z) {
  const auto [depth, height, width, channels] = file.shape();
  std::vector<float> slice(file.slice_size());
  file.read_slice(z, slice);
  Image image{int(width), int(height)};
  image.add_layer("");
  const auto planes = image.layer("");
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (size_t c = 0; c < 3; ++c) planes[c][i] = slice[i * channels + (channels >= 3 ? c : 0)];
  return image;
}

/// The same slice of both sides.
struct Slices {
  std::string name;
  size_t z;
  Image a, b;
};

/// Where the volume differs most, or is not finite first, or else its middle.
Slices slices_of(const VolumeDifference& volume) {
  ArrayFile a = volume.a.open(), b = volume.b.open();
  const Difference& values = volume.values;
  const size_t z = values.first_nonfinite ? size_t(values.first_nonfinite->at.z)
                   : values.worst.empty() ? a.shape()[0] / 2
                                          : size_t(values.worst.front().at.z);
  return {volume.entry.name, z, slice_image(a, z), slice_image(b, z)};
}

/// One black pixel, for the page of a comparison that has nothing to show.
Slices no_slices() {
  Image black(1, 1);
  black.add_layer("");
  return {"nothing", 0, black, black};
}

bool has_slices(const VolumeDifference& volume) { return volume.problem.empty() && !volume.b.file.empty(); }

/// The first volume that differs, else the first that can be shown at all.
const VolumeDifference* shown_volume(const FolderDifference& folder) {
  const VolumeDifference* shown = nullptr;
  for (const VolumeDifference& volume : folder.volumes) {
    if (!has_slices(volume)) continue;
    if (volume.differs(folder.limits)) return &volume;
    if (!shown) shown = &volume;
  }
  return shown;
}

void write_slices(const fs::path& folder, const FolderDifference& difference, const std::string& ending) {
  for (const VolumeDifference& volume : difference.volumes) {
    if (!volume.differs(difference.limits) || !has_slices(volume)) continue;
    const Slices slices = slices_of(volume);
    const float exposure = auto_exposure(slices.b);
    write_png(folder / (volume.entry.name + ending),
              side_by_side(std::array{display(slices.a, "", exposure), display(slices.b, "", exposure),
                                      paint(signed_difference(slices.a, slices.b), cool_warm())}));
  }
}

std::string divergence_sentence(const char* where, const FolderDifference& folder) {
  const VolumeDifference* first = folder.first_divergence();
  if (!first) return "";
  const std::string stage = first->entry.stage.empty() ? "" : ", made by " + first->entry.stage;
  return fmt::format("{} first differs in {}{}. ", where, first->entry.name, stage);
}

std::string summary_of(const VolumeReport& report) {
  std::string summary;
  if (report.against && !report.against->grids.empty()) summary = "The grids differ: " + report.against->grids + ". ";
  if (report.recomputed) summary += divergence_sentence("On its own input A", *report.recomputed);
  if (!report.not_recomputed.empty()) summary += "Not recomputed: " + report.not_recomputed + ". ";
  if (report.against) summary += divergence_sentence("Against B, A", *report.against);
  for (const Cause& cause : report.causes) summary += "Likely cause: " + cause.mistake + ". ";
  return summary.empty() ? "All volumes agree within the limits." : summary;
}

}  // namespace

Verdict VolumeReport::verdict() const {
  const bool differs = (against && against->verdict != Verdict::same) ||
                       (recomputed && recomputed->verdict != Verdict::same) || !not_recomputed.empty();
  return differs ? Verdict::different : Verdict::same;
}

nlohmann::json to_json(const VolumeReport& report) {
  nlohmann::json result = to_json(report.first());
  result["verdict"] = verdict_name(report.verdict());
  result["causes"] = to_json(report.causes);
  result["recomputed"] = report.recomputed ? to_json(*report.recomputed) : nlohmann::json();
  result["not_recomputed"] = report.not_recomputed.empty() ? nlohmann::json() : nlohmann::json(report.not_recomputed);
  if (report.recomputed && report.recomputed->first_divergence())
    result["first_divergence"] = result["recomputed"]["first_divergence"];
  return result;
}

void write_volume_report(const fs::path& folder, const VolumeReport& report) {
  make_folder(folder);
  write_slices(folder, report.first(), ".png");
  if (report.against && report.recomputed) write_slices(folder, *report.recomputed, ".recomputed.png");
  write_text(folder / "result.json", to_json(report).dump(2) + "\n");

  const bool own = report.recomputed && report.recomputed->first_divergence();
  const VolumeDifference* shown = shown_volume(own ? *report.recomputed : report.first());
  const Slices slices = shown ? slices_of(*shown) : no_slices();
  ComparisonPage page{.command = "voxref diff",
                      .title = report.title,
                      .verdict = verdict_words(report.verdict()),
                      .tone = tone_of(report.verdict()),
                      .summary = summary_of(report),
                      .unit = shown ? fmt::format("Slice z = {} of {}, y downwards.", slices.z, slices.name)
                                    : "No volume was compared with another: there is no slice to show.",
                      .name_a = "A",
                      .name_b = own || !report.against ? "voxref" : "B",
                      .a = slices.a,
                      .b = slices.b,
                      .exposure = shown ? auto_exposure(slices.b) : 0.0f,
                      .layers = {{slices.name, {""}, {""}}},
                      .tables = {},
                      .provenance = report.provenance};
  if (report.recomputed) page.tables.push_back(volume_table("Each stage on its own input", *report.recomputed));
  if (report.against) page.tables.push_back(volume_table("A against B", *report.against));
  write_text(folder / "report.html", comparison_page(page));
}

}  // namespace voxref
