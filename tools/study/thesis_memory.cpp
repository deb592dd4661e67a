// Table 4.9: memory.
#include <fmt/format.h>

#include "study/curves.h"
#include "study/thesis_data.h"
#include "study/thesis_sections.h"

namespace voxref {

Section thesis_memory_use(const MemoryByScene& memory, const ThesisSizes& sizes) {
  return timed_section("Table 4.9: memory", [&](Section& section) {
    Shape shape("thesis_memory", fmt::format("All volumes, over those at {} voxels of the same scene", sizes.base),
                "MB", "MB");
    Chart chart{
        "thesis_memory", "Memory of the volumes", {"voxels along the longest side", true}, {"memory / MB", true}};
    std::map<std::string, std::vector<ShapeLine>> scenes;
    for (const auto& [key, bytes] : memory) {
      double published = not_published;
      for (const ThesisMemory& row : thesis_memory)
        if (row.voxels == key.second) published = row.megabytes;
      const double megabytes = 1e-6 * double(bytes);
      scenes[key.first].push_back({std::to_string(key.second), {{megabytes, megabytes, megabytes}, 1}, published});
    }
    for (const auto& [scene, lines] : scenes) {
      size_t base = 0;
      while (lines[base].name != std::to_string(sizes.base)) ++base;
      shape.add_block(scene, "memory", lines, base);
      Series series{scene, ChartStyle::line_points};
      for (size_t i = 0; i < lines.size(); ++i)
        series.points.push_back(chart_point(sizes.resolutions[i], lines[i].ours.spread.median));
      chart.series.push_back(std::move(series));
    }
    Series published{"published, any scene", ChartStyle::dashes};
    for (const ThesisMemory& row : thesis_memory)
      if (row.voxels <= sizes.resolutions.back()) published.points.push_back(chart_point(row.voxels, row.megabytes));
    chart.series.push_back(std::move(published));
    const std::string constant =
        "the published figures are 211.6 MB that no voxel takes, and 5.14 MB (N/64)^3 of dense volumes, to 2 %; here "
        "there is no such constant, and surfaces grow 4 times per doubling";
    ShapeReason smaller{"memory", false, {}, constant};
    for (const auto& [key, bytes] : memory) smaller.rows.push_back(fmt::format("{} {}", key.first, key.second));
    std::vector<ShapeReason> reasons;
    if (sizes.base == ThesisSizes::published_base) reasons.push_back(std::move(smaller));
    section.text = shape.summary(reasons);
    section.tables.push_back(shape.table());
    section.charts.push_back(std::move(chart));
  });
}

}  // namespace voxref
