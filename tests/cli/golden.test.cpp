// `voxref golden verify` on the project's own set, and on sets and scenes with planted errors. A missing weight of
// multiple importance sampling cannot be planted from outside the program; that one is tried by hand.
#include "cli/workplace.h"

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
