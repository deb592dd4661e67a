// Figures 4.12 to 4.30: how different pictures look from a base picture.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "compare/flip.h"
#include "image/image_file.h"
#include "study/curves.h"
#include "study/thesis_scenes.h"
#include "study/thesis_sections.h"

namespace voxref {

namespace {

/// As the thesis shows its pictures: x / (1 + x).
std::vector<glm::vec3> tone_mapped(const Image& image) {
  const auto planes = image.layer("");
  std::vector<glm::vec3> pixels(image.pixel_count());
  for (size_t i = 0; i < pixels.size(); ++i) {
    const glm::vec3 x = glm::max(glm::vec3(planes[0][i], planes[1][i], planes[2][i]), 0.0f);
    pixels[i] = x / (1.0f + x);
  }
  return pixels;
}

/// What specular cones alone add to a picture, as its `composite` has it.
Image specular_alone(Image image, const CompositeOptions& composite) {
  const auto specular = std::as_const(image).layer("specular");
  const auto all = image.layer("");
  for (size_t c = 0; c < 3; ++c)
    std::transform(specular[c].begin(), specular[c].end(), all[c].begin(),
                   [&](float value) { return std::pow(composite.bounce_strength * value, composite.indirect_power); });
  return image;
}

Image as_image(const std::vector<glm::vec3>& pixels, int width, int height) {
  Image image(width, height);
  image.add_layer("");
  const auto planes = image.layer("");
  for (size_t i = 0; i < pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) planes[size_t(c)][i] = pixels[i][c];
  return image;
}

/// What is seen of the difference between two pictures.
struct Perceived {
  double yee;   ///< share of the pixels that can be told apart
  double flip;  ///< mean, in [0,1]
};

Perceived perceived(const Image& base, const Image& other) {
  const std::vector<glm::vec3> a = tone_mapped(base), b = tone_mapped(other);
  const int width = base.width(), height = base.height();
  const std::vector<float> map = flip_map(width, height, a, b);
  const std::vector<double> values(map.begin(), map.end());
  constexpr float as_they_are = 0.0f;
  const uint64_t seen = yee_difference(as_image(a, width, height), as_image(b, width, height), as_they_are);
  return {double(seen) / double(map.size()), mean(values)};
}

/// Rows of one scene, and the same as series of both charts.
class Changes {
 public:
  Changes(Table& table, Chart& yee, Chart& flip, const std::string& scene, const Image& base)
      : table_(table), yee_(yee), flip_(flip), base_(base) {
    for (Chart* chart : {&yee_, &flip_}) chart->series.push_back({scene, ChartStyle::points});
  }
  Perceived add(const std::string& change, const Image& image) {
    const Perceived seen = perceived(base_, image);
    const std::string& scene = yee_.series.back().title;
    table_.add({scene, change, seen.yee, seen.flip});
    const auto known = std::find(yee_.x.categories.begin(), yee_.x.categories.end(), change);
    const auto place = static_cast<double>(known - yee_.x.categories.begin());
    if (known == yee_.x.categories.end())
      for (Chart* chart : {&yee_, &flip_}) chart->x.categories.push_back(change);
    yee_.series.back().points.push_back(chart_point(place, seen.yee));
    flip_.series.back().points.push_back(chart_point(place, seen.flip));
    return seen;
  }

