// Figures 4.11 and 4.32: how wide specular and shadow cones are.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/image.h"
#include "study/curves.h"
#include "study/study_scenes.h"
#include "study/thesis_scenes.h"
#include "study/thesis_sections.h"

namespace voxref {

namespace {

constexpr std::array apertures = {1.0f, 5.0f, 20.0f, 45.0f};  // half-angles, degrees

/// What the pixels that a light faces see of it.
struct Shadow {
  double penumbra;  ///< share of them that sees a part: between a twentieth and all but a twentieth
  double visible;   ///< mean share that is seen
};

Shadow shadow_of(const Image& shadowed, const Image& open) {
  const auto with = shadowed.layer("direct"), without = open.layer("direct");
  std::vector<double> shares, partial;
  for (size_t i = 0; i < shadowed.pixel_count(); ++i) {
    const float all = luminance({without[0][i], without[1][i], without[2][i]});
    if (all <= 0.0f) continue;  // but not where it is not a number
    shares.push_back(double(luminance({with[0][i], with[1][i], with[2][i]}) / all));
    partial.push_back(shares.back() > 0.05 && shares.back() < 0.95 ? 1.0 : 0.0);
  }
  return {mean(partial), mean(shares)};
}

}  // namespace

Section thesis_apertures(const ThesisSizes& sizes, const Progress& progress) {
  return timed_section("Figures 4.11 and 4.32: apertures of specular and shadow cones", [&](Section& section) {
    Table table{
        "thesis_apertures",
        "Time of an image by the half-angle of its cones, and how soft the shadow of the Plane Test's pillar is",
        {{"half_angle", "degrees"},
         {"specular_half_angle", "degrees"},
         {"specular", "s"},
         {"specular_error", "s"},
         {"shadow", "s"},
         {"shadow_error", "s"},
         {"penumbra", ""},
         {"visible", ""}}};
    const StudyScene box = cornell_point_scene(), pillar = plane_test_scene();
    Settings shadows = thesis_shadow_settings(sizes.base);
    const PreparedScene lamp(box, shadows, progress), test(pillar, shadows, progress);
    const LitVoxels lit = lamp.lit(shadows), test_lit = test.lit(shadows);
    const Image open = test.image(shadows, test_lit, sizes.quality_width);
    shadows.render.pixel.shadow = PixelShadow::cone;
    const auto half_range = [](const Timing& t) { return 0.5 * (t.spread.greatest - t.spread.least); };
    for (const float degrees : apertures) {
      progress.check();
      const StudyScene ball = specular_ball(degrees);
      const Settings settings = thesis_settings(sizes.base);
      const PreparedScene prepared(ball, settings, progress);
      const Timing specular = prepared.image_timing(settings, prepared.lit(settings), sizes.width_720);
      shadows.render.pixel.shadow_cone_aperture = std::tan(degrees * std::numbers::pi_v<float> / 180.0f);
      const Timing shadow = lamp.image_timing(shadows, lit, sizes.width_720);
      const Shadow soft = shadow_of(test.image(shadows, test_lit, sizes.quality_width), open);
      table.add({double(degrees), double(rendered_half_angle(ball.scene.materials.back())), specular.spread.median,
                 half_range(specular), shadow.spread.median, half_range(shadow), soft.penumbra, soft.visible});
    }
    const size_t last = table.rows.size() - 1;
    const auto faster = [&](const std::string& column) {  // with their spreads apart
      return table.number(last, column) + table.number(last, column + "_error") <
             table.number(0, column) - table.number(0, column + "_error");
    };
    std::vector<bool> softer;
    for (size_t i = 1; i < table.rows.size(); ++i)
      softer.push_back(table.number(i, "penumbra") > table.number(i - 1, "penumbra"));
    section.text =
        "Cornell box with a specular ball (whose half-angle a byte of glossiness rounds), or with shadow cones to its "
        "lamp; the Plane Test with shadow cones to its sun. Published are curves and pictures without numbers.\n\n" +
        finding("Wider cones are faster, 45 against 1 degree, by more than both spreads",
                {faster("specular"), faster("shadow")}, "kinds of cone (specular, shadow)") +
        " " + finding("A wider shadow cone is softer: more pixels see a part of the light", softer, "steps in angle") +
        fmt::format(
            " At 45 degrees {:.0f} % of the light is left: so wide a cone meets the surface that it starts from.",
            100.0 * table.number(last, "visible"));
    Chart times{"thesis_apertures",
                "Time of an image by the aperture of its cones",
                {"half-angle / degrees", true},
                {"processor time / s", false, 0.0}};
    for (const std::string column : {"specular", "shadow"}) {
      Series series{column, ChartStyle::line_points};
      for (size_t i = 0; i < table.rows.size(); ++i)
        series.points.push_back(
            chart_point(table.number(i, column == "specular" ? "specular_half_angle" : "half_angle"),
                        table.number(i, column), "", table.number(i, column + "_error")));
      times.series.push_back(std::move(series));
    }
    Chart soft{"thesis_soft_shadows",
               "Soft shadow of a pillar by the aperture of shadow cones",
               {"half-angle / degrees", true},
               {"share", false, 0.0},
               {curve(table, "half_angle", "penumbra", "pixels that see a part"),
                curve(table, "half_angle", "visible", "light that is seen, mean")}};
    section.charts = {std::move(times), std::move(soft)};
    section.tables.push_back(std::move(table));
  });
}

}  // namespace voxref
