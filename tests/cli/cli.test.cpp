#include <algorithm>

#include "cli/workplace.h"

namespace {

bool has_keys(const json& object, const std::vector<std::string>& keys) {
  return std::all_of(keys.begin(), keys.end(), [&](const std::string& key) { return object.contains(key); });
}

const std::vector<std::string> path_keys = {"mean", "mean_stderr",     "spp",      "seconds",
                                            "rays", "rays_per_second", "nonfinite"};
const std::vector<std::string> cone_keys = {"mean", "seconds", "bytes", "voxels_occupied", "grid", "nonfinite"};
const std::string small_cone = " --size 12x10 --set grid.resolution=24 --set bounce.count=1 ";

}  // namespace

TEST_CASE("every command has help with an example", "[cli]") {
  const Workplace place;
  for (const char* command : {"", "info", "path", "merge", "cone", "check", "stage", "study", "plan", "bench"}) {
    const Outcome outcome = place.run(std::string(command) + " --help");
    CAPTURE(command);
    CHECK(outcome.status == 0);
    CHECK(outcome.err == "");
    CHECK(contains(outcome.out, "Example"));
    CHECK(contains(outcome.out, std::string("voxref ") + command));
  }
  for (const std::string command : {"path", "cone", "check"})
    CHECK(contains(place.run(command + " --help").out, "Ctrl-C"));
  CHECK(place.run("--version").out == "voxref 0.1.0\n");
}

TEST_CASE("a bad scene file is refused in one line", "[cli]") {
  const Workplace place;
  fs::copy_file(place.path("point.glb"), place.path("truncated.glb"));
  fs::resize_file(place.path("truncated.glb"), fs::file_size(place.path("point.glb")) / 2);
  voxref::write_text(place.path("text.glb"), "this is a poem, not a scene\n");
  for (const std::string command : {"info ", "path -o out.exr ", "cone -o out.exr ", "check -o out "}) {
    check_refused(place, command + "missing.glb", "missing.glb");
    check_refused(place, command + "truncated.glb", "truncated.glb");
    check_refused(place, command + "text.glb", "text.glb");
  }
  check_refused(place, "bench missing.glb", "missing.glb");
  check_refused(place, "bench point.glb --seconds 0.05 --rounds 1 --set grid.bounds=[[9,9,9],[10,10,10]]", "no voxel");
}

TEST_CASE("a bad command line is refused in one line that names the flag", "[cli]") {
  const Workplace place;
  check_refused(place, "", "command: none given");
  check_refused(place, "dance", "'dance'");
  check_refused(place, "--frobnicate", "--frobnicate: unknown flag");
  check_refused(place, "path", "SCENE");
  check_refused(place, "path point.glb", "-o");
  check_refused(place, "path point.glb second.glb -o out.exr", "second.glb");
  check_refused(place, "path point.glb -o out.exr --frobnicate", "--frobnicate: unknown flag");
  check_refused(place, "path point.glb -o out.exr --frobnicate=3", "--frobnicate: unknown flag");
  check_refused(place, "path point.glb -o out.exr --spp", "--spp: needs a value");
  check_refused(place, "path point.glb -o out.exr --spp 1 --spp 2", "--spp: given more than once");
  check_refused(place, "path point.glb -o --json", "-o: ");
  for (const std::string goal : {"--noise 0.1", "--time 1"})
    check_refused(place, "path point.glb -o out.exr --randomizations 1 " + goal, "--randomizations: not with");
  for (const std::string size : {"0x0", "16x0", "-4x4", "16x16x16", "1e2x4", "65537x1", "65536x65536"})
    check_refused(place, "path point.glb -o out.exr --size " + size, "--size: ");
  for (const std::string value : {"--spp 0", "--spp 1.5", "--noise nan", "--time inf", "--max-depth -1", "--seed 1x",
                                  "--threads 0", "--light-scale -1", "--pixel corner", "--yfov 180", "--background 1,2",
                                  "--background -1,0,0", "--camera nobody", "--camera 99", "--eye 1,2,3", "--up 0,1,0"})
    check_refused(place, "path point.glb -o out.exr " + value, "--");
  check_refused(place, "cone point.glb -o out.exr --profile villegas", "--profile: ");
  check_refused(place, "cone point.glb -o out.exr --set voxelize.method=raster", "grid.cubic=true");
  check_refused(place, "cone point.glb -o out.exr --set cone.stepp=1", "cone.step");
  check_refused(place, "cone point.glb -o out.exr --set grid.resolution=8", "16 to 2048");
  check_refused(place, "cone point.glb -o out.exr --config missing.json", "missing.json");
  check_refused(place, "check point.glb -o out --budget much", "--budget: ");
  check_refused(place, "stage melt --from point -o out", "'melt'");
  check_refused(place, "stage mipmap --from missing -o out", "missing");
  check_refused(place, "stage shade --from missing -o out", "missing");
}

