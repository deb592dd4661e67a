// voxref study and voxref plan, as a script runs them.
#include <limits>

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
  check_refused(place, "study pareto point.glb --gpu image.exr -o out", "--gpu: is for ladder alone");
  check_refused(place, "study pareto point.glb --set cone.step=1 -o out", "--set: is for ladder alone");
  check_refused(place, "study ladder --eye 1,2,3 --target 0,0,0 -o out", "--eye: needs the SCENE");
  check_refused(place, "study ladder point.glb --set cone.stop=1 -o out", "cone.step");
  check_refused(place, "study all point.glb -o out", "SCENE: is not for thesis");
  check_refused(place, "study stability point.glb -o out", "SCENE: is not for stability");
  std::filesystem::create_directory(place.path("b"));
  std::filesystem::copy(place.path("point.glb"), place.path("b/point.glb"));
  check_refused(place, "study pareto point.glb b/point.glb -o out", "b/point.glb: another SCENE has this name");
}

TEST_CASE("voxref study writes tables, a page and how each was made", "[study][cli]") {
  const Workplace place;
  // A plane alone: the quickest scene, which has direct light only.
  voxref::write_glb(place.path("plane.glb"), voxref::point_light_over_plane(), "for the tests");
  const json result = place.run_json("study ladder plane.glb -o out --quick --threads 2");
  const json& study = result["studies"][0];
  CHECK(study["name"] == "ladder");
  CHECK(study["command"] == "voxref study ladder plane.glb -o out --quick --threads 2");
  REQUIRE(study["sections"].size() == 1);
  for (const json& table : study["sections"][0]["tables"]) {
    const std::string name = table["name"];
    CHECK(std::filesystem::exists(place.path("out/" + name + ".csv")));
    const json file = json::parse(voxref::read_file(place.path("out/" + name + ".json")));
    CHECK(file["command"] == study["command"]);
    CHECK(file["rows"] == table["rows"]);
  }
  CHECK(json::parse(voxref::read_file(place.path("out/result.json"))) == result);
  CHECK(contains(voxref::read_file(place.path("out/report.html")),
                 "voxref study ladder plane.glb -o out --quick --threads 2"));
}

TEST_CASE("A gnuplot that does not work is refused before the work", "[study][cli]") {
  const Workplace place;
  const Outcome outcome = place.shell(
      "mkdir bin && printf '#!/bin/sh\\necho no fonts >&2\\nexit 1\\n' > bin/gnuplot && chmod +x bin/gnuplot && "
      "PATH=\"$PWD/bin:$PATH\" voxref study stability -o out");
  CHECK(outcome.status == 2);
  CHECK(contains(outcome.err, "gnuplot: trial: no fonts"));
  CHECK(!fs::exists(place.path("out")));
}

TEST_CASE("voxref study refuses an image that the ladder cannot end at, before it works", "[study][cli]") {
  const Workplace place;
  const auto write = [&](const std::string& name, int width, int height, float value) {
    voxref::Image image(width, height);
    image.add_layer("");
    image.channel("G")[4] = value;
    voxref::write_exr(place.path(name), image);
  };
  write("square.exr", 8, 8, 1.0f);
  write("wide.exr", 16, 8, 1.0f);
  write("nan.exr", 8, 8, std::numeric_limits<float>::quiet_NaN());
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    check_refused(place, "study ladder " + arguments + " -o out --quick", reason);
  };
  refused("point.glb --gpu absent.exr", "absent.exr: ");
  refused("point.glb --gpu nan.exr", "nan.exr: pixel (4, 0): is not finite; 1 of 64 pixels are not");
  refused("point.glb --gpu wide.exr", "wide.exr: size: 16x8 is 2 times as wide as high, the scene's camera");
  refused("empty.gltf --gpu square.exr", "square.exr: camera: the scene has none");
  refused("point.glb --camera nobody --gpu square.exr", "--camera: the scene has no camera 'nobody'");
}

