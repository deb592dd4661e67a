// Figures 4.33 to 4.35: emissive objects in place of lamps.
#include <fmt/format.h>

#include <algorithm>
#include <array>

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

/// Rows and series of one kind: what changes along a chart's axis.
struct EmissionCurves {
  Table table;
  Chart light, error;

  EmissionCurves(const std::string& name, const std::string& caption, const std::string& variable, const Axis& axis,
                 const std::string& title)
      : table{name,
              caption,
              {{"scene", ""},
               {variable, ""},
               {"mean_ratio", ""},
               {"rel_error", ""},
               {"rel_error_stderr", ""},
               {"colorfulness", ""},
               {"colorfulness_true", ""}}},
        light{name, title, axis, {"cone traced / path traced mean", false, 0.0}},
        error{name + "_error", title + ": error", axis, {"RMS error / path traced mean", false, 0.0}} {}

  void begin(const std::string& scene) {
    for (Chart* chart : {&light, &error}) chart->series.push_back({scene, ChartStyle::line_points});
  }
  void add(double x, const Image& cone, const Image& truth) {
    const Deviation d = deviation(measured_cone(cone, false), measured_path(truth, false));
    table.add({light.series.back().title, x, d.bias + 1.0, d.rel_error(), d.rel_error_stderr(), colorfulness(cone),
               colorfulness(truth)});
    light.series.back().points.push_back(chart_point(x, d.bias + 1.0));
    error.series.back().points.push_back(chart_point(x, d.rel_error(), "", d.rel_error_stderr()));
  }
  void end(double first, double last) { light.series.push_back(level_line(1.0, first, last, "path tracer")); }
};

/// Whether each value of the last scene is below the one before by more than both standard errors.
void add_falls(const Series& errors, std::vector<bool>& falls) {
  for (size_t i = 1; i < errors.points.size(); ++i) {
    const ChartPoint &before = errors.points[i - 1], &now = errors.points[i];
    falls.push_back(now.y + now.error < before.y - before.error);
  }
}

/// "1.5 to 2.1" of a column in the rows where another holds a number.
std::string range(const Table& table, const std::string& column, const std::string& where, double number) {
  std::vector<double> values;
  for (size_t i = 0; i < table.rows.size(); ++i)
    if (table.number(i, where) == number) values.push_back(table.number(i, column));
  const Spread all = spread(std::move(values));
  return fmt::format("{:.2f} to {:.2f}", all.least, all.greatest);
}

/// Of the scenes that have colours at all, by the number of cones.
std::vector<bool> too_apart(const Table& table, double cones) {
  std::vector<bool> apart;
  for (size_t i = 0; i < table.rows.size(); ++i)
    if (table.number(i, "cones") == cones && table.number(i, "colorfulness_true") > 0.0)
      apart.push_back(table.number(i, "colorfulness") > table.number(i, "colorfulness_true"));
  return apart;
}

constexpr std::array cone_counts = {6, 32, 128};

/// Both kinds, and whether the error falls from step to step.
struct EmissionMeasures {
  EmissionCurves by_voxels, by_cones;
  std::vector<bool> finer, more_cones;

  explicit EmissionMeasures(const ThesisSizes& sizes)
      : by_voxels("thesis_emission", "What emissive objects bring to their neighbours, against the path tracer",
                  "voxels", {"voxels along the longest side", true}, "Light of emissive objects by resolution"),
        by_cones("thesis_emission_cones",
                 fmt::format("The same at {} voxels by the number of cones, in a picture half as wide", sizes.base),
                 "cones", {"cones at a pixel", true}, "Light of emissive objects by the number of cones") {}
};

