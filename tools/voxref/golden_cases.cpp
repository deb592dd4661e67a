#include "golden_cases.h"

#include "error.h"

namespace voxref {

namespace {

GoldenCase path_case(const std::string& scene) { return {"path_" + scene, GoldenKind::path, scene + ".glb"}; }

GoldenCase cone_case(const std::string& name, GoldenKind kind, const std::string& scene, const std::string& profile,
                     std::vector<std::string> assignments) {
  return {name, kind, scene + ".glb", profile, std::move(assignments)};
}

std::vector<GoldenCase> all_cases() {
  std::vector<GoldenCase> cases;
  for (const char* scene : {"cornell_box_point", "cornell_box", "glossy_spheres", "light_box", "furnace_50",
                            "plane_test", "red_green_wall", "rectangle_luminaire"})
    cases.push_back(path_case(scene));
  for (GoldenCase& golden : cases) {
    if (golden.scene.starts_with("glossy")) golden.max_depth = 1;  // caustics of a point light are noise
    if (golden.scene.starts_with("light_box") || golden.scene.starts_with("furnace"))
      golden.side = 48;  // closed rooms: long paths, and every pixel alike
  }
  for (const std::string scene : {"cornell_box_point", "cornell_box", "glossy_spheres", "plane_test", "red_green_wall"})
    cases.push_back(cone_case("cone_" + scene, GoldenKind::cone, scene, "radiometric", {"grid.resolution=48"}));
  for (const std::string scene : {"cornell_box_point", "glossy_spheres"})
    cases.push_back(cone_case("villegas2016_" + scene, GoldenKind::cone, scene, "villegas2016",
                              {"grid.resolution=64", "ao.enabled=true"}));
  // A side that is no power of two; all three storages.
  cases.push_back(cone_case("volumes_float32", GoldenKind::volumes, "cornell_box_point", "radiometric",
                            {"grid.resolution=22", "bounce.count=1"}));
  cases.push_back(cone_case("volumes_float16", GoldenKind::volumes, "cornell_box", "radiometric",
                            {"grid.resolution=22", "bounce.count=1", "storage=float16"}));
  cases.push_back(
      cone_case("volumes_unorm8", GoldenKind::volumes, "cornell_box_point", "villegas2016", {"grid.resolution=32"}));
  return cases;
}

}  // namespace

View GoldenCase::view(const Scene& loaded) const {
  View view;
  view.camera = loaded.cameras.at(0);
  view.width = view.height = side;
  return view;
}

Settings GoldenCase::settings() const {
  Settings result = voxref::profile(profile);
  for (const std::string& assignment : assignments) apply_assignment(result, assignment);
  return result;
}

PathOptions GoldenCase::path(uint64_t seed, int spp) const {
  PathOptions options;
  options.spp = spp;
  options.max_depth = max_depth;
  options.seed = seed;
  return options;
}

const std::vector<GoldenCase>& golden_cases() {
  static const std::vector<GoldenCase> cases = all_cases();
  return cases;
}

std::string_view kind_name(GoldenKind kind) {
  return kind == GoldenKind::path ? "path" : kind == GoldenKind::cone ? "cone" : "volumes";
}

nlohmann::json describe(const GoldenCase& golden, const Scene& scene) {
  nlohmann::json json = {{"name", golden.name},
                         {"kind", kind_name(golden.kind)},
                         {"scene", golden.scene},
                         {"scene_sha256", scene.sha256},
                         {"size", {golden.side, golden.side}}};
  if (golden.kind == GoldenKind::path) {
    json["seed"] = golden_seed;
    json["spp"] = golden_spp;
    json["max_depth"] = golden.max_depth ? nlohmann::json(*golden.max_depth) : nlohmann::json();
  } else {
    json["settings"] = to_json(golden.settings());
  }
  return json;
}

std::string instruction_set() {
  std::string features = "x86-64";
  if (__builtin_cpu_supports("avx2")) features += ", AVX2";
  if (__builtin_cpu_supports("fma")) features += ", FMA";
  if (__builtin_cpu_supports("avx512f")) features += ", AVX-512";
  return features;
}

}  // namespace voxref
