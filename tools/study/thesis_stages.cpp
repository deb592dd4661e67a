// Tables 4.3 and 4.4: what each stage takes, by scene and by resolution.
#include <fmt/format.h>

#include <algorithm>

#include "study/curves.h"
#include "study/thesis_data.h"
#include "study/thesis_sections.h"

namespace voxref {

namespace {

struct StageColumn {
  const char* name;
  Timing StageTimings::*ours;
  double ThesisStages::*published;
};
constexpr std::array stage_columns = {
    StageColumn{"static voxelization", &StageTimings::fixed, &ThesisStages::fixed},
    StageColumn{"clear dynamic", &StageTimings::clear, &ThesisStages::clear},
    StageColumn{"dynamic voxelization", &StageTimings::dynamic, &ThesisStages::dynamic},
    StageColumn{"shading", &StageTimings::shade, &ThesisStages::shade},
    StageColumn{"mipmap", &StageTimings::mipmap, &ThesisStages::mipmap},
    StageColumn{"bounce", &StageTimings::bounce, &ThesisStages::bounce},
    StageColumn{"second mipmap", &StageTimings::bounce_mipmap, &ThesisStages::bounce_mipmap},
    StageColumn{"cone tracing", &StageTimings::cones, &ThesisStages::cones},
    StageColumn{"dynamic total", &StageTimings::total, &ThesisStages::total},
};

/// NaN where nothing was published.
double published(const std::string& scene, int voxels, double ThesisStages::*column) {
  for (const ThesisStages& row : thesis_stages)
    if (row.scene == scene && row.voxels == voxels) return row.*column;
  return misprint;
}

/// A scene's stages at the resolutions, in their order.
struct Measured {
  std::string scene;
  std::vector<StageTimings> by_resolution;
};

ShapeLine line_of(const std::string& name, const StageColumn& column, const Measured& scene, size_t resolution,
                  int voxels) {
  return {name, scene.by_resolution[resolution].*column.ours, published(scene.scene, voxels, column.published)};
}

size_t index_of(const std::vector<int>& resolutions, int voxels) {
  return static_cast<size_t>(std::find(resolutions.begin(), resolutions.end(), voxels) - resolutions.begin());
}

Shape by_scene(const std::vector<Measured>& measured, const ThesisSizes& sizes) {
  Shape shape("thesis_stages_by_scene",
              fmt::format("Stages at {} voxels over those of the first scene, and a scene's over its dynamic total",
                          sizes.base),
              "s", "ms");
  const size_t base = index_of(sizes.resolutions, sizes.base);
  for (const StageColumn& column : stage_columns) {
    std::vector<ShapeLine> lines;
    for (const Measured& scene : measured) lines.push_back(line_of(scene.scene, column, scene, base, sizes.base));
    shape.add_block("all", column.name, lines, 0);
  }
  for (const Measured& scene : measured) {
    std::vector<ShapeLine> lines;
    for (size_t i = 1; i < stage_columns.size(); ++i)  // all but the static voxels, which are made once
      lines.push_back(line_of(stage_columns[i].name, stage_columns[i], scene, base, sizes.base));
    shape.add_block(scene.scene, "share of the dynamic total", lines, lines.size() - 1);
  }
  return shape;
}

Shape by_resolution(const std::vector<Measured>& measured, const ThesisSizes& sizes) {
  Shape shape("thesis_stages", fmt::format("Stages over those at {} voxels of the same scene", sizes.base), "s", "ms");
  for (const Measured& scene : measured)
    for (const StageColumn& column : stage_columns) {
      std::vector<ShapeLine> lines;
      for (size_t i = 0; i < sizes.resolutions.size(); ++i)
        lines.push_back(line_of(std::to_string(sizes.resolutions[i]), column, scene, i, sizes.resolutions[i]));
      shape.add_block(scene.scene, column.name, lines, index_of(sizes.resolutions, sizes.base));
    }
  return shape;
}

const char* const sparse =
    "the published volumes are dense, and every voxel is visited; here those that surfaces occupy";
const char* const contention =
    "on the GPU fewer voxels take longer, presumably since more fragments wait to be averaged into the same one; here "
    "time goes with fragments";
const char* const launches = "published levels cost something each however small they are; here texels alone count";

const std::vector<ShapeReason>& reasons_by_scene() {
  static const std::vector<ShapeReason> reasons = {
      {"static voxelization", false,
       "Conference takes there between 39 and 47 ms whatever the resolution, so that it is not its voxels that it is "
       "spent on; here time goes with fragments"},
      {"mipmap", false, sparse},
      {"second mipmap", false, sparse},
      {"bounce", true,
       "there the Cornell box is the dearest, since cones are traced far through empty space; here they jump over it, "
       "and "
       "time goes with the occupied voxels"},
      {"share of the dynamic total", false, std::string("stages that go over volumes: ") + sparse},
      {"share of the dynamic total", true, "voxelization: a GPU has a rasterizer, which is computed here"},
  };
  return reasons;
}

const std::vector<ShapeReason>& reasons_by_resolution() {
  static const std::vector<ShapeReason> reasons = {
      {"static voxelization", false, contention},
      {"static voxelization", true, contention},
      {"clear dynamic", true, sparse},
      {"dynamic voxelization", false, contention},
      {"dynamic voxelization", true, contention},
      {"mipmap", false, launches},
      {"second mipmap", false, launches},
      {"dynamic total", false, "at few voxels the dynamic voxelization is most of the published total: see there"},
  };
  return reasons;
}

}  // namespace

Section thesis_stage_times(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress,
                           MemoryByScene& memory) {
  return timed_section("Tables 4.3 and 4.4: stages by scene and resolution", [&](Section& section) {
    std::vector<Measured> measured;
    for (const StudyScene& scene : scenes) {
      measured.push_back({scene.name, {}});
      for (const int voxels : sizes.resolutions) {
        measured.back().by_resolution.push_back(measure_stages(scene, voxels, sizes.width_720, progress));
        memory[{scene.name, voxels}] = measured.back().by_resolution.back().bytes;
      }
    }
    const Shape scene_shape = by_scene(measured, sizes), resolution_shape = by_resolution(measured, sizes);
    section.text =
        fmt::format(
            "The published rules, under a sun without traced shadows, {} pixels wide in place of 1280. Seconds are the "
            "processor's, all threads together: what other programs take does not count. Clearing "
            "what was dynamic is here taking the static voxels over. The second mipmap is measured alone, and "
            "taken off the bounce, which it is a part of.\n\nBy scene, {} voxels:\n\n",
            sizes.width_720, sizes.base) +
        scene_shape.summary(reasons_by_scene()) + "\n\nBy resolution:\n\n" +
        resolution_shape.summary(reasons_by_resolution());
    section.tables = {scene_shape.table(), resolution_shape.table()};
    for (const auto& [name, quantity] : {std::pair("thesis_total", "dynamic total"),
                                         std::pair("thesis_bounce", "bounce"), std::pair("thesis_mipmap", "mipmap")}) {
      Chart chart{name,
                  fmt::format("Time by resolution: {}", quantity),
                  {"voxels along the longest side", true},
                  {fmt::format("time / that at {} voxels", sizes.base), true}};
      for (const Measured& scene : measured)
        for (Series& series : shape_series(resolution_shape.table(), scene.scene, quantity, scene.scene))
          chart.series.push_back(std::move(series));
      section.charts.push_back(std::move(chart));
    }
  });
}

}  // namespace voxref
