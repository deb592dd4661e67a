// The thesis's pictures as numbers, and its table of memory.
#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>

#include "compare/flip.h"
#include "reference/path.h"
#include "study/deviation.h"
#include "study/study_scenes.h"
#include "study/thesis_bench.h"
#include "study/thesis_data.h"
#include "study/thesis_scenes.h"

namespace voxref {

namespace {

/// As the thesis shows its pictures: x / (1 + x).
std::vector<glm::vec3> picture(const Image& image) {
  const auto planes = image.layer("");
  std::vector<glm::vec3> pixels(image.pixel_count());
  for (size_t i = 0; i < pixels.size(); ++i) {
    const glm::vec3 x = glm::max(glm::vec3(planes[0][i], planes[1][i], planes[2][i]), 0.0f);
    pixels[i] = x / (1.0f + x);
  }
  return pixels;
}

/// Mean difference that is seen between two pictures, in [0,1].
double perceived(const Image& base, const Image& other) {
  const std::vector<float> map = flip_map(base.width(), base.height(), picture(base), picture(other));
  double sum = 0.0;
  for (const float value : map) sum += double(value);
  return sum / double(map.size());
}

}  // namespace

/// Figures 4.12 to 4.30.
Section thesis_quality(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Figures 4.12 to 4.30: perceived difference from the base picture", [&](Section& section) {
    Table table{"thesis_quality",
                fmt::format("Mean FLIP against {} voxels, step 0.5, no bounce at the voxels", sizes.quality_base),
                {{"scene", ""}, {"change", ""}, {"flip", ""}},
                {}};
    Chart chart{"thesis_quality",
                "Perceived difference from the base picture",
                {"", false, {}, {}, {}},
                {"mean FLIP", false, 0.0, {}, {}},
                {}};
    for (const StudyScene& scene : scenes) {
      Series series{scene.name, ChartStyle::points, {}};
      Settings base = thesis_settings(sizes.quality_base);
      base.bounce.count = 0;
      const PreparedScene prepared(scene, base, progress);
      const LitVoxels lit = prepared.lit(base);
      const Image picture_base = prepared.image(base, lit, sizes.quality_width);
      const auto add = [&](const std::string& change, const Image& image) {
        const double flip = perceived(picture_base, image);
        table.add({scene.name, change, flip});
        if (std::find(chart.x.categories.begin(), chart.x.categories.end(), change) == chart.x.categories.end())
          chart.x.categories.push_back(change);
        series.points.push_back({double(series.points.size()), flip, 0.0, "", 0.0});
      };
      Settings bounced = base;
      bounced.bounce.count = 1;
      add("bounce", prepared.image(bounced, prepared.lit(bounced), sizes.quality_width));
      for (const int divisor : {2, 4, 8}) {
        Settings coarse = base;
        coarse.grid.resolution = sizes.quality_base / divisor;
        const PreparedScene smaller(scene, coarse, progress);
        add(fmt::format("{} voxels", coarse.grid.resolution),
            smaller.image(coarse, smaller.lit(coarse), sizes.quality_width));
      }
      for (const float step : {0.1f, 1.0f, 2.5f}) {
        progress.check();
        Settings stepped = base;
        stepped.render.cone.step = step;
        const Image image = prepared.image(stepped, lit, sizes.quality_width);
        add(fmt::format("step {:g}", step), image);
      }
      chart.series.push_back(std::move(series));
    }
    section.text =
        "The thesis measures with Yee's metric of 2001 and shows pictures; here it is FLIP (Andersson et al. 2020), of "
        "pictures mapped by x / (1 + x). Its findings: the difference grows as the resolution falls, and steps above 1 "
        "skip "
        "voxels.";
    section.tables.push_back(std::move(table));
    section.charts.push_back(std::move(chart));
  });
}

/// Figure 4.33, in physical units so that the path tracer can judge.
Section thesis_emission(const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Figure 4.33: a glowing teapot and no lamp", [&](Section& section) {
    Table table{"thesis_emission",
                "What a glowing teapot brings to its neighbours, against the path tracer",
                {{"voxels", ""}, {"mean_ratio", ""}, {"rel_error", ""}, {"rel_error_stderr", ""}},
                {}};
    const StudyScene scene = glowing_teapot();
    const Caster caster(scene.scene);
    const View view = sized(scene.view, sizes.quality_width / 2);
    PathOptions path;
    path.spp = 128;
    const Measured truth = measured_path(path_trace(scene.scene, caster, view, path, progress).image, false);
    for (const int resolution : sizes.resolutions) {
      Settings settings;
      settings.grid.resolution = resolution;
      const Image cone = cone_trace(scene.scene, caster, view, settings, {}, progress).image.image;
      const Deviation d = deviation(measured_cone(cone, false), truth);
      table.add({double(resolution), d.bias + 1.0, d.rel_error, d.rel_error_error});
    }
    section.text = "Emission is gathered like any other light of the voxels (radiometric profile).";
    section.tables.push_back(std::move(table));
  });
}

/// Table 4.9, from the volumes of `scenes` at all resolutions.
Section thesis_memory_use(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Table 4.9: memory", [&](Section& section) {
    Table table{"thesis_memory",
                "Megabytes of all volumes: ours are sparse, the published ones dense",
                {{"scene", ""}, {"voxels", ""}, {"memory", "MB"}, {"memory_published", "MB"}},
                {}};
    Chart chart{"thesis_memory",
                "Memory of the volumes",
                {"voxels along the longest side", true, {}, {}, {}},
                {"memory / MB", true, {}, {}, {}},
                {}};
    for (const StudyScene& scene : scenes) {
      Series series{scene.name, ChartStyle::line_points, {}};
      for (const int resolution : sizes.resolutions) {
        Settings settings = thesis_settings(resolution);
        settings.bounce.count = 0;
        const PreparedScene prepared(scene, settings, progress);
        const double megabytes = 1e-6 * double(prepared.lit(settings).bytes.at("total"));
        const auto p = std::find_if(thesis_memory.begin(), thesis_memory.end(),
                                    [&](const ThesisMemory& row) { return row.voxels == resolution; });
        table.add({scene.name, double(resolution), megabytes, p == thesis_memory.end() ? Cell() : Cell(p->megabytes)});
        series.points.push_back({double(resolution), megabytes, 0.0, "", 0.0});
      }
      chart.series.push_back(std::move(series));
    }
    Series published{"published, any scene", ChartStyle::dashes, {}};
    for (const ThesisMemory& row : thesis_memory)
      if (row.voxels <= sizes.resolutions.back())
        published.points.push_back({double(row.voxels), row.megabytes, 0.0, "", 0.0});
    chart.series.push_back(std::move(published));
    section.tables.push_back(std::move(table));
    section.charts.push_back(std::move(chart));
  });
}

}  // namespace voxref
