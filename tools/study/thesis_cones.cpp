// Tables 4.5 to 4.8: cone tracing by screen size, step and shadows.
#include <fmt/format.h>

#include <algorithm>

#include "study/study_scenes.h"
#include "study/thesis_data.h"
#include "study/thesis_sections.h"

namespace voxref {

namespace {

/// All NaN where nothing was published of a scene.
ThesisCones published_of(const std::string& scene) {
  for (const ThesisCones& row : thesis_cones)
    if (row.scene == scene) return row;
  constexpr double none = misprint;
  return {"", none, none, none, none, none, none, none, none, none, none, none};
}

void add_series(Chart& chart, const Shape& shape, const std::vector<StudyScene>& scenes, const std::string& quantity) {
  for (const StudyScene& scene : scenes)
    for (Series& series : shape_series(shape.table(), scene.name, quantity, scene.name))
      chart.series.push_back(std::move(series));
}

std::string pixels(const StudyScene& scene, int width) {
  const View view = sized(scene.view, width);
  return fmt::format("{}x{}", view.width, view.height);
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
    measure_each(scenes, usual, progress,
                 [&](const StudyScene& scene, const PreparedScene& prepared, const ThesisCones& p) {
                   Settings settings = usual;
                   const LitVoxels lit = prepared.lit(settings);
                   const auto timing = [&](int width) { return prepared.image_timing(settings, lit, width); };
                   shape.add_block(scene.name, "screen size",
                                   {{pixels(scene, sizes.width_720), timing(sizes.width_720), p.at_720},
                                    {pixels(scene, sizes.width_1080), timing(sizes.width_1080), p.at_1080}},
                                   0);
                   std::vector<ShapeLine> lines;
                   for (const auto& [step, published] :
                        {std::pair(0.1f, p.step_0_10), std::pair(0.25f, p.step_0_25), std::pair(0.5f, p.step_0_50),
                         std::pair(1.0f, misprint), std::pair(2.5f, p.step_2_50)}) {
                     settings.render.cone.step = step;
                     lines.push_back({fmt::format("{:g}", step), timing(sizes.width_720), published});
                   }
                   shape.add_block(scene.name, "step", lines, 2);
                 });
    section.text =
        fmt::format(
            "At {} voxels; images {} and {} pixels wide stand for 1280 and 1920: as many times more pixels. Step 1 "
            "is not published.\n\n",
            sizes.base, sizes.width_720, sizes.width_1080) +
        shape.summary();
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
        "One point light, no bounce at the voxels. In place of the published shadow map, which this program has "
        "not, its first line has no shadows at all.\n\n" +
        shape.summary();
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
