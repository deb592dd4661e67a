#include "compare/image_report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "compare/comparison_page.h"
#include "compare/picture.h"
#include "compare/report_parts.h"
#include "file.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

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
  add("largest |a - b|", [](const Difference& d) { return number_text(d.max_abs); });
  add("mean of a - b", [](const Difference& d) { return number_text(d.mean_signed()); });
  add("RMSE", [](const Difference& d) { return number_text(d.rmse()); });
  add("relMSE", [](const Difference& d) { return number_text(d.relmse()); });
  return table;
}

PageTable perceptual_table(const ImageDiff& diff) {
  PageTable table{"As seen", {"metric", "value", "what it says"}, {}};
  table.rows.push_back({"PSNR", number_text(diff.psnr) + (std::isfinite(diff.psnr) ? " dB" : ""),
                        fmt::format("of the pictures as shown: x 2^{:.3g}, clipped, sRGB", diff.exposure)});
  if (!diff.perceptual) return table;
  const PerceptualDifference& eye = *diff.perceptual;
  table.rows.push_back(
      {"SSIM", number_text(eye.displayed.ssim), "structural similarity of the pictures as shown (Wang et al. 2004)"});
  table.rows.push_back(
      {"FLIP", number_text(eye.displayed.flip), "mean LDR-FLIP of the pictures as shown (Andersson et al. 2020)"});
  table.rows.push_back({"HDR-FLIP", number_text(eye.hdr_flip),
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
    table.rows.push_back({name + " " + region.channel, number_text(region.a.mean), number_text(region.b.mean),
                          number_text(region.difference()), number_text(region.confidence), number_text(region.margin),
                          number_text(region.detectable), number_text(region.p)});
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
    table.rows.push_back(
        {fmt::format("({}, {}) {}", m.at.x, m.at.y, "RGB"[m.channel]), number_text(m.a), number_text(m.b)});
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

}  // namespace

void write_image_report(const fs::path& folder, const ImageReport& report) {
  make_folder(folder);
  const auto& [a, b, diff, result, provenance] = report;
  const ValueMap difference = signed_difference(a, b);
  const Picture shown_a = display(a, "", diff.exposure), shown_b = display(b, "", diff.exposure);
  write_png(folder / "a.png", shown_a);
  write_png(folder / "b.png", shown_b);
  write_png(folder / "difference.png", paint_with_bar(difference, cool_warm()));
  write_png(folder / "relative_error.png", paint_with_bar(relative_error(a, b), inferno()));
  write_png(folder / "comparison.png", side_by_side(std::array{shown_a, shown_b, paint(difference, cool_warm())}));
  write_text(folder / "result.json", result.dump(2) + "\n");
  ComparisonPage page{
      .command = "voxref diff",
      .title = name_of(provenance.value("a", "a")) + " against " + name_of(provenance.value("b", "b")),
      .verdict = verdict_words(diff.verdict),
      .tone = tone_of(diff.verdict),
      .summary = sentences(diff.reasons, diff.causes),
      .unit = "Linear values, as the files hold them once decoded.",
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

}  // namespace voxref
