// Light that is lost, or grows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/statistics.h"
#include "error.h"
#include "image/image.h"
#include "make_scenes/builders.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

Scene box_under(float power) {
  Scene scene = cornell_box(CornellLight::point);
  for (Light& light : scene.lights) light.intensity *= power;
  return scene;
}

/// What direct light makes of the box's voxels at power 1.
struct BoxVoxels {
  SurfaceGrid surfaces;
  std::vector<glm::vec3> radiance;
  double peak = 0.0;  ///< W/(sr m^2), of any channel
};

BoxVoxels box_voxels_at_power_1() {
  const Scene scene = box_under(1.0f);
  const Caster caster(scene);
  BoxVoxels box;
  box.surfaces = voxelize(scene, fit_grid(scene.bounds(), small_settings(box_voxels).grid), {});
  box.radiance = shade(scene, &caster, box.surfaces, {}, {}).radiance;
  for (const glm::vec3& r : box.radiance) box.peak = std::max({box.peak, double(r.r), double(r.g), double(r.b)});
  return box;
}

/// Share of the voxels' light, by area, that bytes hold: each channel to the nearest of 255 steps and to 1.
double held_by_bytes(const BoxVoxels& box, double power) {
  double held = 0.0, all = 0.0;
  for (size_t i = 0; i < box.radiance.size(); ++i) {
    const glm::vec3 radiance = box.radiance[i] * static_cast<float>(power);
    glm::vec3 stored;
    for (int c = 0; c < 3; ++c) stored[c] = std::round(std::min(radiance[c], 1.0f) * 255.0f) / 255.0f;
    held += double(box.surfaces.area[i]) * double(luminance(stored));
    all += double(box.surfaces.area[i]) * double(luminance(radiance));
  }
  return held / all;
}

}  // namespace

Failure clamping() {
  Failure failure{"Clamping in bytes",
                  "",
                  {"stability_clamping",
                   "Mean indirect light in unorm8 over that in float32, by the voxels' peak",
                   {{"peak", "W/(sr m^2)"}, {"ratio", ""}, {"theory", ""}}}};
  const BoxVoxels box = box_voxels_at_power_1();
  std::vector<ChartPoint> brighter, darker;  // from the peak 1 on: what is lost
  double below = 0.0, off = 0.0, off_dark = 0.0, off_darkest = 0.0;
  for (const double peak : {0.003, 0.01, 0.03, 0.1, 0.3, 0.5, 1.0, 2.0, 4.0, 10.0, 30.0, 100.0}) {
    const double power = peak / box.peak;
    const Scene scene = box_under(static_cast<float>(power));
    const auto indirect = [&](Storage storage) {
      Settings settings = small_settings(box_voxels);
      settings.storage = storage;
      return TryTrace(scene, settings, box_width).mean_indirect();
    };
    const double ratio = indirect(Storage::unorm8) / indirect(Storage::float32), theory = held_by_bytes(box, power);
    failure.table.add({peak, ratio, theory});
    const ChartPoint lost = chart_point(std::log10(peak), std::abs(1.0 - ratio));
    if (peak >= 1.0) brighter.push_back(lost);
    if (peak <= 1.0) darker.insert(darker.begin(), lost);
    if (peak >= 0.3 && peak <= 1.0) below = worst_of({below, lost.y});  // from 77 steps on rounding is small
    double& gap = peak >= 0.3 ? off : peak >= 0.01 ? off_dark : off_darkest;
    gap = worst_of({gap, std::abs(ratio / theory - 1.0)});
  }
  failure.text = fmt::format(
      "The Cornell box under a lamp of growing power, in unorm8 against float32. Bytes hold radiance to 1; beyond, "
      "light is lost, and far below, rounding takes over. Theory is the share of the voxels' own light, by area, that "
      "bytes hold; which voxels a pixel sees, it does not know, nor that filtering rounds again: at peaks of 0.01 to "
      "0.1 the ratio is up to {:.0f} % off theory, and at 0.003, of which voxels hold 1 of 255 steps or none, {:.0f} "
      "%.",
      100.0 * off_dark, 100.0 * off_darkest);
  failure.charts.push_back(
      {"stability_clamping",
       "Light that bytes lose",
       {"peak radiance of the voxels / (W/(sr m^2))", true},
       {"indirect light, unorm8 / float32", false, 0.0},
       {curve(failure.table, "peak", "ratio", "measured"),
        theory_curve(failure.table, "peak", "theory", "theory, the voxels' own light", "measured"),
        Series{"radiance 1", ChartStyle::dashes, {chart_point(1.0, 0.0), chart_point(1.0, 1.2)}}}});
  const double bright = std::pow(10.0, breaks_at(brighter, half_plan_error)),
               dark = std::pow(10.0, breaks_at(darker, half_plan_error));
  failure.charts.back().marks = {{bright, "5 % lost"}, {dark, "rounding: 5 %"}};
  failure.thresholds = {
      {"clamping_below_1", below, "", "most that bytes change the light while the peak is from 0.3 to 1"},
      {"clamping_bright", bright, "W/(sr m^2)", "peak from which 5 % of the light is lost", Worse::smaller},
      {"clamping_dark", dark, "W/(sr m^2)", "peak below which rounding changes the light by 5 %"},
      {"clamping_theory_gap", off, "", "most that the ratio is off theory, from peak 0.3 on, relative"},
      {"clamping_dark_gap", off_dark, "", "the same from peak 0.01 to 0.1"}};
  return failure;
}