TEST_CASE("a settings file is refused with its name and what is wrong in it", "[cli]") {
  const Workplace place;
  voxref::write_text(place.path("broken.json"), "{\"cone\": ");
  voxref::write_text(place.path("unknown.json"), R"({"cone": {"steps": 1}})");
  check_refused(place, "cone point.glb -o out.exr --config broken.json", "broken.json: ");
  check_refused(place, "cone point.glb -o out.exr --config unknown.json", "unknown.json: cone.steps: ");
}

TEST_CASE("an output that cannot be written is refused before any work", "[cli]") {
  const Workplace place;
  fs::create_directory(place.path("folder"));
  voxref::write_text(place.path("file"), "");
  for (const std::string command : {"path", "cone"}) {
    check_refused(place, command + " point.glb -o nowhere/out.exr", "nowhere");
    check_refused(place, command + " point.glb -o folder", "folder");
    check_refused(place, command + " point.glb -o file/out.exr", "file");
  }
  check_refused(place, "check point.glb -o file", "file");
  check_refused(place, "check point.glb -o file/deeper", "file");
  check_refused(place, "cone point.glb -o out.exr --volumes file", "file");
  check_refused(place, "stage mipmap --from folder -o file", "file");
}

TEST_CASE("a sun from the command line lights a scene of its own or beside the file's lights", "[cli]") {
  const Workplace place;
  voxref::write_glb(place.path("plane.glb"), voxref::point_light_over_plane(), "for the tests");
  const std::string view =
      " --eye 0,2,0 --target 0,0,0 --up 0,0,-1 --yfov 20 --size 6x4 --spp 4 --max-depth 1 -o x.exr ";
  // Albedo 0.5 under irradiance 3 cos 60 degrees and twice that; the point light's part is the same in both.
  const json alone = place.run_json("path plane.glb" + view);
  const json one = place.run_json("path plane.glb --sun 0,-1,1.7320508,3,3,3" + view);
  const json two = place.run_json("path plane.glb --sun 0,-1,1.7320508,3,3,3 --sun 0,-2,3.4641016,3,3,3" + view);
  for (size_t c = 0; c < 3; ++c) {
    const double added = 0.5 / 3.14159265 * 3.0 * 0.5;
    // Float rounding of directions and radiance; between unoccluded lights of one colour the choice has no noise.
    CHECK(double(one["mean"][c]) - double(alone["mean"][c]) == Approx(added).epsilon(1e-4));
    CHECK(double(two["mean"][c]) - double(alone["mean"][c]) == Approx(2.0 * added).epsilon(1e-4));
  }
  check_refused(place, "path plane.glb --sun 0,0,0,1,1,1 -o y.exr", "--sun");
  check_refused(place, "path plane.glb --sun 0,-1,0 -o y.exr", "--sun");
  check_refused(place, "path plane.glb --sun 0,-1,0,1,1,-1 -o y.exr", "--sun");
}

