#include "study/thesis_shape.h"

#include <limits>
#include <tuple>

#include "catch.h"
#include "error.h"
#include "study/study_scenes.h"
#include "study/thesis_bench.h"

using namespace voxref;

namespace {

ShapeLine line(const std::string& name, double seconds, double published, double spread = 0.0) {
  return {name, {{seconds, seconds * (1.0 - spread), seconds * (1.0 + spread)}, 3}, published};
}

std::string judgement(const Shape& shape, size_t row) {
  return std::get<std::string>(shape.table().rows.at(row).at(shape.table().column("shape")));
}

}  // namespace

TEST_CASE("A ratio agrees when it and its spread go the published way, half to one and a half as far",
          "[study][thesis]") {
  Shape shape("name", "caption", "s", "ms");
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::tuple<const char*, double, double, double, const char*>> lines = {
      {"base", 1.0, 10.0, 0.0, "base"},
      // Four times the base's time, so that 2 to 8 agree.
      {"least", 2.01, 40.0, 0.0, "agrees"},
      {"too little", 1.99, 40.0, 0.0, "smaller"},
      {"most", 7.9, 40.0, 0.0, "agrees"},
      {"too much", 8.1, 40.0, 0.0, "larger"},
      {"spread out", 2.1, 40.0, 0.1, "unsure"},
      {"spread in", 1.9, 40.0, 0.1, "unsure"},
      {"constant", 1.0, 40.0, 0.0, "smaller"},
      // A sixteenth: a factor of 2 at the most, not of 4.
      {"far", 1.0 / 9.0, 10.0 / 16.0, 0.0, "agrees"},
      {"too far", 1.0 / 7.0, 10.0 / 16.0, 0.0, "larger"},
      // Within 10 % of the published ratio, since that is what two repetitions may differ by.
      {"the same", 1.14, 10.5, 0.0, "agrees"},
      {"not the same", 1.17, 10.5, 0.0, "larger"},
      {"turned", 1.25, 8.0, 0.0, "larger"},
      {"nothing", 1.0, none, 0.0, ""},
      {"no number", none, 40.0, 0.0, "not a number"},
  };
  std::vector<ShapeLine> block;
  for (const auto& [name, seconds, published, spread, expected] : lines)
    block.push_back(line(name, seconds, published, spread));
  shape.add_block("box", "work", block, 0);
  const Table& table = shape.table();
  REQUIRE(table.rows.size() == lines.size());
  for (size_t i = 0; i < lines.size(); ++i) {
    CAPTURE(std::get<0>(lines[i]));
    CHECK(judgement(shape, i) == std::get<4>(lines[i]));
  }
  CHECK(table.number(1, "ratio") == Approx(2.01));
  CHECK(table.number(1, "ratio_published") == Approx(4.0));
  CHECK(table.number(1, "factor") == Approx(0.5025));

  const std::string text =
      shape.summary(std::vector<ShapeReason>{{"work", true, {"box too much", "box least"}, "THE REASON"},
                                             {"work", false, {"box turned"}, "ANOTHER"},
                                             {"play", true, {"box too far"}, "ANOTHER"}});
  CAPTURE(text);
  const auto says = [&](const char* words) { return text.find(words) != std::string::npos; };
  CHECK(says(
      "4 of 13 ratios agree with the published ones (2 would if nothing changed), of 2 the spread leaves it open"));
  CHECK(says("work: 4 of 13 ratios agree (2 would if nothing changed)"));
  CHECK(says("unsure by their spread: box spread out, box spread in;"));
  CHECK(says("not a number: box no number;"));
  CHECK(says("larger: box too much (8.1 in place of 4): THE REASON;"));
  // A reason is for the rows that it names and for the way that it explains.
  CHECK(
      says("larger: box too far (0.14 in place of 0.062), box not the same (1.2 in place of 1.1), "
           "box turned (1.2 in place of 0.8, the other way round): why is not known;"));
  CHECK(says("smaller: box too little (2 in place of 4), box constant (1 in place of 4): why is not known."));
  CHECK_FALSE(says("ANOTHER"));
  CHECK(Shape("name", "", "s", "ms").summary({}) == "Nothing was published for what was measured.");

  const std::vector<Series> series = shape_series(table, "box", "work", "box");
  REQUIRE(series.size() == 2);
  CHECK(series[0].points[1].y == Approx(2.01));
  CHECK(series[1].points[1].y == Approx(4.0));
  CHECK(shape_series(table, "other", "work", "other")[0].points.empty());
}

TEST_CASE("A line whose name is a number is drawn at that number", "[study][thesis]") {
  Shape shape("name", "caption", "s", "ms");
  shape.add_block("box", "work", {line("64", 1.0, 10.0), line("128", 3.9, 20.0)}, 0);
  CHECK(shape_series(shape.table(), "box", "work", "box")[0].points[1].x == 128.0);
}

