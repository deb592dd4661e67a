// The real `voxref diff`, as a script would run it.
#include <fstream>

#include "cli/workplace.h"

namespace {

/// path and cone images of the Cornell box, small; other seeds as asked for.
void render(const Workplace& place, const std::string& name, int seed, const std::string& more = "") {
  const Outcome outcome = place.run("path point.glb --size 32x32 --spp 64 --seed " + std::to_string(seed) + " -o " +
                                    name + " --quiet " + more);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
}

}  // namespace

TEST_CASE("diff of images says same, different or too noisy by its exit status and its keys", "[cli][diff]") {
  const Workplace place;
  render(place, "a.exr", 1);
  render(place, "b.exr", 2);
  render(place, "bright.exr", 3, "--light-scale 1.1");

  const json same = place.run_json("diff a.exr a.exr");
  CHECK(same["verdict"] == "same");
  for (const char* key : {"nonfinite_a", "nonfinite_b", "max_abs", "mean_signed", "rmse", "psnr", "worst", "differing",
                          "relmse", "relmse_formula", "ssim", "flip", "hdr_flip", "yee", "channels", "histogram"})
    CHECK(same.contains(key));

  const Outcome different = place.run("diff bright.exr b.exr --json");
  CHECK(different.status == 1);
  const json result = json::parse(different.out);
  CHECK(result["verdict"] == "different");
  CHECK(result["worst"].contains("place"));
  CHECK(result["differing"]["count"].get<int>() > 0);

  const Outcome noisy = place.run("diff a.exr b.exr --margin 1e-6 --fast --json");
  CHECK(noisy.status == 1);
  CHECK(json::parse(noisy.out)["verdict"] == "too_noisy");
  CHECK(place.run("diff a.exr b.exr --margin 0.5 --tile-margin 0.9 --fast --quiet").status == 0);
  CHECK(place.run("diff a.exr b.exr --abs 100 --fast --quiet").status == 0);
  CHECK(place.run("diff a.exr bright.exr --max-flip 1 --quiet").status == 0);
  CHECK(place.run("diff a.exr bright.exr --max-flip 1e-6 --quiet").status == 1);
  CHECK(place.run("diff a.exr b.exr --layer direct:indirect --fast --quiet").status == 1);
}

TEST_CASE("diff leaves pictures, result and a page in the folder of -o", "[cli][diff]") {
  const Workplace place;
  render(place, "a.exr", 1);
  render(place, "b.exr", 2, "--light-scale 2");
  CHECK(place.run("diff a.exr b.exr -o out --quiet").status == 1);
  for (const char* file :
       {"a.png", "b.png", "difference.png", "relative_error.png", "comparison.png", "result.json", "report.html"})
    CHECK(fs::exists(place.path("out") / file));
  CHECK(contains(voxref::read_file(place.path("out") / "report.html"), "different"));
  CHECK(json::parse(voxref::read_file(place.path("out") / "result.json"))["verdict"] == "different");
}

TEST_CASE("diff of folders finds where a pipeline first goes wrong, with and without a reference", "[cli][diff]") {
  const Workplace place;
  const std::string published = " --profile villegas2016 --set grid.resolution=16";
  REQUIRE(place.run("cone point.glb --size 8x8 -o c.exr --volumes b --quiet" + published).status == 0);
  fs::copy(place.path("b"), place.path("a"));
  CHECK(place.run_json("diff a b")["verdict"] == "same");
  CHECK(place.run_json("diff a --recompute point.glb" + published)["verdict"] == "same");

  // The last byte of a base volume: an empty voxel at the far corner becomes one with opacity.
  std::string bytes = voxref::read_file(place.path("a") / "radiance.npy");
  bytes.back() = char(200);
  voxref::write_text(place.path("a") / "radiance.npy", bytes);
  const Outcome outcome = place.run("diff a b -o out --json --recompute point.glb" + published);
  INFO(outcome.err);
  CHECK(outcome.status == 1);
  const json result = json::parse(outcome.out);
  CHECK(result["first_divergence"]["stage"] == "shade");
  CHECK(result["first_divergence"]["volume"] == "radiance");
  CHECK(result["first_divergence"]["voxel"] == json({15, 15, 15}));
  CHECK(result["per_volume"].size() > 20);
  CHECK(fs::exists(place.path("out") / "radiance.png"));
  CHECK(fs::exists(place.path("out") / "report.html"));
}

TEST_CASE("diff refuses what it cannot compare, in one line", "[cli][diff]") {
  const Workplace place;
  render(place, "a.exr", 1);
  const Outcome outcome = place.run("path point.glb --size 16x16 --spp 1 -o small.exr --quiet");
  REQUIRE(outcome.status == 0);
  voxref::write_text(place.path("broken.exr"), "no image");
  fs::create_directories(place.path("folder"));
  for (const char* arguments :
       {"diff a.exr", "diff a.exr missing.exr", "diff a.exr small.exr", "diff a.exr broken.exr", "diff a.exr folder",
        "diff folder folder", "diff a.exr a.exr --layer nothing", "diff a.exr a.exr --abs -1",
        "diff a.exr a.exr --recompute point.glb", "diff a.exr a.exr --tile 0"}) {
    INFO(arguments);
    const Outcome refused = place.run(arguments);
    CHECK(refused.status == 2);
    CHECK(refused.err.starts_with("voxref: "));
    CHECK(std::ranges::count(refused.err, '\n') == 1);
    CHECK(refused.out.empty());
  }
}