 private:
  Table& table_;
  Chart &yee_, &flip_;
  const Image& base_;
};

Table perceived_table(const std::string& name, const std::string& caption) {
  return {name, caption, {{"scene", ""}, {"change", ""}, {"yee", "share of pixels"}, {"flip", "mean"}}};
}

std::pair<Chart, Chart> perceived_charts(const std::string& name, const std::string& title) {
  const Axis changes{""};
  return {Chart{name + "_yee", title + " (Yee)", changes, {"share of pixels that differ", false, 0.0}},
          Chart{name + "_flip", title + " (FLIP)", changes, {"mean FLIP", false, 0.0}}};
}

const char* const metrics =
    "Pictures mapped by x / (1 + x) as the thesis shows them; its metric, Yee's (here the version of 2004 that "
    "OpenImageIO has, as the share of pixels that an observer could tell apart), and FLIP (Andersson et al. 2020). It "
    "publishes pictures, without numbers.\n\n";

/// What the thesis finds, held against each scene's rows.
struct Findings {
  std::vector<std::string> unseen;  ///< scenes of which Yee's metric tells no pixel apart at any resolution
  std::vector<bool> coarser_yee, coarser_flip, longest;
};

void add_scene(const StudyScene& scene, const ThesisSizes& sizes, const Progress& progress, Table& table, Chart& yee,
               Chart& flip, Findings& findings) {
  const Settings base = thesis_shadow_settings(sizes.quality_base);
  const PreparedScene prepared(scene, base, progress);
  const LitVoxels lit = prepared.lit(base);
  const Image picture = prepared.image(base, lit, sizes.quality_width);
  Changes changes(table, yee, flip, scene.name, picture);
  Settings bounced = base;
  bounced.bounce.count = 1;
  changes.add("bounce", prepared.image(bounced, prepared.lit(bounced), sizes.quality_width));
  std::vector<Perceived> coarser, stepped;
  for (const int divisor : {2, 4, 8}) {
    progress.check();
    const Settings coarse = thesis_shadow_settings(sizes.quality_base / divisor);
    const PreparedScene smaller(scene, coarse, progress);
    coarser.push_back(changes.add(fmt::format("{} voxels", coarse.grid.resolution),
                                  smaller.image(coarse, smaller.lit(coarse), sizes.quality_width)));
  }
  for (const float step : {1.0f, 2.5f}) {
    Settings longer = base;
    longer.render.cone.step = step;
    stepped.push_back(changes.add(fmt::format("step {:g}", step), prepared.image(longer, lit, sizes.quality_width)));
  }
  findings.coarser_yee.push_back(coarser[0].yee < coarser[1].yee && coarser[1].yee < coarser[2].yee);
  if (coarser[2].yee == 0.0) findings.unseen.push_back(scene.name);
  findings.coarser_flip.push_back(coarser[0].flip < coarser[1].flip && coarser[1].flip < coarser[2].flip);
  findings.longest.push_back(stepped[0].flip < stepped[1].flip);
}

}  // namespace

Section thesis_quality(const std::vector<StudyScene>& lamps, const ThesisSizes& sizes, const Progress& progress) {
  return timed_section(
      "Figures 4.12 to 4.27: difference from the base picture, by bounce, resolution and step", [&](Section& section) {
        Table table =
            perceived_table("thesis_quality", fmt::format("What is seen of the difference from {} voxels, step 0.5, "
                                                          "no bounce at the voxels; {} pixels wide",
                                                          sizes.quality_base, sizes.quality_width));
        auto [yee, flip] = perceived_charts("thesis_quality", "Perceived difference from the base picture");
        Findings findings;
        for (const StudyScene& scene : lamps) add_scene(scene, sizes, progress, table, yee, flip, findings);
        section.text = std::string(metrics) +
                       finding("The difference grows as the resolution falls (Yee)", findings.coarser_yee, "scenes") +
                       (findings.unseen.empty() ? ""
                                                : fmt::format(" At the coarsest it tells no pixel apart of: {}.",
                                                              fmt::join(findings.unseen, ", "))) +
                       " " + finding("The same by FLIP", findings.coarser_flip, "scenes") + " " +
                       finding("A step of 2.5, which skips voxels, differs more than a step of 1 (FLIP)",
                               findings.longest, "scenes");
        section.tables.push_back(std::move(table));
        section.charts = {std::move(yee), std::move(flip)};
      });
}

Section thesis_specular(const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Figures 4.28 to 4.30: specular reflections by step", [&](Section& section) {
    Table table =
        perceived_table("thesis_specular", fmt::format("What is seen of the difference from step 0.1, {} voxels, "
                                                       "{} pixels wide",
                                                       sizes.quality_base, sizes.quality_width));
    auto [yee, flip] = perceived_charts("thesis_specular", "Specular ball: perceived difference from step 0.1");
    std::vector<bool> grows;
    std::vector<double> at_longest;
    for (const float degrees : {9.0f, 27.0f, 45.0f}) {
      progress.check();
      StudyScene ball = specular_ball(degrees);
      ball.name = fmt::format("ball, {:.3g} degrees", rendered_half_angle(ball.scene.materials.back()));
      Settings settings = thesis_shadow_settings(sizes.quality_base);
      const PreparedScene prepared(ball, settings, progress);
      const LitVoxels lit = prepared.lit(settings);
      settings.render.cone.step = 0.1f;
      const auto picture = [&] {
        return specular_alone(prepared.image(settings, lit, sizes.quality_width), settings.render.composite);
      };
      const Image base = picture();
      Changes changes(table, yee, flip, ball.name, base);
      std::vector<double> seen;
      for (const float step : {0.25f, 0.5f, 1.0f, 2.5f}) {
        settings.render.cone.step = step;
        seen.push_back(changes.add(fmt::format("step {:g}", step), picture()).flip);
      }
      for (size_t i = 1; i < seen.size(); ++i) grows.push_back(seen[i] > seen[i - 1]);
      at_longest.push_back(seen.back());
    }
    section.text =
        std::string(
            "Balls whose specular cones are as wide as those of Bunny, Dragon and Buddha there (as wide as a byte of "
            "glossiness can tell); what their specular light alone adds to a picture, direct light only in the "
            "voxels. ") +
        metrics + finding("Longer steps differ more (FLIP)", grows, "steps from one to the next of the three balls") +
        " " +
        finding("Thin reflections break up more: 9 degrees differs more than 45 at step 2.5 (FLIP)",
                {at_longest.front() > at_longest.back()}, "comparisons");
    section.tables.push_back(std::move(table));
    section.charts = {std::move(yee), std::move(flip)};
  });
}

}  // namespace voxref
