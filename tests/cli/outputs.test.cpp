#include "cli/workplace.h"
#include "compare/report.h"

TEST_CASE("an output that would replace what is read is refused, and that stays", "[cli]") {
  const Workplace place;
  const std::string scene = voxref::read_file(place.path("point.glb"));
  fs::create_directory_symlink(place.path(""), place.path("here"));
  for (const std::string output : {"point.glb", "./point.glb", "here/point.glb"})
    for (const std::string command : {"path", "cone"})
      check_refused(place, command + " point.glb -o " + output, "-o: '" + output + "' is the scene itself");
  check_refused(place, "merge point.glb -o point.glb", "-o: 'point.glb' is one of the parts");
  CHECK(voxref::read_file(place.path("point.glb")) == scene);

  voxref::write_text(place.path("settings.json"), "{}");
  check_refused(place, "cone point.glb -o settings.json --config settings.json", "-o: 'settings.json' is the file of");
  for (const std::string name : {"path.exr", "result.json"}) {
    const std::string input = "out/" + name;
    fs::create_directories(place.path("out"));
    fs::rename(place.path("point.glb"), place.path(input));
    check_refused(place, "check " + input + " -o out/", "is the scene itself");
    fs::rename(place.path(input), place.path("point.glb"));
    fs::rename(place.path("settings.json"), place.path(input));
    check_refused(place, "check point.glb -o out --config " + input, "is the file of --config itself");
    fs::rename(place.path(input), place.path("settings.json"));
  }
  fs::rename(place.path("settings.json"), place.path("out/volumes.json"));
  check_refused(place, "cone point.glb -o x.exr --volumes out --config out/volumes.json", "--volumes: ");
}

TEST_CASE("outputs in each other's way are refused before any work", "[cli]") {
  const Workplace place;
  const std::string small = " --size 12x10 --set grid.resolution=24 --set bounce.count=1";
  for (const std::string volumes : {"x", "x/", "./x", "x/y"})
    check_refused(place, "cone point.glb -o x --volumes " + volumes, "--volumes: '" + volumes + "'");
  check_refused(place, "check point.glb -o x --volumes x/path.exr", "--volumes: ");
  fs::create_directory(place.path("volumes"));
  check_refused(place, "cone point.glb -o volumes/volumes.json --volumes volumes", "--volumes: ");
  check_refused(place, "cone point.glb -o volumes/albedo.npy --volumes volumes", "--volumes: ");
  for (const std::string output : {"volumes", "volumes/", "x/../volumes"})
    check_refused(place, "stage mipmap --from volumes -o " + output, "-o: '" + output + "' is the folder of --from");
  CHECK(place.run("cone point.glb -o volumes/cone.exr --volumes volumes --quiet" + small).status == 0);
  CHECK(place.run("check point.glb -o both --volumes both --quiet --spp 1" + small).status == 0);
  std::set<std::string> written;
  for (const auto& entry : fs::directory_iterator(place.path("both")))
    if (entry.path().extension() != ".npy") written.insert(entry.path().filename().string());
  std::set<std::string> expected(voxref::check_files.begin(), voxref::check_files.end());
  expected.insert("volumes.json");
  CHECK(written == expected);
}
