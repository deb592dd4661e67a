#include "study/thesis_shape.h"

#include <limits>

#include "catch.h"
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

TEST_CASE("A line of a table agrees when its ratio to the base is within a factor of 2 of the published one",
          "[study][thesis]") {
  Shape shape("name", "caption", "s", "ms");
  const double none = std::numeric_limits<double>::quiet_NaN();
  shape.add_block("box", "work",
                  {line("64", 1.0, 10.0), line("128", 3.9, 20.0), line("256", 4.1, 20.0), line("512", 0.9, 20.0),
                   line("1024", 4.1, 20.0, 0.1), line("2048", 1.0, none)},
                  0);
  const Table& table = shape.table();
  REQUIRE(table.rows.size() == 6);
  CHECK(judgement(shape, 0) == "base");
  CHECK(judgement(shape, 1) == "agrees");  // 3.9 against 2
  CHECK(judgement(shape, 2) == "larger");
  CHECK(judgement(shape, 3) == "smaller");
  CHECK(judgement(shape, 4) == "unsure");  // 3.7 to 4.5 against 2
  CHECK(judgement(shape, 5).empty());
  CHECK(table.number(1, "ratio") == Approx(3.9));
  CHECK(table.number(1, "ratio_published") == Approx(2.0));
  CHECK(table.number(1, "factor") == Approx(1.95));

  const std::vector<ShapeReason> reasons = {{"work", true, "THE REASON"}};
  const std::string text = shape.summary(reasons);
  CAPTURE(text);
  CHECK(text.find("work: 1 of 4 ratios agree") != std::string::npos);
  CHECK(text.find("1 may or may not") != std::string::npos);
  CHECK(text.find("1 is larger by 2: THE REASON") != std::string::npos);  // 4.1 / 2, to two digits
  CHECK(text.find("1 is smaller by 2.2: no reason is known") != std::string::npos);
  CHECK(Shape("name", "", "s", "ms").summary({}) == "Nothing was published for what was measured.");

  const std::vector<Series> series = shape_series(table, "box", "work", "box");
  REQUIRE(series.size() == 2);
  CHECK(series[0].points[1].x == 128.0);
  CHECK(series[1].points[1].y == Approx(2.0));
  CHECK(shape_series(table, "other", "work", "other")[0].points.empty());
}

TEST_CASE("What takes under a second is measured five times, and its median is told", "[study][thesis]") {
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
  CHECK(calls == 1);
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
  CHECK(volume_memory(box, 32, {}) == stages.bytes);
  CHECK(stages.fixed.runs == 5);
  // Times are the machine's; but the total of a round is that of its parts.
  CHECK(stages.total.spread.greatest <= stages.clear.spread.greatest + stages.dynamic.spread.greatest +
                                            stages.shade.spread.greatest + stages.mipmap.spread.greatest +
                                            stages.bounce.spread.greatest + stages.bounce_mipmap.spread.greatest +
                                            stages.cones.spread.greatest + 1e-9);
}
