// Tables 4.5 to 4.8: cone tracing by screen size, step and shadows.
#include <fmt/format.h>

#include <cmath>

#include "study/study_scenes.h"
#include "study/thesis_data.h"
#include "study/thesis_sections.h"

namespace voxref {

namespace {

/// All NaN where nothing was published of a scene.
ThesisCones published_of(const std::string& scene) {
  for (const ThesisCones& row : thesis_cones)
    if (row.scene == scene) return row;
  constexpr double none = not_published;
  return {"", none, none, none, none, none, none, none, none, none, none, none};
}

void add_series(Chart& chart, const Shape& shape, const std::vector<StudyScene>& scenes, const std::string& quantity) {
  for (const StudyScene& scene : scenes)
    for (Series& series : shape_series(shape.table(), scene.name, quantity, scene.name))
      chart.series.push_back(std::move(series));
}

/// Share of the time at step 0.5 that no step changes, where time is a + b / step, from that at steps 0.1 and 0.5.
double fixed_share(double at_0_10, double at_0_50) {
  const double b = (at_0_10 - at_0_50) / (1.0 / 0.1 - 1.0 / 0.5);
  return 1.0 - b / 0.5 / at_0_50;
}

/// "20 to 30 %" in rising order, or "20 %" of one.
std::string percent_range(const std::vector<double>& shares) {
  const Spread all = spread(shares);
  if (shares.size() == 1) return fmt::format("{:.0f} %", 100.0 * all.median);
  return fmt::format("{:.0f} to {:.0f} %", 100.0 * all.least, 100.0 * all.greatest);
}

/// What does not depend on the step, as shares of the time at 0.5 of the published scenes.
struct FixedShares {
  std::vector<double> ours, published, without_samples;

  /// @param steps lines of 0.1, 0.25 and 0.5, then others
  void add(const std::vector<ShapeLine>& steps, const Timing& none) {
    if (std::isnan(steps[2].published)) return;
    const double usual = steps[2].ours.spread.median;
    ours.push_back(fixed_share(steps[0].ours.spread.median, usual));
    published.push_back(fixed_share(steps[0].published, steps[2].published));
    without_samples.push_back(none.spread.median / usual);
  }
  std::string sentence() const {
    if (ours.empty()) return "";
    return fmt::format(
        "\n\nAs a + b / step has it, {} of the time at step 0.5 do not depend on the step here, {} there. Where cones "
        "take no sample at all, {} are left; what makes the rest is not known.",
        percent_range(ours), percent_range(published), percent_range(without_samples));
  }
};

std::vector<ShapeReason> step_reasons() {
  const std::string why = "more of the time does not depend on the step, see below";
  ShapeReason shorter{"step", false, {}, why}, longer{"step", true, {}, why};
  for (const ThesisCones& row : thesis_cones) {
    for (const char* step : {"0.1", "0.25"}) shorter.rows.push_back(fmt::format("{} {}", row.scene, step));
    longer.rows.push_back(fmt::format("{} 2.5", row.scene));
  }
  return {shorter, longer};
}

std::vector<ShapeReason> shadow_reasons() {
  ShapeReason map{
      "cone tracing", true, {}, "the published first line pays for a shadow map, which is here none at all"};
  for (const ThesisCones& row : thesis_cones) map.rows.push_back(fmt::format("{} visibility volume", row.scene));
  const ShapeReason same{"cone tracing",
                         true,
                         {"conference shadow cones"},
                         "the publication prints there what it prints for its visibility volume, perhaps by mistake"};
  return {map, same};
}

/// Calls `measure` with each scene, voxelized with these settings, and with what was published of it.
template <class Measure>
void measure_each(const std::vector<StudyScene>& scenes, const Settings& settings, const Progress& progress,
                  const Measure& measure) {
  for (const StudyScene& scene : scenes) {
    progress.check();
    measure(scene, PreparedScene(scene, settings, progress), published_of(scene.name));
  }
}

}  // namespace

Section thesis_cone_times(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Tables 4.5 and 4.6: cone tracing by screen size and by step", [&](Section& section) {
    Shape shape("thesis_cones", fmt::format("Cone tracing at {} voxels, over the usual size and step", sizes.base), "s",
                "ms");
    const Settings usual = thesis_settings(sizes.base);
    FixedShares fixed;
    measure_each(
        scenes, usual, progress, [&](const StudyScene& scene, const PreparedScene& prepared, const ThesisCones& p) {
          Settings settings = usual;
          const LitVoxels lit = prepared.lit(settings);
          const auto timing = [&](int width) { return prepared.image_timing(settings, lit, width); };
          shape.add_block(
              scene.name, "screen size",
              {{"1280x720", timing(sizes.width_720), p.at_720}, {"1920x1080", timing(sizes.width_1080), p.at_1080}}, 0);
          std::vector<ShapeLine> lines;
          for (const auto& [step, published] :
               {std::pair(0.1f, p.step_0_10), std::pair(0.25f, p.step_0_25), std::pair(0.5f, p.step_0_50),
                std::pair(1.0f, not_published), std::pair(2.5f, p.step_2_50)}) {
            settings.render.cone.step = step;
            lines.push_back({fmt::format("{:g}", step), timing(sizes.width_720), published});
          }
          shape.add_block(scene.name, "step", lines, 2);
          settings.render.cone.step = 0.5f;
          settings.render.cone.max_distance = 0.0f;
          const Timing none = timing(sizes.width_720);
          shape.add_block(scene.name, "samples",
                          {{"step 0.5", lines[2].ours, not_published}, {"none", none, not_published}}, 0);
          fixed.add(lines, none);
        });
    section.text =
        fmt::format(
            "At {} voxels; as many pixels as {}x{} and {}x{} have stand for the published screens. Step 1 is not "
            "published.\n\n",
            sizes.base, sizes.width_720, sizes.width_720 * 9 / 16, sizes.width_1080, sizes.width_1080 * 9 / 16) +
        shape.summary(sizes.base == ThesisSizes::published_base ? step_reasons() : std::vector<ShapeReason>()) +
        fixed.sentence();
    section.tables.push_back(shape.table());
    Chart steps{
        "thesis_step", "Cone tracing by step", {"step / cone diameters", true}, {"time / that at step 0.5", true}};
    add_series(steps, shape, scenes, "step");
    section.charts.push_back(std::move(steps));
  });
}

