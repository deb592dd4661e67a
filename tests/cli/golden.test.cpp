// `voxref golden verify` on the project's own set, and on sets and scenes with planted errors.
#include "cli/workplace.h"
#include "reference/path.h"
#include "scene/caster.h"
#include "scene/gltf.h"

namespace {

const fs::path source = VOXREF_SOURCE_DIR;

/// Copies of the golden set and of the scenes, to be tampered with.
class GoldenCopy {
 public:
  GoldenCopy() {
    fs::copy(source / "golden", place.path("golden"), fs::copy_options::recursive);
    fs::create_directories(place.path("scenes"));
    for (const auto& entry : fs::directory_iterator(source / "scenes"))
      if (entry.path().extension() == ".glb") fs::copy(entry.path(), place.path("scenes") / entry.path().filename());
  }
  /// What verify says of one case. Reasons that only name another hash than the set's are left out.
  json verify(const std::string& name, int status) const {
    const Outcome outcome = place.run("golden verify --case " + name + " -o failed --json");
    INFO(name << "\n" << outcome.err);
    CHECK(outcome.status == status);
    json result = json::parse(outcome.out)["cases"][0];
    json reasons = json::array();
    for (const std::string reason : result["reasons"])
      if (!reason.starts_with("the golden was made with another")) reasons.push_back(reason);
    result["reasons"] = reasons;
    return result;
  }
  void rewrite(const std::string& scene_file, const voxref::Scene& scene) const {
    voxref::write_glb(place.path("scenes") / scene_file, scene, "tampered with");
  }

  Workplace place;
};

}  // namespace

TEST_CASE("The golden set is what both renderers make today", "[cli][golden]") {
  const Workplace place;
  const Outcome outcome = place.run("golden verify '" + (source / "golden").string() + "' -o failed --json");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 0);
  const json result = json::parse(outcome.out);
  CHECK(result["failed"] == 0);
  CHECK(result["cases"].size() >= 15);
  CHECK(!fs::exists(place.path("failed")));
  uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source / "golden"))
    if (entry.is_regular_file()) bytes += entry.file_size();
  CHECK(bytes < 24u * 1024 * 1024);
}

TEST_CASE("A light 1 % too bright fails both renderers' goldens and leaves a report", "[cli][golden]") {
  const GoldenCopy copy;
  voxref::Scene scene = voxref::cornell_box(voxref::CornellLight::point);
  scene.lights[0].intensity *= 1.01f;
  copy.rewrite("cornell_box_point.glb", scene);
  for (const std::string name : {"path_cornell_box_point", "cone_cornell_box_point"}) {
    const json verdict = copy.verify(name, 1);
    CHECK(verdict["verdict"] == "different");
    CHECK(!verdict["reasons"].empty());
    CHECK(fs::exists(copy.place.path("failed") / name / "report.html"));
    CHECK(fs::exists(copy.place.path("failed") / name / "difference.png"));
  }
}

TEST_CASE("One material's albedo off by 2 % fails both renderers' goldens", "[cli][golden]") {
  const GoldenCopy copy;
  voxref::Scene scene = voxref::cornell_box(voxref::CornellLight::point);
  const auto green = std::ranges::find_if(scene.materials, [](const voxref::Material& m) { return m.name == "green"; });
  REQUIRE(green != scene.materials.end());
  green->base_color *= glm::vec4(0.98f, 0.98f, 0.98f, 1.0f);
  copy.rewrite("cornell_box_point.glb", scene);
  for (const char* name : {"path_cornell_box_point", "cone_cornell_box_point"})
    CHECK(!copy.verify(name, 1)["reasons"].empty());
}

TEST_CASE("Swapped faces of the mipmaps fail the golden volumes, and are named", "[cli][golden]") {
  const GoldenCopy copy;
  const fs::path volumes = copy.place.path("golden") / "volumes_unorm8";
  for (int level = 0; level < 5; ++level)
    for (const std::string kind : {"aniso_", "aniso_bounce_"}) {
      const fs::path neg = volumes / (kind + "neg_x_" + std::to_string(level) + ".npy"),
                     pos = volumes / (kind + "pos_x_" + std::to_string(level) + ".npy"), aside = volumes / "aside";
      fs::rename(neg, aside);
      fs::rename(pos, neg);
      fs::rename(aside, pos);
    }
  const json verdict = copy.verify("volumes_unorm8", 1);
  CHECK(verdict["reasons"].dump().find("faces in another order") != std::string::npos);
  CHECK(fs::exists(copy.place.path("failed") / "volumes_unorm8" / "aniso_neg_x_0.png"));
}

