#include "reference/checkpoint.h"

#include <atomic>
#include <random>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "reference/small_scenes.h"
#include "temporary_folder.h"

namespace voxref {

namespace {

const std::string render_json = R"({"scene": "a", "seed": 0})";

View small_view() { return view_from({0.0f, 0.0f, 0.95f}, {0.0f, 0.2f, 0.0f}, 40, 40, 1.6f); }

/// Renders until the finished fraction goes beyond `stop`.
PathResult render_until(const PathOptions& options, double stop) {
  const Scene scene = lit_room();
  const Caster caster(scene);
  std::atomic<bool> cancel = false;
  Progress progress;
  progress.cancel = &cancel;
  progress.report = [&](std::string_view, double fraction) { cancel = cancel || fraction > stop; };
  return path_trace(scene, caster, small_view(), options, progress);
}

PathOptions checkpointed(const std::filesystem::path& file) {
  PathOptions options;
  options.spp = 80;  // 16 passes of 4 samples, and 4 more
  options.extra = {.bounces = 1, .irradiance = true};
  options.checkpoint = {.file = file, .interval = 1e-6, .resume = true, .render = render_json};
  return options;
}

std::string refusal(const PathOptions& options) {
  try {
    render_until(options, 2.0);
  } catch (const Error& error) {
    return error.what();
  }
  return "resumed";
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

TEST_CASE("A render resumed again and again ends with the bits of an uninterrupted one", "[checkpoint]") {
  const TemporaryFolder folder;
  PathOptions options = checkpointed(folder.path / "checkpoint");
  for (const bool until_noise : {false, true}) {
    CAPTURE(until_noise);
    std::filesystem::remove(options.checkpoint.file);
    if (until_noise) {
      options.spp = 0;
      options.noise = 0.04;  // some 200 samples: known from the 16th pass on
    }
    PathOptions plain = options;
    plain.checkpoint = {};
    const PathResult whole = render_until(plain, 2.0);
    PathResult result = render_until(options, 0.13);
    REQUIRE(result.interrupted);
    CHECK(!same_bits(result.image, whole.image));
    // Anywhere, mid-pass too.
    std::mt19937 random(5);
    int resumed = 1;
    for (double stop = 0.15; result.interrupted && stop < 1.0; ++resumed) {
      result = render_until(options, stop);
      stop += std::uniform_real_distribution<double>(0.05, 0.2)(random);
    }
    CHECK(resumed > 3);
    result = render_until(options, 2.0);
    CHECK(!result.interrupted);
    CHECK(same_bits(result.image, whole.image));
    CHECK(result.spp == whole.spp);
    CHECK(result.mean == whole.mean);
    CHECK(result.mean_stderr == whole.mean_stderr);
    CHECK(result.nonfinite == whole.nonfinite);
  }
}

TEST_CASE("Pauses for checkpoints, within passes too, change no bit", "[checkpoint]") {
  const TemporaryFolder folder;
  PathOptions options = checkpointed(folder.path / "checkpoint");
  PathOptions plain = options;
  plain.checkpoint = {};
  const PathResult whole = render_until(plain, 2.0), paused = render_until(options, 2.0);
  CHECK(same_bits(paused.image, whole.image));
  CHECK(paused.rays == whole.rays);
  CHECK(std::filesystem::exists(options.checkpoint.file));
}

TEST_CASE("A checkpoint of another render is refused, with what differs", "[checkpoint]") {
  const TemporaryFolder folder;
  PathOptions options = checkpointed(folder.path / "checkpoint");
  render_until(options, 0.5);
  const std::string kept = read_file(options.checkpoint.file);
  options.checkpoint.render = R"({"scene": "a", "seed": 7})";
  CHECK(ends_with(refusal(options), "checkpoint: seed: 0, but 7 here: it is a checkpoint of another render"));
  options.checkpoint.render = R"({"scene": "a", "seed": 0, "spp": 64})";
  CHECK(ends_with(refusal(options), "checkpoint: spp: none, but 64 here: it is a checkpoint of another render"));
  CHECK(read_file(options.checkpoint.file) == kept);
  options.checkpoint.resume = false;  // whoever does not resume begins anew
  CHECK(refusal(options) == "resumed");
}

TEST_CASE("A damaged checkpoint is refused", "[checkpoint]") {
  const TemporaryFolder folder;
  const PathOptions options = checkpointed(folder.path / "checkpoint");
  render_until(options, 0.5);
  const std::string whole = read_file(options.checkpoint.file);
  for (const size_t length : {size_t{0}, size_t{10}, size_t{25}, size_t{40}, whole.size() / 2, whole.size() - 1}) {
    CAPTURE(length);
    write_text(options.checkpoint.file, whole.substr(0, length));
    CHECK(refusal(options).find("is damaged") != std::string::npos);
  }
  for (const size_t place : {size_t{40}, whole.size() / 3, whole.size() - 100, whole.size() - 1}) {
    CAPTURE(place);
    std::string flipped = whole;
    flipped[place] = static_cast<char>(flipped[place] ^ 1);
    write_text(options.checkpoint.file, flipped);
    CHECK(refusal(options).find("is damaged") != std::string::npos);
  }
  write_text(options.checkpoint.file, whole + "x");
  CHECK(refusal(options).find("is damaged") != std::string::npos);
  write_text(options.checkpoint.file, "a poem, not a checkpoint, long enough to have a signature");
  CHECK(refusal(options).find("is no checkpoint") != std::string::npos);
  write_text(options.checkpoint.file, whole);
  CHECK(refusal(options) == "resumed");
}

}  // namespace voxref
