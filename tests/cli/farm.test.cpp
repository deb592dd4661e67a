// Long work: renders that are killed and resumed, and parts rendered apart.
#include "cli/workplace.h"

TEST_CASE("a path tracer killed at any moment goes on to the same bits and leaves nothing but its output", "[cli]") {
  const Workplace place;
  const std::string command = "path point.glb --size 40x30 --spp 512 --checkpoint 0.02 --resume --quiet -o ";
  REQUIRE(place.run(command + "whole.exr").status == 0);
  const std::set<std::string> before = place.files();
  constexpr int killed_status = 128 + 9;  // of timeout, after SIGKILL
  int killed = 0;
  // Later and later, so that it gets through even where nothing is saved before the end.
  for (int attempt = 0; attempt < 40 && !fs::exists(place.path("out.exr")); ++attempt) {
    const double seconds = 0.05 + 0.037 * (attempt * 7 % 10) + 0.05 * attempt;
    const int status = place.run(command + "out.exr", "timeout -s KILL " + std::to_string(seconds)).status;
    CHECK((status == 0 || status == killed_status));  // above all, no checkpoint is found damaged
    killed += status == killed_status;
  }
  CHECK(killed > 0);
  // A kill after the output was renamed leaves the checkpoint, which the next run uses up.
  REQUIRE(place.run(command + "out.exr").status == 0);
  check_same_bits(voxref::read_image(place.path("out.exr")), voxref::read_image(place.path("whole.exr")));
  std::set<std::string> expected = before;
  expected.insert(place.path("out.exr").string());
  CHECK(place.files() == expected);
}

TEST_CASE("an interrupted path tracer keeps a checkpoint, which another render's is not taken for", "[cli]") {
  const Workplace place;
  // Stopped as soon as there is something to keep, however long that takes on a busy machine.
  const Outcome stopped = place.shell(
      "voxref path point.glb -o out.exr --spp 16000000 --checkpoint 0.05" + small_view +
      " & p=$!; while [ ! -e out.exr.checkpoint ] && kill -0 $p; do sleep 0.05; done; kill -TERM $p; wait $p");
  CHECK(stopped.status == 1);
  CHECK(contains(stopped.err, "--resume"));
  REQUIRE(fs::exists(place.path("out.exr.checkpoint")));
  check_refused(place, "path point.glb -o out.exr --resume --spp 16000000 --seed 3" + small_view,
                "out.exr.checkpoint: path.seed: 0, but 3 here");
  check_refused(place, "path empty.gltf -o out.exr --resume --spp 16000000" + small_view, "scene_sha256");
}

TEST_CASE("a default that is typed out is the same render, and a different value is not", "[cli]") {
  const Workplace place;
  REQUIRE(place.run("path point.glb --size 40x30 -o part1.exr --part 1/2").status == 0);
  REQUIRE(place
              .run("path point.glb --size 40x30 -o part2.exr --part 2/2 --spp 64 --seed 0 --camera 0 --pixel center "
                   "--background 0,0.0,0 --light-scale 1 --threads 1")
              .status == 0);
  CHECK(place.run("merge part1.exr part2.exr -o whole.exr").status == 0);
  const auto refused = [&](const std::string& flags, const std::string& reason) {
    REQUIRE(place.run("path point.glb -o other.exr --part 2/2 --size 40x30 " + flags).status == 0);
    check_refused(place, "merge part1.exr other.exr -o out.exr", reason);
  };
  refused("--light-scale 2", "load.light_scale: 2.0, but 1.0");
  refused("--background 0,0,1", "camera.background.2: 1.0, but 0.0");
  refused("--yfov 20", "camera.yfov_degrees");
  refused("--max-depth 3", "path.max_depth: 3, but null");
  refused("--sun 0,-1,0,1,1,1", "load.suns");
}

TEST_CASE("parts join to the bits of one render", "[cli]") {
  const Workplace place;
  const std::string command = "path point.glb --size 80x60 --spp 8 --quiet -o ";
  REQUIRE(place.run(command + "whole.exr").status == 0);
  for (const std::string part : {"1", "2", "3"})
    REQUIRE(place.run(command + "part" + part + ".exr --part " + part + "/3").status == 0);
  const json merged = place.run_json("merge part2.exr part3.exr part1.exr -o merged.exr");
  CHECK(merged["parts"] == 3);
  CHECK(merged["spp"] == 8);
  const voxref::Image whole = voxref::read_image(place.path("whole.exr"));
  const voxref::Image image = voxref::read_image(place.path("merged.exr"));
  check_same_bits(image, whole);
  CHECK(image.attributes.at("voxref:scene_sha256") == whole.attributes.at("voxref:scene_sha256"));
  CHECK(contains(image.attributes.at("voxref:command_line"), "merge"));

  check_refused(place, "merge part1.exr part3.exr -o out.exr", "part 2/3 is missing");
  check_refused(place, "merge part1.exr part2.exr part1.exr -o out.exr", "part1.exr: part 1/3: is there already");
  check_refused(place, "merge part1.exr whole.exr -o out.exr", "whole.exr: header: is no part");
  REQUIRE(place.run(command + "foreign.exr --part 2/3 --seed 9").status == 0);
  check_refused(place, "merge part1.exr part3.exr foreign.exr -o out.exr", "foreign.exr: path.seed: 9, but 0");
  check_refused(place, "path point.glb -o out.exr --part 0/3", "--part: '0/3'");
  check_refused(place, "path point.glb -o out.exr --part 4/3", "--part: '4/3'");
  check_refused(place, "path point.glb -o out.exr --noise 0.1 --part 1/3", "part: needs a number of samples");
}