TEST_CASE("with --json a command prints one object with the keys that scripts read", "[cli]") {
  const Workplace place;
  const json info = place.run_json("info point.glb");
  CHECK(info["triangles"] > 0);
  CHECK(info["lights"].size() == 1);
  CHECK(info["volumes"].size() == 4);
  for (const json& volume : info["volumes"]) {
    size_t sum = 0;
    for (const auto& [name, bytes] : volume["bytes"].items())
      if (name != "total" && name != "visibility") sum += bytes.get<size_t>();  // which bounces do not need
    CHECK(volume["bytes"]["total"] == sum);
  }
  const json with_own = place.run_json("info point.glb --set grid.resolution=96")["volumes"];
  REQUIRE(with_own.size() == 5);
  CHECK(with_own[1]["resolution"] == 96);

  const json path = place.run_json("path point.glb -o path.exr --spp 4" + small_view);
  CHECK(has_keys(path, path_keys));
  CHECK(path["spp"] == 4);
  CHECK(path["rays"] >= 12 * 10 * 4);

  const json cone = place.run_json("cone point.glb -o cone.exr" + small_cone);
  CHECK(has_keys(cone, cone_keys));
  CHECK(has_keys(cone["seconds"], {"voxelize", "shade", "mipmap", "bounce", "prepare", "cone_trace", "total"}));
  CHECK(cone["bytes"].contains("total"));
  CHECK(cone["grid"].size() == 3);

  const json check = place.run_json("check point.glb -o checked --spp 4" + small_cone);
  CHECK(has_keys(check["path"], path_keys));
  CHECK(has_keys(check["cone"], cone_keys));
  CHECK(has_keys(check["metrics"], {"mean_ratio", "rel_error", "rmse", "relmse", "relmse_formula", "psnr", "ssim",
                                    "flip", "noise_share"}));
  CHECK(check["within_budget"].is_null());
  CHECK(fs::exists(place.path("checked/report.html")));
  CHECK(json::parse(voxref::read_file(place.path("checked/result.json")))["metrics"] == check["metrics"]);

  const json bench = place.run_json("bench point.glb --rounds 2 --seconds 0.05" + small_cone);
  CHECK(bench["scenes"].size() == 1);
  CHECK(bench["scenes"][0]["ratio"]["min"] <= bench["scenes"][0]["ratio"]["max"]);
  CHECK(bench["scenes"][0]["ratio"]["min"] > 0);
  const json mesh = place.run_json("bench point.glb --mesh --rounds 1 --seconds 0.05" + small_cone);
  CHECK(mesh["scenes"][0]["scene"] == "point.glb with a mesh");
  const json& stages = bench["scenes"][0]["stages"];
  REQUIRE(stages.size() == 6);
  for (const json& stage : stages) CHECK(stage["count"] > 0);
  CHECK(stages[5]["count"] == 6 * 10 * 10);  // the box, which has no gloss, fills all but the outer columns
  REQUIRE(bench["scenes"][0]["lookups"].size() == 4);
  for (const json& lookup : bench["scenes"][0]["lookups"]) CHECK(lookup["nanoseconds"] > 0);
  CHECK(bench["triad_bytes_per_second"] > 0);
}

TEST_CASE("an error beyond the budget ends check with 1, one within it with 0", "[cli]") {
  const Workplace place;
  const std::string command = "check point.glb -o out --quiet --spp 4" + small_cone;
  CHECK(place.run(command + "--budget 1e6").status == 0);
  // Four samples of a box of 24 voxels never agree to a billionth.
  CHECK(place.run(command + "--budget 1e-9").status == 1);
}

TEST_CASE("with --quiet a command says nothing, and without it the summary goes to stdout", "[cli]") {
  const Workplace place;
  const Outcome quiet = place.run("path point.glb -o out.exr --spp 1 --quiet" + small_view);
  CHECK(quiet.status == 0);
  CHECK(quiet.out == "");
  CHECK(quiet.err == "");
  const Outcome usual = place.run("path point.glb -o out.exr --spp 1" + small_view);
  CHECK(contains(usual.out, "out.exr"));
  CHECK(usual.err == "");
}

TEST_CASE("one thread and two write the same pixels", "[cli]") {
  const Workplace place;
  for (const std::string command :
       {"path point.glb --spp 8 --size 48x40", "cone point.glb --size 48x40 --set grid.resolution=32"}) {
    CAPTURE(command);
    REQUIRE(place.run(command + " --threads 1 -o one.exr").status == 0);
    REQUIRE(place.run(command + " --threads 2 -o two.exr").status == 0);
    check_same_bits(voxref::read_image(place.path("one.exr")), voxref::read_image(place.path("two.exr")));
  }
}

TEST_CASE("an image's header says where it comes from", "[cli]") {
  const Workplace place;
  REQUIRE(place.run("path point.glb -o path.exr --spp 2 --seed 7" + small_view).status == 0);
  const auto header = voxref::read_image(place.path("path.exr")).attributes;
  const auto value = [&](const std::string& key) {
    const auto found = header.find("voxref:" + key);
    return found == header.end() ? "(none)" : found->second;
  };
  CHECK(value("version") == "0.1.0");
  CHECK(value("seed") == "7");
  CHECK(json::parse(value("path")) == json({{"spp", 2},
                                            {"randomizations", 16},
                                            {"noise", nullptr},
                                            {"time", nullptr},
                                            {"max_depth", nullptr},
                                            {"energy_compensation", false},
                                            {"seed", 7},
                                            {"bounces", 0},
                                            {"irradiance", false}}));
  CHECK(value("spp") == "2");
  CHECK(contains(value("command_line"), "--seed 7"));
  const std::string bytes = voxref::read_file(place.path("point.glb"));
  CHECK(value("scene_sha256") == voxref::sha256(std::as_bytes(std::span(bytes))));
  CHECK(json::parse(value("camera"))["size"] == json({12, 10}));
  CHECK(contains(value("libraries"), "Embree"));

  REQUIRE(place.run("path point.glb -o open.exr --noise 0.5 --time 100 --max-depth 3" + small_view).status == 0);
  const json open = json::parse(voxref::read_image(place.path("open.exr")).attributes.at("voxref:path"));
  CHECK(open["spp"].is_null());
  CHECK(open["noise"] == 0.5);
  CHECK(open["time"] == 100.0);
  CHECK(open["max_depth"] == 3);

  REQUIRE(place.run("cone point.glb -o cone.exr" + small_cone).status == 0);
  const auto cone_header = voxref::read_image(place.path("cone.exr")).attributes;
  CHECK(json::parse(cone_header.at("voxref:settings"))["grid"]["resolution"] == 24);
}

