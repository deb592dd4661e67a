// check --max-depth: how far light goes in both renderers.
#include "cli/workplace.h"

TEST_CASE("a check of paths that end gives the cone tracer as many bounces", "[cli]") {
  const Workplace place;
  voxref::write_glb(place.path("lamp.glb"), voxref::cornell_box(voxref::CornellLight::area), "for the tests");
  const std::string view = " --size 12x10 --set grid.resolution=24 ";
  const auto bounces = [&](const std::string& arguments) {
    const json provenance = place.run_json("check -o out --spp 2" + view + arguments)["provenance"];
    return std::pair(provenance["path"]["max_depth"], provenance["settings"]["bounce"]["count"]);
  };
  CHECK(bounces("point.glb --max-depth 2") == std::pair(json(2), json(0)));
  CHECK(bounces("point.glb --max-depth 4") == std::pair(json(4), json(2)));
  CHECK(bounces("lamp.glb --max-depth 1") == std::pair(json(1), json(0)));
  CHECK(bounces("lamp.glb --max-depth 3") == std::pair(json(3), json(2)));
  CHECK(bounces("point.glb --max-depth 4 --set bounce.count=1") == std::pair(json(4), json(1)));
  CHECK(bounces("point.glb --max-depth 2000") == std::pair(json(2000), json("auto")));
  CHECK(bounces("point.glb") == std::pair(json(), json("auto")));
  check_refused(place, "check point.glb -o out2 --max-depth 1" + view, "--max-depth: 1 is below 2");
  check_refused(place, "check lamp.glb -o out2 --max-depth 0" + view, "--max-depth: 0 is below 1");

  // Both kinds: nothing matches, which is said once.
  const Outcome both = place.run("check lamp.glb --sun 0,-1,0,1,1,1 -o both --spp 2 --max-depth 2 --json" + view);
  CHECK(both.status == 0);
  CHECK(both.err.find("--max-depth") != std::string::npos);
  CHECK(both.err.find("--max-depth") == both.err.rfind("--max-depth"));
  CHECK(json::parse(both.out)["provenance"]["settings"]["bounce"]["count"] == "auto");
}

TEST_CASE("with punctual lights both renderers stop at the same light", "[cli]") {
  const Workplace place;
  for (const std::string depth : {"2", "3"}) {
    CAPTURE(depth);
    const json check =
        place.run_json("check point.glb -o out --spp 64 --size 24x20 --set grid.resolution=64 --max-depth " + depth);
    // Cones in coarse voxels are 3 and 9 % off; with a bounce more at 2 it would be 61 %, with one less at 3 31 %.
    CHECK(check["metrics"]["mean_ratio"] == Approx(1.0).epsilon(0.15));
  }
}
