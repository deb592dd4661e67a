#include "compare/diff_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/comparison_page.h"
#include "compare/metrics.h"
#include "compare/picture.h"
#include "error.h"
#include "file.h"
#include "voxel/volume_file.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(folder.string(), "cannot be made: " + failure.message());
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "undefined"; }

PageTone tone_of(Verdict verdict) {
  return verdict == Verdict::same ? PageTone::good : verdict == Verdict::different ? PageTone::bad : PageTone::open;
}

std::string verdict_words(Verdict verdict) {
  return verdict == Verdict::same ? "same" : verdict == Verdict::different ? "different" : "too noisy";
}

std::string sentences(const std::vector<std::string>& reasons, const std::vector<Cause>& causes) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  for (const Cause& cause : causes) text += (text.empty() ? "" : ". ") + ("Likely cause: " + cause.mistake);
  return text.empty() ? "All values agree within the limits." : text + ".";
}

PageTable value_table(const ImageDiff& diff) {
  PageTable table{"Values", {"", "R, G, B", "R", "G", "B", "luminance"}, {}};
  const auto add = [&](const char* name, const auto& value) {
    table.rows.push_back({name, value(diff.all), value(diff.channels[0]), value(diff.channels[1]),
                          value(diff.channels[2]), value(diff.luminance)});
  };
  add("differing", [](const Difference& d) { return fmt::format("{} ({:.3g} %)", d.differing, 100 * d.fraction()); });
  add("not finite", [](const Difference& d) { return fmt::format("{}", d.nonfinite); });
  add("largest |a - b|", [](const Difference& d) { return number(d.max_abs); });
  add("mean of a - b", [](const Difference& d) { return number(d.mean_signed()); });
  add("RMSE", [](const Difference& d) { return number(d.rmse()); });
  add("relMSE", [](const Difference& d) { return number(d.relmse()); });
  return table;
}

PageTable perceptual_table(const ImageDiff& diff) {
  PageTable table{"As seen", {"metric", "value", "what it says"}, {}};
  table.rows.push_back({"PSNR", number(diff.psnr) + " dB",
                        fmt::format("of the pictures as shown: x 2^{:.3g}, clipped, sRGB", diff.exposure)});
  if (!diff.perceptual) return table;
  const PerceptualDifference& eye = *diff.perceptual;
  table.rows.push_back(
      {"SSIM", number(eye.displayed.ssim), "structural similarity of the pictures as shown (Wang et al. 2004)"});
  table.rows.push_back(
      {"FLIP", number(eye.displayed.flip), "mean LDR-FLIP of the pictures as shown (Andersson et al. 2020)"});
  table.rows.push_back({"HDR-FLIP", number(eye.hdr_flip),
                        fmt::format("mean of the largest over {} exposures from {:+.3g} to {:+.3g} stops (Andersson et "
                                    "al. 2021)",
                                    eye.exposures.count, eye.exposures.start, eye.exposures.stop)});
  table.rows.push_back({"Yee", fmt::format("{} pixels", eye.yee_pixels),
                        "pixels that an observer could tell apart (Yee 2004), 100 cd/m², 45 degrees"});
  return table;
}

PageTable noise_table(const NoiseVerdict& noise) {
  PageTable table{"Under noise", {"region", "a", "b", "difference", "± confidence", "margin", "detectable", "p"}, {}};
  const auto add = [&](const std::string& name, const RegionTest& region) {
    table.rows.push_back({name + " " + region.channel, number(region.a.mean), number(region.b.mean),
                          number(region.difference()), number(region.confidence), number(region.margin),
                          number(region.detectable), number(region.p)});
  };
  for (const RegionTest& image : noise.image) add("image", image);
  const auto place = [](const RegionTest& r) { return fmt::format("at ({}, {})", r.x, r.y); };
  if (noise.worst_tile) add("worst tile " + place(*noise.worst_tile), *noise.worst_tile);
  if (noise.noisiest_tile) add("noisiest tile " + place(*noise.noisiest_tile), *noise.noisiest_tile);
  if (noise.worst_pixel) add("worst pixel " + place(*noise.worst_pixel), *noise.worst_pixel);
  return table;
}

PageTable worst_table(const Difference& all) {
  PageTable table{"Worst values", {"place", "a", "b"}, {}};
  for (const Mismatch& m : all.worst)
    table.rows.push_back({fmt::format("({}, {}) {}", m.at.x, m.at.y, "RGB"[m.channel]), number(m.a), number(m.b)});
  return table;
}

PageTable histogram_table(const Difference& all) {
  PageTable table{"Histogram", {"|a - b|", "values"}, {}};
  for (size_t i = 0; i < Difference::bins; ++i) {
    if (all.histogram[i] == 0) continue;
    const int decade = Difference::first_decade + int(i);
    table.rows.push_back({i == 0 ? fmt::format("below 1e{}", decade) : fmt::format("from 1e{}", decade - 1),
                          fmt::format("{}", all.histogram[i])});
  }
  return table;
}

