// Figures 4.33 to 4.35: emissive objects in place of lamps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/curves.h"
#include "study/deviation.h"
#include "study/study_scenes.h"
#include "study/thesis_scenes.h"
#include "study/thesis_sections.h"
#include "study/truth.h"

namespace voxref {

namespace {

/// What surfaces reflect: without what emitters show of themselves.
Image reflected(Image image) {
  const auto emission = std::as_const(image).layer("emission");
  const auto all = image.layer("");
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < all[c].size(); ++i) all[c][i] -= emission[c][i];
  return image;
}

/// How far the light of several colours stays apart: the mean over pixels of the largest channel less the smallest,
/// over the mean of the largest. 0: everything is grey.
double colorfulness(const Image& image) {
  const auto planes = image.layer("");
  double apart = 0.0, largest = 0.0;
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const auto [low, high] = std::minmax({planes[0][i], planes[1][i], planes[2][i]});
    apart += double(high) - double(low);
    largest += double(high);
  }
  return apart / largest;
}

}  // namespace

Section thesis_emission(const std::vector<StudyScene>& glowing, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Figures 4.33 to 4.35: emissive objects and no lamp", [&](Section& section) {
    Table table{"thesis_emission",
                "What emissive objects bring to their neighbours, against the path tracer",
                {{"scene", ""},
                 {"voxels", ""},
                 {"mean_ratio", ""},
                 {"rel_error", ""},
                 {"rel_error_stderr", ""},
                 {"colorfulness", ""},
                 {"colorfulness_true", ""}}};
    Chart light{"thesis_emission",
                "Light of emissive objects, against the path tracer",
                {"voxels along the longest side", true},
                {"cone traced / path traced mean", false, 0.0}};
    Chart error{"thesis_emission_error",
                "Error of the light of emissive objects",
                {"voxels along the longest side", true},
                {"rel_error", false, 0.0}};
    std::vector<bool> better;
    for (const StudyScene& scene : glowing) {
      const Caster caster(scene.scene);
      const View view = sized(scene.view, sizes.quality_width / 2);
      PathOptions path;
      path.spp = sizes.spp;
      const Image truth = reflected(trace_paths(scene.scene, caster, view, path, progress).image);
      Series ratios{scene.name, ChartStyle::line_points}, errors = ratios;
      for (const int resolution : sizes.resolutions) {
        progress.check();
        Settings settings;
        settings.grid.resolution = resolution;
        const Image cone = reflected(cone_trace(scene.scene, caster, view, settings, {}, progress).image.image);
        const Deviation d = deviation(measured_cone(cone, false), measured_path(truth, false));
        table.add({scene.name, double(resolution), d.bias + 1.0, d.rel_error(), d.rel_error_stderr(),
                   colorfulness(cone), colorfulness(truth)});
        ratios.points.push_back(chart_point(resolution, d.bias + 1.0));
        errors.points.push_back(chart_point(resolution, d.rel_error(), "", d.rel_error_stderr()));
      }
      better.push_back(errors.points.back().y < errors.points.front().y);
      light.series.push_back(std::move(ratios));
      error.series.push_back(std::move(errors));
    }
    const auto ends = std::minmax_element(sizes.resolutions.begin(), sizes.resolutions.end());
    light.series.push_back(level_line(1.0, *ends.first, *ends.second, "path tracer"));
    section.text =
        "In physical units (radiometric profile), so that the path tracer can judge; without the emitters' own pixels. "
        "The coloured lights' separation is the mean of the largest channel less the smallest over the largest's: what "
        "cones blur and leak into each other's shadows takes it away. Published are pictures.\n\n" +
        finding("More voxels bring the light nearer to the path tracer's", better, "scenes");
    section.tables.push_back(std::move(table));
    section.charts = {std::move(light), std::move(error)};
  });
}

}  // namespace voxref
