#include "reference/merge.h"

#include <algorithm>
#include <vector>

#include "catch.h"
#include "error.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

const std::string render_of_parts = R"({"seed": 0, "scene": "a"})";

struct NamedPart {
  std::string file;
  Image image;
};

View wide_view() { return view_from({0.0f, 0.0f, 0.95f}, {0.0f, 0.2f, 0.0f}, 70, 40, 1.6f); }

PathOptions part_options(const Part& part, int spp = 20) {
  PathOptions options;
  options.spp = spp;
  options.extra = {.bounces = 1, .irradiance = true};
  options.part = part;
  return options;
}

/// All parts of a render of 6 tiles, as files "1", "2", ...
std::vector<NamedPart> render_parts(int count) {
  const Scene scene = lit_room();
  const Caster caster(scene);
  std::vector<NamedPart> parts;
  for (int index = 1; index <= count; ++index) {
    const Part part = {index, count};
    parts.push_back({std::to_string(index), path_trace(scene, caster, wide_view(), part_options(part)).image});
    mark_part(parts.back().image, part, 20, render_of_parts);
  }
  return parts;
}

Image merge(const std::vector<NamedPart>& parts) {
  PartMerger merger;
  for (const NamedPart& part : parts) merger.add(part.file, part.image);
  return merger.finish();
}

std::string refusal(const std::vector<NamedPart>& parts) {
  try {
    merge(parts);
  } catch (const Error& error) {
    return error.what();
  }
  return "joined";
}

}  // namespace

TEST_CASE("Parts join to the bits of one render in any order", "[merge]") {
  const Scene scene = lit_room();
  const Caster caster(scene);
  const Image whole = path_trace(scene, caster, wide_view(), part_options({})).image;
  CHECK(same_bits(merge(render_parts(1)), whole));
  CHECK(same_bits(merge(render_parts(6)), whole));
  std::vector<NamedPart> parts = render_parts(4);
  do {
    CHECK(same_bits(merge(parts), whole));
  } while (std::next_permutation(parts.begin(), parts.end(),
                                 [](const NamedPart& a, const NamedPart& b) { return a.file < b.file; }));
}

TEST_CASE("A part says by its samples what it holds", "[merge]") {
  const std::vector<NamedPart> parts = render_parts(2);
  for (size_t i = 0; i < parts[0].image.pixel_count(); ++i) {
    const float first = parts[0].image.channel("samples")[i], second = parts[1].image.channel("samples")[i];
    CHECK(first + second == 20.0f);
    CHECK(first * second == 0.0f);
    CHECK((parts[0].image.channel("R")[i] == 0.0f || first > 0.0f));
  }
}

TEST_CASE("A missing, doubled, foreign or unfinished part is refused by name", "[merge]") {
  const std::vector<NamedPart> parts = render_parts(3);
  CHECK(refusal({parts[2], parts[0]}) == "merge: part 2/3 is missing");
  CHECK(refusal({parts[2], parts[0], parts[1], parts[0]}) == "1: part 1/3: is there already: 1");

  NamedPart foreign = parts[1];
  foreign.file = "foreign";
  foreign.image.attributes["voxref:render"] = R"({"seed": 7, "scene": "a"})";
  CHECK(refusal({parts[0], foreign, parts[2]}) == "foreign: seed: 7, but 0 in 1: a part of another render");
  foreign.image.attributes["voxref:render"] = "poem";
  CHECK(refusal({parts[0], foreign}).rfind("foreign: ", 0) == 0);
  foreign.image = Image(70, 40);
  CHECK(refusal({parts[0], foreign}).rfind("foreign: header: is no part", 0) == 0);
  foreign.image = parts[1].image;
  foreign.image.attributes["voxref:part"] = "2/0";
  CHECK(refusal({parts[0], foreign}) == "foreign: voxref:part: '2/0' is not I/N");
  foreign.image.attributes["voxref:part"] = "2/5";
  CHECK(refusal({parts[0], foreign}) == "foreign: part 2/5: cannot be joined with one of 3, 1");
  foreign = parts[1];
  foreign.file = "foreign";
  foreign.image.add("more");
  CHECK(refusal({parts[0], foreign}).rfind("foreign: channels: ", 0) == 0);

  NamedPart stopped = parts[1];
  stopped.file = "stopped";
  for (float& samples : stopped.image.channel("samples")) samples = std::min(samples, 16.0f);
  CHECK(refusal({parts[0], stopped, parts[2]}) ==
        "stopped: part 2/3: was stopped at 16 samples of 20; path --resume finishes it");
  // All alike, as by a time limit of the farm's.
  std::vector<NamedPart> all = parts;
  for (NamedPart& part : all)
    for (float& samples : part.image.channel("samples")) samples = std::min(samples, 16.0f);
  CHECK(refusal(all) == "1: part 1/3: was stopped at 16 samples of 20; path --resume finishes it");
}

TEST_CASE("A joined image keeps what all parts say of themselves", "[merge]") {
  std::vector<NamedPart> parts = render_parts(2);
  for (NamedPart& part : parts) {
    part.image.attributes["alike"] = "same";
    part.image.attributes["host"] = part.file;
  }
  const Image joined = merge(parts);
  CHECK(joined.attributes.at("alike") == "same");
  CHECK(!joined.attributes.contains("host"));
  CHECK(!joined.attributes.contains("voxref:part"));
  CHECK(!joined.attributes.contains("voxref:part_spp"));
  CHECK(refusal({{"again", joined}}).rfind("again: header: is no part", 0) == 0);
}

TEST_CASE("Parts that could not be joined are refused before they are rendered", "[merge]") {
  const Scene scene = lit_room();
  const Caster caster(scene);
  for (const Part part : {Part{0, 2}, Part{3, 2}, Part{1, 16}})
    CHECK_THROWS_AS(path_trace(scene, caster, wide_view(), part_options(part)), Error);
  PathOptions options = part_options({1, 2});
  options.noise = 0.1;
  CHECK_THROWS_AS(path_trace(scene, caster, wide_view(), options), Error);
}

}  // namespace voxref