PageTable volume_table(const std::string& title, const FolderDifference& folder) {
  PageTable table{title,
                  {"volume", "stage", "verdict", "values differing", "largest |a - b|", "steps", "occupied a / b",
                   "on one side only", "within the envelope", "first"},
                  {}};
  for (const VolumeDifference& volume : folder.volumes) {
    const bool differs = volume.differs(folder.limits);
    std::string first = volume.problem;
    if (const auto& m = volume.values.first)
      first = fmt::format("({}, {}, {}) channel {}: {:.6g} instead of {:.6g}", m->at.x, m->at.y, m->at.z, m->channel,
                          m->a, m->b);
    table.rows.push_back({volume.entry.name, volume.entry.stage, differs ? "different" : "same",
                          fmt::format("{}", volume.values.differing), number(volume.values.max_abs),
                          fmt::format("{:g}", volume.steps),
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

struct Slices {
  std::string name;
  size_t z;
  Image a, b;
};

/// Where the volume differs most, or its middle.
Slices slices_of(const VolumeReport& report, const VolumeDifference& volume) {
  const auto open = [&](const fs::path& folder) {
    return open_volume(folder, *read_volume_index(folder).find(volume.entry.name));
  };
  ArrayFile a = open(report.a), b = open(report.b);
  const size_t z = volume.values.worst.empty() ? a.shape()[0] / 2 : size_t(volume.values.worst.front().at.z);
  return {volume.entry.name, z, slice_image(a, z), slice_image(b, z)};
}

bool has_slices(const VolumeDifference& volume) { return !volume.missing && volume.problem.empty(); }

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

void write_slices(const fs::path& file, const Slices& slices) {
  const float exposure = auto_exposure(slices.b);
  write_png(file, side_by_side(std::array{display(slices.a, "", exposure), display(slices.b, "", exposure),
                                          paint(signed_difference(slices.a, slices.b), cool_warm())}));
}

std::string divergence_sentence(const char* where, const FolderDifference& folder) {
  const VolumeDifference* first = folder.first_divergence();
  return first ? fmt::format("{} first differs in {}, made by {}. ", where, first->entry.name, first->entry.stage) : "";
}

}  // namespace

void write_image_report(const fs::path& folder, const ImageReport& report) {
  make_folder(folder);
  const auto& [a, b, diff, provenance] = report;
  const ValueMap difference = signed_difference(a, b);
  const Picture shown_a = display(a, "", diff.exposure), shown_b = display(b, "", diff.exposure);
  write_png(folder / "a.png", shown_a);
  write_png(folder / "b.png", shown_b);
  write_png(folder / "difference.png", paint_with_bar(difference, cool_warm()));
  write_png(folder / "relative_error.png", paint_with_bar(relative_error(a, b), inferno()));
  write_png(folder / "comparison.png", side_by_side(std::array{shown_a, shown_b, paint(difference, cool_warm())}));
  write_text(folder / "result.json", to_json(diff).dump(2) + "\n");
  ComparisonPage page{
      .command = "voxref diff",
      .title = fs::path(provenance.value("a", "a")).filename().string() + " against " +
               fs::path(provenance.value("b", "b")).filename().string(),
      .verdict = verdict_words(diff.verdict),
      .tone = tone_of(diff.verdict),
      .summary = sentences(diff.reasons, diff.causes),
      .unit = "Values here to about 0.4 %.",
      .name_a = "A",
      .name_b = "B",
      .a = a,
      .b = b,
      .exposure = diff.exposure,
      .layers = {{"compared", {""}, {""}}},
      .tables = {value_table(diff), perceptual_table(diff), worst_table(diff.all), histogram_table(diff.all)},
      .provenance = provenance};
  if (diff.noise) page.tables.insert(page.tables.begin() + 1, noise_table(*diff.noise));
  write_text(folder / "report.html", comparison_page(page));
}

void write_volume_report(const fs::path& folder, const VolumeReport& report) {
  make_folder(folder);
  const FolderDifference& difference = report.difference;
  for (const VolumeDifference& volume : difference.volumes)
    if (volume.differs(difference.limits) && has_slices(volume))
      write_slices(folder / (volume.entry.name + ".png"), slices_of(report, volume));
  nlohmann::json result = to_json(difference);
  result["causes"] = to_json(report.causes);
  if (report.recomputed) result["recomputed"] = to_json(*report.recomputed);
  write_text(folder / "result.json", result.dump(2) + "\n");

  const VolumeDifference* shown = shown_volume(difference);
  const Slices slices = shown ? slices_of(report, *shown) : Slices{"nothing", 0, Image(1, 1), Image(1, 1)};
  std::string summary = difference.grids.empty() ? "" : "The grids differ: " + difference.grids + ". ";
  if (report.recomputed) summary += divergence_sentence("On its own input A", *report.recomputed);
  summary += divergence_sentence("Against B, A", difference);
  for (const Cause& cause : report.causes) summary += "Likely cause: " + cause.mistake + ". ";
  ComparisonPage page{
      .command = "voxref diff",
      .title = report.a.filename().string() + " against " + report.b.filename().string(),
      .verdict = verdict_words(difference.verdict),
      .tone = tone_of(difference.verdict),
      .summary = summary.empty() ? "All volumes agree within the limits." : summary,
      .unit = fmt::format("Slice z = {} of {}, y downwards. Values here to about 0.4 %.", slices.z, slices.name),
      .name_a = "A",
      .name_b = "B",
      .a = slices.a,
      .b = slices.b,
      .exposure = shown ? auto_exposure(slices.b) : 0.0f,
      .layers = {{slices.name, {""}, {""}}},
      .tables = {},
      .provenance = report.provenance};
  if (report.recomputed) page.tables.push_back(volume_table("Each stage on its own input", *report.recomputed));
  page.tables.push_back(volume_table("A against B", difference));
  write_text(folder / "report.html", comparison_page(page));
}

}  // namespace voxref