TEST_CASE("bounces and irradiance are layers for who asks", "[cli]") {
  const Workplace place;
  REQUIRE(place.run("path point.glb -o path.exr --spp 2 --bounces 2 --irradiance" + small_view).status == 0);
  const voxref::Image image = voxref::read_image(place.path("path.exr"));
  CHECK(image.has_layer("bounce.1"));
  CHECK(image.has_layer("bounce.2"));
  CHECK(!image.has_layer("bounce.3"));
  CHECK(image.has_layer("irradiance"));
  check_refused(place, "path point.glb -o out.exr --bounces 0", "--bounces");
}

TEST_CASE("a scene without triangles renders its background", "[cli]") {
  const Workplace place;
  const json expected = {0.5, 0.25, 0.125};
  const std::string view = " empty.gltf --size 6x4 --background 0.5,0.25,0.125 ";
  CHECK(place.run_json("path -o path.exr --spp 2" + view)["mean"] == expected);
  CHECK(place.run_json("cone -o cone.exr --set grid.resolution=16" + view)["mean"] == expected);
  const json check = place.run_json("check -o out --spp 2 --set grid.resolution=16" + view);
  CHECK(check["path"]["mean"] == expected);
  CHECK(check["cone"]["mean"] == expected);
  CHECK(place.run("info empty.gltf").status == 0);
}

TEST_CASE("stages run on written volumes give what the whole pipeline gave", "[cli]") {
  const Workplace place;
  REQUIRE(place.run("cone point.glb -o cone.exr --volumes volumes" + small_cone).status == 0);
  const auto same_file = [&](const std::string& stage, const std::string& volume) {
    CAPTURE(stage, volume);
    CHECK(voxref::read_file(place.path(stage + "/" + volume)) == voxref::read_file(place.path("volumes/" + volume)));
  };
  REQUIRE(place.run("stage shade --from volumes point.glb -o shaded").status == 0);
  same_file("shaded", "radiance.npy");
  REQUIRE(place.run("stage mipmap --from volumes -o filtered").status == 0);
  same_file("filtered", "aniso_neg_x_0.npy");
  same_file("filtered", "aniso_bounce_pos_z_1.npy");
  REQUIRE(place.run("stage bounce --from volumes -o bounced --set bounce.count=1").status == 0);
  same_file("bounced", "radiance_bounce.npy");
  REQUIRE(place.run("stage gather --from volumes point.glb -o gathered" + small_view).status == 0);
  check_same_bits(voxref::read_image(place.path("gathered/gather.exr")), voxref::read_image(place.path("cone.exr")));
}

TEST_CASE("an interrupted path tracer writes the samples it has and ends with 1", "[cli]") {
  const Workplace place;
  // SIGINT after two seconds: time for the program to start and take samples even under a sanitizer on a busy machine.
  const Outcome outcome =
      place.run("path point.glb -o out.exr --time 1000 --json" + small_view, "timeout --preserve-status -s INT 2");
  INFO(outcome.err);
  CHECK(outcome.status == 1);
  CHECK(contains(outcome.err, "interrupted"));
  const json result = json::parse(outcome.out);
  const int spp = result["spp"].get<int>();
  CHECK(spp > 0);
  CHECK(result["seconds"] < 100);
  CHECK(voxref::read_image(place.path("out.exr")).channel("samples")[0] == static_cast<float>(spp));
}

TEST_CASE("an interrupted cone tracer writes nothing and ends with 2", "[cli]") {
  const Workplace place;
  const Outcome outcome =
      place.run("cone point.glb -o out.exr --volumes new/volumes --quiet --set bounce.count=1000 --set bounce.cones=64",
                "timeout --preserve-status -s INT 2");
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(contains(outcome.err, "interrupted"));
  CHECK(!fs::exists(place.path("out.exr")));
  CHECK(!fs::exists(place.path("new")));
}
