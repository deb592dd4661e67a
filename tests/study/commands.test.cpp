// voxref study and voxref plan, as a script runs them.
#include "cli/workplace.h"

TEST_CASE("voxref study lists its studies, and refuses others and a missing folder", "[study][cli]") {
  const Workplace place;
  const json list = place.run_json("study --list");
  std::vector<std::string> names;
  for (const json& study : list["studies"]) names.push_back(study["name"]);
  CHECK(names == std::vector<std::string>{"pareto", "ladder", "thesis", "stability"});
  check_refused(place, "study", "NAME: needed");
  check_refused(place, "study nothing -o out", "'nothing': is no study; there are: pareto");
  check_refused(place, "study pareto", "-o: needed");
  check_refused(place, "study pareto missing.glb -o out", "missing.glb");
  check_refused(place, "study ladder --gpu image.exr -o out", "--gpu: needs the one scene");
}

TEST_CASE("voxref plan writes settings that cone takes, and says what it measured", "[plan][cli]") {
  const Workplace place;
  check_refused(place, "plan point.glb", "--budget: needed");
  check_refused(place, "plan point.glb --budget much", "--budget: ");
  check_refused(place, "plan point.glb --budget 1 -o point.glb", "-o");
  // Any setting is within 500 %: it takes the 180 of the coarsest resolution, at so few pixels some seconds.
  const json plan = place.run_json("plan point.glb --budget 5 --size 8x8 -o plan.json");
  CHECK(plan["reached"] == true);
  CHECK(plan["plan"]["rel_error"] < 5.0);
  CHECK(plan["plan"]["seconds"] > 0.0);
  CHECK(plan["plan"]["settings"]["grid"]["resolution"] == 32);
  CHECK(plan["trials"]["rows"].size() > 3);
  CHECK(json::parse(voxref::read_file(place.path("plan.json"))) == plan["plan"]["settings"]);
  CHECK(place.run("cone point.glb -o cone.exr --size 12x12 --config plan.json").status == 0);
  CHECK(
      place.run("cone point.glb -o again.exr --size 12x12 " + plan["plan"]["assignments"].get<std::string>()).status ==
      0);
  check_same_bits(voxref::read_image(place.path("cone.exr")), voxref::read_image(place.path("again.exr")));
}