TEST_CASE("A shift by half a voxel fails the golden volumes", "[cli][golden]") {
  const GoldenCopy copy;
  const fs::path volumes = copy.place.path("golden") / "volumes_unorm8";
  const json bounds = json::parse(voxref::read_file(volumes / "volumes.json"))["bounds"];
  const double half = 0.5 * (bounds[1][0].get<double>() - bounds[0][0].get<double>()) / 32;
  json shifted = bounds;
  for (auto& corner : shifted)
    for (auto& coordinate : corner) coordinate = coordinate.get<double>() + half;
  voxref::write_text(copy.place.path("shifted.json"),
                     json{{"profile", "villegas2016"}, {"grid", {{"resolution", 32}, {"bounds", shifted}}}}.dump());
  const Outcome made = copy.place.run(
      "cone scenes/cornell_box_point.glb --config shifted.json --volumes shifted --size 1x1 -o o.exr --quiet");
  INFO(made.err);
  REQUIRE(made.status == 0);
  for (const char* volume : {"albedo.npy", "radiance.npy"})
    fs::copy(copy.place.path("shifted") / volume, volumes / volume, fs::copy_options::overwrite_existing);
  const json verdict = copy.verify("volumes_unorm8", 1);
  CHECK(verdict["reasons"].dump().find("albedo") != std::string::npos);
}

TEST_CASE("A missing weight of multiple importance sampling fails the path-traced golden", "[cli][golden]") {
  // Each path that ends on a lamp can be found in two ways, by sampling the lamp and by meeting it; the weights of both
  // add up to one. Without them it counts twice, but for the light that comes straight from lamp to camera, which only
  // one way finds. So the mean of a renderer without weights is E + 2 (L - E), L being the image and E the emission of
  // max_depth 0; its error is twice that of L - E. With one weight left out it lies between that and L.
  const GoldenCopy copy;
  const fs::path file = copy.place.path("golden") / "path_cornell_box.exr";
  voxref::Image golden = voxref::read_image(file);
  const voxref::Scene scene = voxref::load_gltf(copy.place.path("scenes") / "cornell_box.glb");
  voxref::View view;
  view.camera = scene.cameras.at(0);
  view.width = golden.width();
  view.height = golden.height();
  voxref::PathOptions options;
  options.spp = 64;
  options.max_depth = 0;
  const voxref::PathResult emission = voxref::path_trace(scene, voxref::Caster(scene), view, options);
  const voxref::Image right = golden;
  // One weight left out of both, in the mean a half: the lesser error of the two.
  for (const double doubled : {0.5, 1.0}) {
    golden = right;
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = 0; i < golden.pixel_count(); ++i) {
        float& value = golden.layer("")[c][i];
        value += float(doubled) * (value - emission.image.layer("")[c][i]);
        golden.layer("stderr")[c][i] *= float(1.0 + doubled);
      }
    write_exr(file, golden);
    const json verdict = copy.verify("path_cornell_box", 1);
    CHECK(verdict["verdict"] == "different");
    CHECK(verdict["reasons"].dump().find("the image's mean") != std::string::npos);
  }
}

TEST_CASE("A set that was made from something else says so, and a golden of another size ends no run",
          "[cli][golden]") {
  const GoldenCopy copy;
  const fs::path file = copy.place.path("golden") / "golden.json";
  const std::string original = voxref::read_file(file);
  json index = json::parse(original);
  for (json& entry : index["cases"])
    if (entry["name"] == "cone_plane_test") entry["scene_sha256"] = "of another scene";
  voxref::write_text(file, index.dump());
  const Outcome outcome = copy.place.run("golden verify --case cone_plane_test -o failed");
  CHECK(outcome.status == 1);
  CHECK(contains(outcome.out, "the golden was made with another scene_sha256"));
  CHECK(!contains(outcome.out, "pictures and reports"));  // the images agree: there is nothing to show
  CHECK(!fs::exists(copy.place.path("failed")));

  voxref::Image small(8, 8);
  small.add_layer("");
  write_exr(copy.place.path("golden") / "cone_plane_test.exr", small);
  const Outcome resized = copy.place.run("golden verify --case cone_plane_test --case path_plane_test -o failed");
  CHECK(resized.status == 1);
  CHECK(contains(resized.out, "cone_plane_test.exr is 8x8, not 96x96"));
  CHECK(contains(resized.out, "2 cases, 1 failed"));

  index["cases"] = {"cone_plane_test"};
  voxref::write_text(file, index.dump());
  check_refused(copy.place, "golden verify --case cone_plane_test -o failed", "cases[0]: is not an object");
}

TEST_CASE("Making one case anew leaves what the set says of the others", "[cli][golden]") {
  const GoldenCopy copy;
  const fs::path file = copy.place.path("golden") / "golden.json";
  json index = json::parse(voxref::read_file(file));
  for (json& entry : index["cases"])
    if (entry["name"] != "cone_plane_test") entry["scene_sha256"] = "as it was";
  voxref::write_text(file, index.dump());
  fs::remove(copy.place.path("scenes") / "cornell_box.glb");  // nor are others' scenes needed
  REQUIRE(copy.place.run("golden make --case cone_plane_test --quiet").status == 0);
  const json made = json::parse(voxref::read_file(file));
  CHECK(made["cases"] == index["cases"]);
  CHECK(copy.verify("cone_plane_test", 0)["verdict"] == "same");
}

TEST_CASE("golden refuses unknown cases and folders without a set, in one line", "[cli][golden]") {
  const Workplace place;
  for (const char* arguments :
       {"golden verify nowhere", "golden verify --case nothing", "golden unmake", "golden verify --seed 20161"}) {
    INFO(arguments);
    const Outcome refused = place.run(arguments);
    CHECK(refused.status == 2);
    CHECK(std::ranges::count(refused.err, '\n') == 1);
  }
}
