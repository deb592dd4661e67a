// The thesis's tables of times with this program's numbers beside them. Published: milliseconds of a GPU of 2015, so
// each is set over the row of 256 voxels (or the step of 0.5) of its own scene, and so is ours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/study_scenes.h"
#include "study/thesis_bench.h"
#include "study/thesis_data.h"
#include "study/thesis_scenes.h"

namespace voxref {

namespace {

const ThesisStages* published_stages(const std::string& scene, int voxels) {
  const auto found = std::find_if(thesis_stages.begin(), thesis_stages.end(),
                                  [&](const ThesisStages& row) { return row.scene == scene && row.voxels == voxels; });
  return found == thesis_stages.end() ? nullptr : &*found;
}

const ThesisCones& published_cones_of(const std::string& scene) {
  return *std::find_if(thesis_cones.begin(), thesis_cones.end(),
                       [&](const ThesisCones& row) { return row.scene == scene; });
}

/// Tables 4.3 and 4.4.
Section stage_times(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Tables 4.3 and 4.4: stages by scene and resolution", [&](Section& section) {
    Table table{
        "thesis_stages",
        "Seconds of each stage, and beside them the published milliseconds; ours has the second mipmap in bounce",
        {{"scene", ""},
         {"voxels", ""},
         {"static", "s"},
         {"dynamic", "s"},
         {"shade", "s"},
         {"mipmap", "s"},
         {"bounce", "s"},
         {"cones", "s"},
         {"static_published", "ms"},
         {"dynamic_published", "ms"},
         {"shade_published", "ms"},
         {"mipmap_published", "ms"},
         {"bounce_published", "ms"},
         {"cones_published", "ms"}},
        {}};
    Chart chart{"thesis_bounce",
                "Bounce and its mipmap by resolution",
                {"voxels along the longest side", true, {}, {}, {}},
                {fmt::format("time / that at {} voxels", sizes.base), true, {}, {}, {}},
                {}};
    for (const StudyScene& scene : scenes) {
      Series ours{scene.name, ChartStyle::line_points, {}},
          published{scene.name + ", published", ChartStyle::dashes, {}};
      for (const int resolution : sizes.resolutions) {
        progress.check();
        const Settings settings = thesis_settings(resolution);
        const PreparedScene prepared(scene, settings, progress);
        const LitVoxels lit = prepared.lit(settings);
        const double image = prepared.image_seconds(settings, lit, sizes.width_720);
        const StageSeconds& s = lit.seconds;
        const ThesisStages* p = published_stages(scene.name, resolution);
        const auto cell = [&](double ThesisStages::*member) { return p ? Cell(p->*member) : Cell(); };
        table.add({scene.name, double(resolution), prepared.fixed, prepared.dynamic, s.shade, s.mipmap, s.bounce, image,
                   cell(&ThesisStages::fixed), cell(&ThesisStages::dynamic), cell(&ThesisStages::shade),
                   cell(&ThesisStages::mipmap), p ? Cell(p->bounce + p->bounce_mipmap) : Cell(),
                   cell(&ThesisStages::cones)});
        ours.points.push_back({double(resolution), s.bounce, 0.0, "", 0.0});
        if (p) published.points.push_back({double(resolution), p->bounce + p->bounce_mipmap, 0.0, "", 0.0});
      }
      for (Series* series : {&ours, &published}) {
        const auto base = std::find_if(series->points.begin(), series->points.end(),
                                       [&](const ChartPoint& point) { return point.x == double(sizes.base); });
        if (base == series->points.end()) continue;
        const double unit = base->y;
        for (ChartPoint& point : series->points) point.y /= unit;
        chart.series.push_back(std::move(*series));
      }
    }
    section.text =
        "Cone tracing in the published rules. The published volumes are dense: their mipmaps take 8 times as long from "
        "256 to "
        "512 voxels, as the volume grows. Ours are sparse and hold surfaces alone, which grow 4 times per doubling. "
        "The GPU "
        "voxelizes dynamic objects slower at 64 voxels than at 256, where fewer fragments contend for a voxel; nothing "
        "contends here.";
    section.tables.push_back(std::move(table));
    section.charts.push_back(std::move(chart));
  });
}

