// Tables 4.3 and 4.4: what each stage takes, by scene and by resolution.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  return not_published;
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
    shape.add_block(all_scenes, column.name, lines, 0);
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

// Why rows differ, as far as it is known: from the occupied voxels that are counted beside the times, from the
// published times themselves, or by arithmetic from the shares.

const char* const dense =
    "the published passes go over every voxel, 8 times more per doubling and as many in every scene; here over those "
    "that surfaces occupy (thesis_voxels)";
const char* const overhead =
    "the published levels take 0.1 ms however few their texels are; here time goes with texels";
const char* const fewer =
    "the GPU takes longer for fewer voxels, why is not known; here time goes with triangles and fragments";
const char* const cones_lead = "cone tracing, which changes little with the resolution, is more of the total here";

const std::vector<ShapeReason>& reasons_by_scene() {
  const auto shares = [](const std::string& stage) {
    return std::vector<std::string>{"cornell_box " + stage, "sibenik " + stage, "conference " + stage,
                                    "sponza " + stage};
  };
  static const std::vector<ShapeReason> reasons = [&] {
    std::vector<ShapeReason> all = {
        {"static voxelization",
         false,
         {"conference"},
         "there it takes 39 to 47 ms whatever the resolution, so that it is not voxels that it is spent on; here time "
         "goes with triangles and fragments"},
        {"clear dynamic", true, {"sponza", "sibenik"}, dense},
        {"mipmap", false, {"sibenik", "conference"}, dense},
        {"mipmap", true, {"sponza"}, dense},
        {"second mipmap", false, {"sibenik", "conference"}, dense},
        {"second mipmap", true, {"sponza"}, dense},
        {"dynamic total",
         true,
         {"sibenik", "conference", "sponza"},
         "it is cone tracing for the most part, see there"}};
    for (const char* stage : {"clear dynamic", "dynamic voxelization", "shading", "mipmap", "bounce", "second mipmap"})
      all.push_back({"share of the dynamic total", false, shares(stage),
                     "cone tracing is more of the total here, which leaves less for the rest"});
    return all;
  }();
  return reasons;
}

/// "SCENE VOXELS" of all four published scenes.
std::vector<std::string> at(std::initializer_list<int> resolutions) {
  std::vector<std::string> rows;
  for (const char* scene : {"cornell_box", "sibenik", "conference", "sponza"})
    for (const int voxels : resolutions) rows.push_back(fmt::format("{} {}", scene, voxels));
  return rows;
}

const std::vector<ShapeReason>& reasons_by_resolution() {
  static const std::vector<ShapeReason> reasons = {
      {"static voxelization", false, {"sibenik 64", "sibenik 128", "sponza 64", "sponza 128"}, fewer},
      {"static voxelization", true, {"sponza 512"}, fewer},
      {"clear dynamic", true, at({64, 128}), dense},
      {"clear dynamic", false, at({512}), dense},
      {"dynamic voxelization", false, at({64, 128}), fewer},
      {"dynamic voxelization", true, {"sibenik 512", "conference 512", "sponza 512"}, fewer},
      {"shading", true, at({64, 128}), dense},
      {"shading", false, at({512}), dense},
      {"mipmap", false, at({64}), overhead},
      {"mipmap", false, at({512}), dense},
      {"mipmap", true, at({128}), dense},
      {"second mipmap", false, at({64}), overhead},
      {"second mipmap", false, at({512}), dense},
      {"second mipmap", true, at({128}), dense},
      {"dynamic total", true, {"cornell_box 64"}, cones_lead},
      {"dynamic total", false, at({512}), cones_lead},
      {"dynamic total",
       false,
       {"sibenik 64", "sponza 64"},
       "the dynamic voxelization, which takes longer there for fewer voxels, is most of the published total"},
  };
  return reasons;
}

/// What times go with here.
Table voxels_table(const std::vector<Measured>& measured, const ThesisSizes& sizes) {
  Table table{"thesis_voxels",
              "Voxels that surfaces occupy, and their share of the published dense cube",
              {{"scene", ""}, {"voxels", ""}, {"occupied", ""}, {"share", "%"}}};
  for (const Measured& scene : measured)
    for (size_t i = 0; i < sizes.resolutions.size(); ++i) {
      const auto occupied = double(scene.by_resolution[i].voxels);
      table.add({scene.scene, double(sizes.resolutions[i]), occupied,
                 100.0 * occupied / std::pow(double(sizes.resolutions[i]), 3.0)});
    }
  return table;
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
    const bool known = sizes.base == ThesisSizes::published_base;
    const std::vector<ShapeReason> none;
    section.text =
        fmt::format(
            "The published rules, under a sun without traced shadows. Cones are traced for as many pixels as {}x{} has "
            "in every scene, and their time scaled to the published 1280x720. Seconds are the processor's, all threads "
            "together: what other programs take does not count. Clearing what was dynamic is here taking the static "
            "voxels over. The second mipmap is measured alone, and taken off the bounce, which it is a part of.\n\nBy "
            "scene, {} voxels: ",
            sizes.width_720, sizes.width_720 * 9 / 16, sizes.base) +
        scene_shape.summary(known ? reasons_by_scene() : none) +
        "\n\nBy resolution: " + resolution_shape.summary(known ? reasons_by_resolution() : none);
    section.tables = {scene_shape.table(), resolution_shape.table(), voxels_table(measured, sizes)};
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
