// The pages that `diff` and `golden verify` leave, in a browser: no script error, whatever is pressed.
#include "cli/workplace.h"
#include "compare/browser.h"
#include "compare/volume_folder.h"

namespace {

/// Runs a command that shall find a difference, and then the page that it left.
void check_page(const Workplace& place, const std::string& arguments, const std::string& page,
                const std::vector<std::string>& shown) {
  const Outcome outcome = place.run(arguments);
  INFO(arguments << "\n" << outcome.out << outcome.err);
  REQUIRE(outcome.status == 1);
  const std::optional<std::string> dom =
      voxref::testing::run_in_browser(voxref::read_file(place.path(page)), voxref::testing::use_everything, "swipe");
  if (!dom) VOXREF_SKIP("chromium is not installed");
  CHECK(contains(*dom, "data-state=\"ready\""));
  CHECK(contains(*dom, "data-mode=\"b\" aria-checked=\"true\""));
  for (const std::string& text : shown) {
    INFO(text);
    CHECK(contains(*dom, text));
  }
}

}  // namespace

TEST_CASE("The page of two images works in a browser", "[cli][report]") {
  const Workplace place;
  REQUIRE(place.run("path point.glb --size 32x24 --spp 16 -o a.exr --light-scale 2 --quiet").status == 0);
  REQUIRE(place.run("path point.glb --size 32x24 --spp 16 -o b.exr --seed 1 --quiet").status == 0);
  check_page(place, "diff a.exr b.exr -o out --quiet", "out/report.html",
             {"a.exr against b.exr", "pixel (16, 12)", "standard errors off", "HDR-FLIP"});
}

TEST_CASE("The page of volumes works in a browser", "[cli][report]") {
  const Workplace place;
  const std::string published = " --profile villegas2016 --set grid.resolution=16";
  REQUIRE(place.run("cone point.glb --size 4x4 -o c.exr --volumes a --quiet" + published).status == 0);
  fs::copy(place.path("a"), place.path("b"));
  voxref::testing::tamper(place.path("a"), "radiance", 40);
  check_page(place, "diff a b/ -o out --quiet --recompute point.glb" + published, "out/report.html",
             {"a against b", "pixel (8, 8)", "Each stage on its own input", "A against B"});
}

TEST_CASE("The page of a failed golden works in a browser", "[cli][report]") {
  const Workplace place;
  const fs::path source = VOXREF_SOURCE_DIR;
  fs::copy(source / "golden", place.path("golden"), fs::copy_options::recursive);
  voxref::Image golden = voxref::read_image(place.path("golden") / "cone_plane_test.exr");
  for (const std::span<float> plane : golden.layer(""))
    for (float& value : plane) value *= 1.1f;
  write_exr(place.path("golden") / "cone_plane_test.exr", golden);
  check_page(place, "golden verify --scenes '" + (source / "scenes").string() + "' --case cone_plane_test -o failed",
             "failed/cone_plane_test/report.html",
             {"rendered now against cone_plane_test.exr", "pixel (48, 48)", "Likely cause: a constant factor"});
}