TEST_CASE("voxref study takes a user's settings, camera and image, and says how to do it again", "[study][cli]") {
  const Workplace place;
  voxref::write_glb(place.path("plane.glb"), voxref::point_light_over_plane(), "for the tests");
  const std::string look = " --eye 0,1.5,1.5 --target 0,0,0 --background 0.1,0.1,0.1", goal = " --set cone.diffuse=4";
  REQUIRE(place.run("cone plane.glb -o mine.exr --size 24x16 --set grid.resolution=32" + look + goal).status == 0);
  const json result =
      place.run_json("study ladder plane.glb -o out --quick --set grid.resolution=32 --gpu mine.exr" + look + goal);
  const json& study = result["studies"][0];
  CHECK(study["command"] ==
        "voxref study ladder plane.glb -o out --quick --eye 0,1.5,1.5 --target 0,0,0 --background 0.1,0.1,0.1 --set "
        "grid.resolution=32 --set cone.diffuse=4 --gpu mine.exr");
  const json& section = study["sections"][0];
  CHECK(section["warnings"].empty());
  CHECK(contains(section["text"], "24x16 pixels"));
  CHECK(contains(
      section["text"],
      "Your image differs from the cone-traced one of your settings by +0.000 % of that one's mean, and 0.000 % RMS"));
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

TEST_CASE("voxref plan names and writes the closest, and exits with 1, where nothing reaches the budget",
          "[plan][cli]") {
  const Workplace place;
  voxref::write_text(place.path("plan.json"), "of an earlier plan");
  const std::string fixed = "--set storage=unorm8 --set bounce.count=0 --set grid.resolution=24 --set cone.step=1";
  const Outcome outcome = place.run("plan point.glb --budget 0.001 --size 8x8 -o plan.json --json " + fixed);
  INFO(outcome.err);
  CHECK(outcome.status == 1);
  CHECK(contains(outcome.err, "no setting reaches 0.1 %"));
  CHECK(contains(outcome.err, "closest   error"));
  const json plan = json::parse(outcome.out);
  CHECK(plan["reached"] == false);
  CHECK(plan["plan"].is_null());
  CHECK(plan["closest"]["rel_error"] > 0.001);
  CHECK(plan["reference_seconds"] > 0.0);
  CHECK(json::parse(voxref::read_file(place.path("plan.json"))) == plan["closest"]["settings"]);
}

TEST_CASE("voxref plan leaves alone what --set and --config give", "[plan][cli]") {
  const Workplace place;
  voxref::write_text(place.path("some.json"), R"({"grid": {"resolution": 20}, "storage": "float16"})");
  const json plan = place.run_json(
      "plan point.glb --budget 5 --size 8x8 --config some.json --set cone.step=0.25 --set bounce.count=0");
  const json rows = plan["trials"]["rows"];
  CHECK(rows.size() > 1);  // of different cones
  for (const json& row : rows) CHECK(json(row).at(0) == 20.0);
  for (const json& row : rows)
    CHECK(std::vector<json>(row.begin() + 1, row.begin() + 4) == std::vector<json>{"0", "float16", 0.25});
}

TEST_CASE("The flags that voxref plan names are the parameters that it planned with, arrays whole", "[plan][cli]") {
  const Workplace place;
  const json plan = place.run_json(
      "plan point.glb --budget 5 --size 8x8 --set grid.resolution=16 --set bounce.count=0 --set storage=unorm8 "
      "--set cone.step=1 --set cone.diffuse=4 --set 'grid.bounds=[[-2,-1,-2],[2,3,2]]' "
      "--set 'light.attenuation=[0, 0.5, 0.1]' --set light.falloff=attenuated -o plan.json");
  const std::string flags = plan["plan"]["assignments"];
  CHECK(place.run("cone point.glb -o cone.exr --size 12x12 --config plan.json").status == 0);
  CHECK(place.run("cone point.glb -o again.exr --size 12x12 " + flags).status == 0);
  check_same_bits(voxref::read_image(place.path("cone.exr")), voxref::read_image(place.path("again.exr")));
}

TEST_CASE("voxref plan says that its choice may change with the number of threads", "[plan][cli]") {
  CHECK(contains(Workplace().run("plan --help").out, "so may runs with\nother --threads"));
}