namespace {

/// Light of a closed room of radiance 1 and this albedo, after n bounces at the voxels and one at the pixel, over
/// 1 / (1 - albedo), where each brings `gain` times the one before: a geometric series of n + 2 terms.
double gathered_share(double albedo, double gain, int bounces) {
  return (1.0 - albedo) * (1.0 - std::pow(gain, bounces + 2)) / (1.0 - gain);
}

/// Bounces in a closed cube whose voxels reflect `gain` of what arrives, which no scene's material may at 1 and above.
std::string bounced_at(float albedo) {
  const Scene room = furnace(0.5f);
  SurfaceGrid surfaces = voxelize(room, fit_grid(room.bounds(), small_settings(16).grid), {});
  for (glm::vec4& a : surfaces.albedo) a = {glm::vec3(albedo), a.a};
  const std::vector<glm::vec3> direct(surfaces.size(), glm::vec3(1.0f));
  try {
    bounce(surfaces, direct, {}, {}, {}, glm::vec3(0.0f));
  } catch (const Error& error) {
    return std::string("refused: ") + error.what();
  }
  return "rendered";
}

TryTrace bounced_room(const Scene& room, std::optional<int> bounces) {
  Settings settings = small_settings(16);
  settings.bounce.count = bounces;
  return {room, settings, 8};
}

}  // namespace

Failure feedback_gain() {
  Failure failure{
      "Feedback gain of the bounces",
      "A closed cube that glows with 1 and reflects the share r: each bounce adds r times the one before, 1 - r^(n+2) "
      "of 1 / (1 - r) after n of them at the voxels, a last one at the pixel and the light itself; they end when one "
      "more would add less than 1 %. The gain is r. At and above 1 there is no limit to gather; voxels that reflect "
      "1.1 (no material can) are refused.",
      {"stability_gain",
       "Loop gain, and total light over 1 / (1 - r)",
       {{"albedo", ""},
        {"gain", ""},
        {"bounces", ""},
        {"total_ratio", ""},
        {"theory", ""},
        {"theory_gain", ""},
        {"outcome", ""}}}};
  double off = 0.0, above = 0.0, total_off = 0.0, gain_total_off = 0.0;
  std::vector<ChartPoint> totals;
  for (const float albedo : {0.2f, 0.4f, 0.6f, 0.8f, 0.9f, 0.95f}) {
    const TryTrace room = bounced_room(furnace(albedo), std::nullopt);
    if (!room.result) {
      failure.table.add({double(albedo), Cell{}, Cell{}, Cell{}, Cell{}, Cell{}, room.outcome});
      off = above = total_off = gain_total_off = std::nan("");
      continue;
    }
    const ConeTraceResult& result = *room.result;
    const double ratio = room.mean() * (1.0 - double(albedo)),
                 theory = gathered_share(double(albedo), double(albedo), result.bounces),
                 with_gain = gathered_share(double(albedo), result.gain, result.bounces);
    failure.table.add({double(albedo), result.gain, double(result.bounces), ratio, theory, with_gain, room.outcome});
    off = worst_of({off, std::abs(result.gain - double(albedo))});
    above = worst_of({above, result.gain - double(albedo)});
    totals.push_back(chart_point(double(albedo), std::abs(ratio / theory - 1.0)));
    total_off = worst_of({total_off, totals.back().y});
    gain_total_off = worst_of({gain_total_off, std::abs(ratio / with_gain - 1.0)});
  }
  Scene mirror = furnace(0.5f);
  for (Material& m : mirror.materials) m.base_color = glm::vec4(1.0f);
  constexpr int many = 20;  // endless light has no end of its own
  const TryTrace endless = bounced_room(mirror, many);
  const double gain_at_1 = endless.result ? endless.result->gain : std::nan("");
  failure.table.add({1.0, gain_at_1, double(many), Cell{}, Cell{}, Cell{}, endless.outcome});
  const std::string beyond = bounced_at(1.1f);
  failure.table.add({1.1, Cell{}, Cell{}, Cell{}, Cell{}, Cell{}, beyond});

  failure.charts = {
      {"stability_gain",
       "Loop gain of the bounces in a closed room",
       {"albedo", false, 0.0, 1.05},
       {"gain", false, 0.0},
       {curve(failure.table, "albedo", "gain", "measured", ChartStyle::points),
        Series{"theory: the albedo", ChartStyle::dashes, {chart_point(0.0, 0.0), chart_point(1.05, 1.05)}}}},
      {"stability_gain_total",
       "Light after all bounces in a closed room",
       {"albedo", false, 0.0, 1.05},
       {"light x (1 - albedo)"},
       {curve(failure.table, "albedo", "total_ratio", "measured"),
        curve(failure.table, "albedo", "theory", "theory: 1 - r^(n+2)", ChartStyle::dashes),
        theory_curve(failure.table, "albedo", "theory_gain", "theory with the measured gain", "measured")}}};
  failure.charts.back().marks = {{breaks_at(totals, half_plan_error), "off by 5 %"}};
  failure.thresholds = {
      {"gain_error", off, "", "most that the gain is off the albedo, to albedo 0.95"},
      {"gain_excess", worst_of({above, gain_at_1 - 1.0}), "", "most that it is above the albedo, to albedo 1"},
      {"gain_total_error", total_off, "", "most that the light after all bounces is off theory, relative"},
      {"gain_break", breaks_at(totals, half_plan_error), "", "albedo from which that light is off theory by 5 %",
       Worse::smaller},
      {"gain_total_theory_gap", gain_total_off, "", "the same, of theory with the measured gain"},
      {"gain_unrefused", beyond == "rendered" ? 1.0 : 0.0, "rooms", "whose gain is above 1 and that were rendered"}};
  return failure;
}

}  // namespace voxref