/// Tables 4.5 to 4.8.
Section cone_times(const std::vector<StudyScene>& scenes, const std::vector<StudyScene>& lamps,
                   const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Tables 4.5 to 4.8: cone tracing by screen size, step and shadows", [&](Section& section) {
    Table table{"thesis_cones",
                "Times over those of the first line of each block, per scene, ours and published",
                {{"scene", ""}, {"block", ""}, {"line", ""}, {"time", "s"}, {"ratio", ""}, {"ratio_published", ""}},
                {}};
    Chart chart{"thesis_step",
                "Cone tracing by step",
                {"step / cone diameters", true, {}, {}, {}},
                {"time / that at step 0.5", true, {}, {}, {}},
                {}};
    for (size_t i = 0; i < scenes.size(); ++i) {
      progress.check();
      const ThesisCones& p = published_cones_of(scenes[i].name);
      const auto add = [&](const char* block, const std::string& line, double time, double base, double ratio) {
        table.add({scenes[i].name, block, line, time, time / base, ratio});
      };
      Settings settings = thesis_settings(sizes.base);
      const PreparedScene prepared(scenes[i], settings, progress);
      const LitVoxels lit = prepared.lit(settings);
      const double usual = prepared.image_seconds(settings, lit, sizes.width_720);
      add("size", "1280x720", usual, usual, 1.0);
      add("size", "1920x1080", prepared.image_seconds(settings, lit, sizes.width_1080), usual, p.at_1080 / p.at_720);
      Series ours{scenes[i].name, ChartStyle::line_points, {}},
          published{scenes[i].name + ", published", ChartStyle::dashes, {}};
      struct Step {
        float step;
        double published;
      };
      for (const Step& s :
           {Step{0.1f, p.step_10}, Step{0.25f, p.step_25}, Step{0.5f, p.step_50}, Step{2.5f, p.step_250}}) {
        settings.render.cone.step = s.step;
        const double time = prepared.image_seconds(settings, lit, sizes.width_720);
        add("step", fmt::format("{:g}", s.step), time, usual, s.published / p.step_50);
        ours.points.push_back({double(s.step), time / usual, 0.0, "", 0.0});
        published.points.push_back({double(s.step), s.published / p.step_50, 0.0, "", 0.0});
      }
      chart.series.push_back(std::move(ours));
      chart.series.push_back(std::move(published));

      Settings shadows = thesis_settings(sizes.base);
      shadows.bounce.count = 0;
      const PreparedScene lamp(lamps[i], shadows, progress);
      const LitVoxels open = lamp.lit(shadows);
      const double plain = lamp.image_seconds(shadows, open, sizes.width_720);
      shadows.shade.shadow = VoxelShadow::volume;
      shadows.render.pixel.shadow = PixelShadow::visibility;
      const LitVoxels shaded = lamp.lit(shadows);
      add("shading", "no shadows", open.seconds.shade, open.seconds.shade, 1.0);
      add("shading", "through the volume", shaded.seconds.shade, open.seconds.shade, p.shade_shadows / p.shade);
      add("shadows", "none", plain, plain, 1.0);
      add("shadows", "visibility volume", lamp.image_seconds(shadows, shaded, sizes.width_720), plain,
          p.visibility_volume / p.cones);
      shadows.render.pixel.shadow = PixelShadow::cone;
      add("shadows", "cones", lamp.image_seconds(shadows, shaded, sizes.width_720), plain, p.shadow_cones / p.cones);
    }
    section.text = fmt::format(
        "At {} voxels and images {} and {} pixels wide in place of 1280 and 1920. The published 'none' has a shadow "
        "map, "
        "which this program has not: its visibility volume is cheaper than that there and dearer than nothing here.",
        sizes.base, sizes.width_720, sizes.width_1080);
    section.tables.push_back(std::move(table));
    section.charts.push_back(std::move(chart));
  });
}

/// Figure 4.11.
Section apertures(const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Figure 4.11: apertures of specular and shadow cones", [&](Section& section) {
    Table table{"thesis_apertures",
                "Seconds of an image by the half-angle of its cones",
                {{"half_angle", "degrees"}, {"specular", "s"}, {"shadow", "s"}},
                {}};
    const StudyScene box = cornell_point_scene();
    Settings shadows = thesis_settings(sizes.base);
    shadows.render.pixel.shadow = PixelShadow::cone;
    const PreparedScene lamp(box, shadows, progress);
    const LitVoxels lit = lamp.lit(shadows);
    for (const float degrees : {1.0f, 5.0f, 20.0f, 45.0f}) {
      progress.check();
      const StudyScene ball = specular_ball(degrees);
      const Settings settings = thesis_settings(sizes.base);
      const PreparedScene prepared(ball, settings, progress);
      const double specular = prepared.image_seconds(settings, prepared.lit(settings), sizes.width_720);
      shadows.render.pixel.shadow_cone_aperture = std::tan(degrees * 0.0174532925f);
      table.add({double(degrees), specular, lamp.image_seconds(shadows, lit, sizes.width_720)});
    }
    section.text = "The published finding: a wider cone is faster, since its steps are longer.";
    Chart chart{"thesis_apertures",
                "Time of an image by the aperture of its specular and shadow cones",
                {"half-angle / degrees", true, {}, {}, {}},
                {"time / s", false, 0.0, {}, {}},
                {{"specular", ChartStyle::line_points, {}}, {"shadow", ChartStyle::line_points, {}}}};
    for (size_t i = 0; i < table.rows.size(); ++i)
      for (size_t k = 0; k < 2; ++k)
        chart.series[k].points.push_back(
            {table.number(i, "half_angle"), table.number(i, k == 0 ? "specular" : "shadow"), 0.0, "", 0.0});
    section.tables.push_back(std::move(table));
    section.charts.push_back(std::move(chart));
  });
}

}  // namespace

StudyResult run_thesis(const StudyRequest& request) {
  const ThesisSizes sizes = request.quick ? ThesisSizes{{32, 64, 128}, 64, 160, 240, 160, 128}
                                          : ThesisSizes{{64, 128, 256, 512}, 256, 640, 960, 480, 512};
  StudyResult result{"thesis", "the thesis's tables, measured again", {}, {}};
  std::vector<StudyScene> scenes = thesis_scenes(request, ThesisLight::sun, result.skipped),
                          lamps = thesis_scenes(request, ThesisLight::point, result.skipped);
  if (request.quick && scenes.size() > 1) {  // the others take minutes each to voxelize
    scenes.resize(1);
    lamps.resize(1);
    result.skipped.emplace_back("sibenik, conference and sponza: --quick");
  }
  result.sections.push_back(stage_times(scenes, sizes, request.progress));
  result.sections.push_back(cone_times(scenes, lamps, sizes, request.progress));
  result.sections.push_back(apertures(sizes, request.progress));
  std::vector<StudyScene> pictures = lamps;
  pictures.push_back(light_box_scene());
  pictures.push_back(plane_test_scene());
  result.sections.push_back(thesis_quality(pictures, sizes, request.progress));
  result.sections.push_back(thesis_emission(sizes, request.progress));
  result.sections.push_back(thesis_memory_use(pictures, sizes, request.progress));
  return result;
}

}  // namespace voxref