Section thesis_shadow_times(const std::vector<StudyScene>& lamps, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Tables 4.7 and 4.8: shadows at voxels and pixels", [&](Section& section) {
    Shape shape("thesis_shadows", fmt::format("Times at {} voxels, over those without traced shadows", sizes.base), "s",
                "ms");
    const Settings usual = thesis_shadow_settings(sizes.base);
    measure_each(
        lamps, usual, progress, [&](const StudyScene& scene, const PreparedScene& prepared, const ThesisCones& p) {
          Settings settings = usual;
          const Timing open = prepared.shading_timing(settings);
          const Timing none = prepared.image_timing(settings, prepared.lit(settings), sizes.width_720);
          settings.shade.shadow = VoxelShadow::volume;
          const Timing through = prepared.shading_timing(settings);
          settings.render.pixel.shadow = PixelShadow::visibility;
          const LitVoxels lit = prepared.lit(settings);
          const Timing visibility = prepared.image_timing(settings, lit, sizes.width_720);
          settings.render.pixel.shadow = PixelShadow::cone;
          const Timing cones = prepared.image_timing(settings, lit, sizes.width_720);
          shape.add_block(scene.name, "voxel shading",
                          {{"no shadows", open, p.shade}, {"through the volume", through, p.shade_shadows}}, 0);
          shape.add_block(scene.name, "cone tracing",
                          {{"shadow map", none, p.cones},
                           {"visibility volume", visibility, p.visibility_volume},
                           {"shadow cones", cones, p.shadow_cones}},
                          0);
        });
    section.text =
        "One point light, no bounce at the voxels. In place of the published shadow map, which this program has not, "
        "its first line has no shadows at all.\n\n" +
        shape.summary(shadow_reasons());
    section.tables.push_back(shape.table());
    Chart chart{"thesis_shadows",
                "Shadows at pixels",
                {"", false, {}, {}, {"shadow map / none", "visibility volume", "shadow cones"}},
                {"time / that of the first", false, 0.0}};
    add_series(chart, shape, lamps, "cone tracing");
    section.charts.push_back(std::move(chart));
  });
}

}  // namespace voxref