TEST_CASE("A time too short for the clock leaves its ratio unsure, without an error bar", "[study][thesis]") {
  Shape shape("name", "caption", "s", "ms");
  ShapeLine instant = line("base", 1.0, 10.0);
  instant.ours.spread.least = 0.0;
  shape.add_block("box", "work", {instant, line("other", 4.0, 40.0)}, 0);
  CHECK(judgement(shape, 1) == "unsure");
  CHECK(shape_series(shape.table(), "box", "work", "box")[0].points[1].error == 0.0);
}

TEST_CASE("Of a block of all scenes, rows are named after their line alone", "[study][thesis]") {
  Shape shape("name", "caption", "s", "ms");
  shape.add_block(all_scenes, "work", {line("box", 1.0, 10.0), line("sponza", 3.9, 10.0)}, 0);
  const std::string text = shape.summary(std::vector<ShapeReason>{{"work", true, {"sponza"}, "THE REASON"}});
  CHECK(text.find("larger: sponza (3.9 in place of 1): THE REASON.") != std::string::npos);
}

TEST_CASE("What takes under a second is measured five times, else three, and its median is told", "[study][thesis]") {
  int calls = 0;
  const auto times = [&](double unit) {
    calls = 0;
    return repeated([&] {
      ++calls;
      return std::vector<double>{unit * calls, 0.0};
    });
  };
  const std::vector<Timing> quick = times(0.1);
  CHECK(calls == 5);
  REQUIRE(quick.size() == 2);
  CHECK(quick[0].runs == 5);
  CHECK(quick[0].spread.median == Approx(0.3));
  CHECK(quick[0].spread.least == Approx(0.1));
  CHECK(quick[0].spread.greatest == Approx(0.5));
  times(2.0);
  CHECK(calls == 3);
  times(20.0);
  CHECK(calls == 3);  // one run would have no spread
  // A round returns stages and their total, which are not to be added up.
  calls = 0;
  repeated([&] {
    ++calls;
    return std::vector<double>{0.3, 0.4, 0.7};
  });
  CHECK(calls == 5);
}

TEST_CASE("A finding says for how many it holds", "[study][thesis]") {
  CHECK(finding("Snow falls", {true, false, true}, "days") == "Snow falls: true for 2 of 3 days.");
}

TEST_CASE("A prepared scene renders what the pipeline renders, and its memory is what was predicted",
          "[study][thesis]") {
  const StudyScene box = cornell_point_scene();
  const Settings settings = thesis_settings(32);
  const Progress silent;
  const PreparedScene prepared(box, settings, silent);
  const Image image = prepared.image(settings, prepared.lit(settings), 12);
  const ConeTraceResult whole = cone_trace(box.scene, Caster(box.scene), sized(box.view, 12), settings);
  for (const std::string& channel : image.channels()) {
    CAPTURE(channel);
    const auto a = image.channel(channel), b = whole.image.image.channel(channel);
    CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
  const StageTimings stages = measure_stages(box, 32, 12, {});
  CHECK(stages.bytes == whole.bytes.at("total"));
  // Three or five by the machine's clock, which decides no test; which of them when is tested above with made-up
  // seconds.
  CHECK((stages.fixed.runs == 3 || stages.fixed.runs == 5));
  CHECK(stages.voxels == prepared.lit(settings).voxels_occupied);
  // Times are the machine's; but the total of a round is that of its parts.
  CHECK(stages.total.spread.greatest <= stages.clear.spread.greatest + stages.dynamic.spread.greatest +
                                            stages.shade.spread.greatest + stages.mipmap.spread.greatest +
                                            stages.bounce.spread.greatest + stages.bounce_mipmap.spread.greatest +
                                            stages.cones.spread.greatest + 1e-9);
}

TEST_CASE("Timed images have equally many pixels, whatever the camera's aspect", "[study][thesis]") {
  View view;
  for (const float aspect : {16.0f / 9.0f, 1.0f, 0.75f}) {
    view.camera.aspect = aspect;
    const View timed = timed_view(view, 640);
    CAPTURE(timed.width, timed.height);
    CHECK(timed.width * timed.height == Approx(640 * 360).epsilon(0.002));  // whole pixels
    CHECK(float(timed.width) / float(timed.height) == Approx(aspect).epsilon(0.005));
  }
}

TEST_CASE("An image with a pixel that is no number is refused, and the pixel named", "[study][thesis]") {
  ConeTraceResult result;
  CHECK_NOTHROW(finite_image(result, "box"));
  result.image.nonfinite = 2;
  result.image.first_nonfinite = "pixel (1, 2)";
  CHECK_THROWS_AS(finite_image(result, "box"), Error);
}