/// @param warnings of truths that lack paths
void add_scene(EmissionMeasures& measures, const StudyScene& scene, const ThesisSizes& sizes, const Progress& progress,
               std::vector<std::string>& warnings) {
  const Caster caster(scene.scene);
  const View view = sized(scene.view, sizes.quality_width / 2), small = sized(scene.view, sizes.quality_width / 4);
  PathOptions path;
  path.spp = sizes.spp;
  const auto traced = [&](const View& seen) {
    PathResult paths = trace_paths(scene.scene, caster, seen, path, progress);
    if (const std::string missing = missing_paths(paths.nonfinite, paths.first_nonfinite); !missing.empty())
      warnings.push_back(fmt::format("{}, {} pixels wide: {}", scene.name, seen.width, missing));
    return reflected(std::move(paths.image));
  };
  const Image truth = traced(view), small_truth = traced(small);
  measures.by_voxels.begin(scene.name);
  measures.by_cones.begin(scene.name);
  for (const int resolution : sizes.resolutions) {
    progress.check();
    Settings settings;
    settings.grid.resolution = resolution;
    const PreparedScene prepared(scene, settings, progress);
    const LitVoxels lit = prepared.lit(settings);
    measures.by_voxels.add(resolution, reflected(prepared.image(settings, lit, view.width)), truth);
    if (resolution != sizes.base) continue;
    for (const int cones : cone_counts) {
      settings.render.cone.diffuse = cones;
      measures.by_cones.add(cones, reflected(prepared.image(settings, lit, small.width)), small_truth);
    }
  }
  add_falls(measures.by_voxels.error.series.back(), measures.finer);
  add_falls(measures.by_cones.error.series.back(), measures.more_cones);
}

std::string emission_text(const EmissionMeasures& measures, const ThesisSizes& sizes) {
  const double finest = sizes.resolutions.back(), many = cone_counts.back();
  const Table &by_voxels = measures.by_voxels.table, &by_cones = measures.by_cones.table;
  const auto apart = [&](double cones) {
    return finding("Colours are further apart than in truth", too_apart(by_cones, cones), "coloured scenes");
  };
  return fmt::format(
      "In physical units (radiometric profile), so that the path tracer can judge; without the emitters' own pixels. "
      "Published are pictures.\n\nAt {:g} voxels the light is {} times the true one, and the error's RMS {} of its "
      "mean. {} Part of it is that six cones are wide: at {} voxels they bring {} times the true light, {:g} cones "
      "{}. {} What is left is not taken apart: texels of such cones are wide still, and emitters are larger by about "
      "3/2 voxels even to the narrowest (study stability, growth of emitters).\n\nThe coloured lights' separation is "
      "the mean of the largest channel less the smallest over the largest's. Six cones: {} {:g} cones: {}",
      finest, range(by_voxels, "mean_ratio", "voxels", finest), range(by_voxels, "rel_error", "voxels", finest),
      finding("More voxels bring it nearer, by more than both standard errors", measures.finer, "steps in voxels"),
      sizes.base, range(by_cones, "mean_ratio", "cones", cone_counts.front()), many,
      range(by_cones, "mean_ratio", "cones", many),
      finding("More cones lower the error, by more than both standard errors", measures.more_cones, "steps in cones"),
      apart(cone_counts.front()), many, apart(many));
}

}  // namespace

Section thesis_emission(const std::vector<StudyScene>& glowing, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Figures 4.33 to 4.35: emissive objects and no lamp", [&](Section& section) {
    EmissionMeasures measures(sizes);
    for (const StudyScene& scene : glowing) add_scene(measures, scene, sizes, progress, section.warnings);
    measures.by_voxels.end(sizes.resolutions.front(), sizes.resolutions.back());
    measures.by_cones.end(cone_counts.front(), cone_counts.back());
    section.text = emission_text(measures, sizes);
    section.tables = {std::move(measures.by_voxels.table), std::move(measures.by_cones.table)};
    section.charts = {std::move(measures.by_voxels.light), std::move(measures.by_voxels.error),
                      std::move(measures.by_cones.light), std::move(measures.by_cones.error)};
  });
}

}  // namespace voxref
