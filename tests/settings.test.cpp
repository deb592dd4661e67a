#include "settings.h"

#include <nlohmann/json.hpp>
#include <set>

#include "catch.h"
#include "error.h"

using nlohmann::json;
using voxref::apply_assignment;
using voxref::apply_json;
using voxref::Settings;

namespace {

/// The message of the Error that `--set assignment` gives; empty when it is accepted.
std::string refusal(const std::string& assignment) {
  Settings settings;
  try {
    apply_assignment(settings, assignment);
  } catch (const voxref::Error& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Settings with_every_parameter_changed() {
  Settings s;
  for (const char* assignment : {"grid.resolution=64",
                                 "voxelize.opacity=coverage",
                                 "shade.shadow=volume",
                                 "mipmap.filter=isotropic",
                                 "bounce.count=3",
                                 "bounce.cones=9",
                                 "cone.diffuse=16",
                                 "cone.step=0.1",
                                 "cone.start=2.5",
                                 "ao.enabled=true",
                                 "ao.falloff=12.5",
                                 "pixel.shadow=cone",
                                 "pixel.shadow_cone.aperture=0.2",
                                 "grid.cubic=true",
                                 "grid.bounds=[[0,1,2],[3.5,4,5]]",
                                 "voxelize.method=raster",
                                 "voxelize.average=running_floor8",
                                 "voxelize.static_wins=true",
                                 "storage=unorm8",
                                 "light.falloff=attenuated",
                                 "light.attenuation=[0.1,0.02,3]",
                                 "shade.position=corner",
                                 "shade.two_sided=false",
                                 "shade.normal_weighted=true",
                                 "shade.normalization=none",
                                 "shade.shadow_hit=0.25",
                                 "bounce.max_distance=0.5",
                                 "cone.opacity=raw",
                                 "cone.max_distance=0.75",
                                 "ao.alpha=0.125",
                                 "pixel.shadow_cone.tolerance=1",
                                 "composite.bounce_strength=3",
                                 "composite.indirect_power=2.5",
                                 "ao.normalized=false",
                                 "ao.skip_black=true",
                                 "cone.box_test=false",
                                 "cone.raw_unit=3",
                                 "gbuffer.color=unorm8",
                                 "gbuffer.cull_back_faces=true",
                                 "gbuffer.decode_textures=false",
                                 "gbuffer.depth=unorm24",
                                 "gbuffer.discard_alpha=0.25",
                                 "gbuffer.geometric_normal=false",
                                 "gbuffer.normal=float16",
                                 "phong.albedo_power=1.5",
                                 "phong.divide_by_pi=false",
                                 "phong.specular_twice=true",
                                 "pixel.brdf=blinn_phong",
                                 "pixel.specular_cone=glossiness"})
    apply_assignment(s, assignment);
  return s;
}

}  // namespace

TEST_CASE("each parameter of the command line reaches its field", "[settings]") {
  const Settings s = with_every_parameter_changed();
  CHECK(s.grid.resolution == 64);
  CHECK(s.voxelize.opacity == voxref::VoxelOpacity::coverage);
  CHECK(s.shade.shadow == voxref::VoxelShadow::volume);
  CHECK(s.mipmap.filter == voxref::MipmapFilter::isotropic);
  CHECK(s.bounce.count == 3);
  CHECK(s.bounce.cones == 9);
  CHECK(s.render.cone.diffuse == 16);
  CHECK(s.render.cone.step == 0.1f);
  CHECK(s.render.cone.start == 2.5f);
  CHECK(s.render.ao.enabled);
  CHECK(s.render.ao.falloff == 12.5f);
  CHECK(s.render.pixel.shadow == voxref::PixelShadow::cone);
  CHECK(s.render.pixel.shadow_cone_aperture == 0.2f);
  CHECK(s.grid.cubic);
  CHECK(s.grid.bounds->min == glm::vec3(0, 1, 2));
  CHECK(s.grid.bounds->max == glm::vec3(3.5f, 4, 5));
  CHECK(s.voxelize.method == voxref::VoxelizeMethod::raster);
  CHECK(s.voxelize.average == voxref::VoxelAverage::running_floor8);
  CHECK(s.voxelize.static_wins);
  CHECK(s.storage == voxref::Storage::unorm8);
  CHECK(s.light.falloff == voxref::LightFalloff::attenuated);
  CHECK(s.light.attenuation == glm::vec3(0.1f, 0.02f, 3.0f));
  CHECK(s.shade.position == voxref::ShadePosition::corner);
  CHECK_FALSE(s.shade.two_sided);
  CHECK(s.shade.normal_weighted);
  CHECK(s.shade.normalization == voxref::ShadeNormalization::none);
  CHECK(s.shade.shadow_hit == 0.25f);
  CHECK(s.bounce.max_distance == 0.5f);
  CHECK(s.render.cone.opacity == voxref::ConeOpacity::raw);
  CHECK(s.render.cone.max_distance == 0.75f);
  CHECK(s.render.ao.alpha == 0.125f);
  CHECK(s.render.pixel.shadow_cone_tolerance == 1.0f);
  CHECK(s.render.composite.bounce_strength == 3.0f);
  CHECK(s.render.composite.indirect_power == 2.5f);
  // Whatever is left at its default here was forgotten above.
  const json changed = to_json(s).flatten(), defaults = to_json(Settings{}).flatten();
  for (const auto& [key, value] : changed.items())
    if (key != "/profile") {
      CAPTURE(key);
      CHECK((!defaults.contains(key) || defaults[key] != value));
    }
}

TEST_CASE("settings written as JSON and read back are the same settings", "[settings]") {
  const Settings original = with_every_parameter_changed();
  const json written = to_json(original);
  Settings read;
  apply_json(read, json::parse(written.dump()));
  CHECK(to_json(read) == written);
  CHECK(to_json(read) != to_json(Settings{}));
  // Written with the decimals that were typed, not with those of the nearest double of a float.
  CHECK(written["cone"]["step"].dump() == "0.1");
}

TEST_CASE("every parameter has a default that it accepts itself, a range and a meaning", "[settings]") {
  std::set<std::string> keys;
  for (const voxref::ParameterHelp& line : voxref::parameter_help()) {
    CAPTURE(line.key);
    CHECK(refusal(line.key + "=" + line.radiometric) == "");
    CHECK(refusal(line.key + "=" + line.villegas2016) == "");
    CHECK(!line.range.empty());
    CHECK(!line.meaning.empty());
    CHECK(keys.insert(line.key).second);
  }
  CHECK(keys.size() == 49);  // the 32 of the specification's table, and what tells the published image apart
}

TEST_CASE("settings nest as the dots of their keys say and take dotted keys too", "[settings]") {
  Settings nested, dotted;
  apply_json(nested, json::parse(R"({"pixel": {"shadow": "none", "shadow_cone": {"aperture": 0.5}}})"));
  apply_json(dotted, json::parse(R"({"pixel.shadow": "none", "pixel.shadow_cone.aperture": 0.5})"));
  CHECK(to_json(nested) == to_json(dotted));
  CHECK(nested.render.pixel.shadow_cone_aperture == 0.5f);
}

TEST_CASE("a settings file that names its profile starts from that profile", "[settings]") {
  Settings settings = with_every_parameter_changed();
  apply_json(settings, json::parse(R"({"profile": "radiometric", "cone": {"step": 0.25}})"));
  Settings expected;
  expected.render.cone.step = 0.25f;
  CHECK(to_json(settings) == to_json(expected));
}

TEST_CASE("an unknown parameter is answered with the nearest one", "[settings]") {
  CHECK(contains(refusal("cone.stepp=1"), "'cone.step'"));
  CHECK(contains(refusal("resolution=64"), "'grid.resolution'"));
  CHECK(contains(refusal("mipmap.filtre=isotropic"), "'mipmap.filter'"));
  Settings settings;
  CHECK_THROWS_AS(apply_json(settings, json::parse(R"({"grid": {"resolutoin": 64}})")), voxref::Error);
}

TEST_CASE("a value out of range is answered with the range", "[settings]") {
  CHECK(contains(refusal("grid.resolution=15"), "16 to 2048"));
  CHECK(contains(refusal("grid.resolution=2049"), "16 to 2048"));
  CHECK(contains(refusal("grid.resolution=99999999999999999999"), "16 to 2048"));
  CHECK(contains(refusal("cone.step=0"), "0.01 to 4"));
  CHECK(contains(refusal("cone.diffuse=0"), "1 to 16384"));
  CHECK(contains(refusal("bounce.count=-1"), "0 to 1000"));
  CHECK(contains(refusal("shade.shadow=soft"), "none, rays, volume"));
  CHECK(contains(refusal("grid.bounds=[[0,0,0],[1,0,1]]"), "minimum lies below"));
  CHECK(refusal("grid.resolution=16") == "");
  CHECK(refusal("grid.resolution=2048") == "");
}

TEST_CASE("a value of the wrong type is refused, not converted", "[settings]") {
  for (const char* wrong : {"grid.resolution=128.5",
                            "grid.resolution=\"128\"",
                            "grid.resolution=true",
                            "cone.step=fast",
                            "cone.step=nan",
                            "cone.step=inf",
                            "cone.step=1e999",
                            "cone.step=",
                            "cone.step=[1]",
                            "cone.step=null",
                            "ao.enabled=1",
                            "ao.enabled=yes",
                            "bounce.count=1.5",
                            "bounce.count=many",
                            "shade.shadow=1",
                            "grid.bounds=1",
                            "grid.bounds=[[0,0,0]]",
                            "grid.bounds=[[0,0,0],[1,1]]",
                            "light.attenuation=[1,2]",
                            "light.attenuation=[1,2,-3]",
                            "cone.diffuse=villegas4",
                            "bounce.cones=villegas6",
                            "cone.max_distance=far",
                            "pixel=none",
                            "cone.step"}) {
    CAPTURE(wrong);
    CHECK(refusal(wrong) != "");
  }
  Settings settings;
  const json not_a_number = {{"cone", {{"step", std::numeric_limits<double>::quiet_NaN()}}}};
  CHECK_THROWS_AS(apply_json(settings, not_a_number), voxref::Error);
  CHECK_THROWS_AS(apply_json(settings, json::array({1})), voxref::Error);
  CHECK_THROWS_AS(apply_json(settings, json::parse(R"({"cone": 1})")), voxref::Error);
}

TEST_CASE("the profile of the published shaders has the values of the specification's table", "[settings]") {
  const json expected = json::parse(R"({
    "profile": "villegas2016", "storage": "unorm8",
    "grid": {"resolution": 256, "cubic": true, "bounds": null},
    "voxelize": {"method": "raster", "average": "running_floor8", "opacity": "occupied", "static_wins": true},
    "light": {"falloff": "attenuated", "attenuation": [0.0, 0.0, 0.0]},
    "shade": {"position": "corner", "normal_weighted": true, "normalization": "none", "shadow": "volume",
              "shadow_hit": 0.5, "two_sided": false},
    "mipmap": {"filter": "anisotropic"},
    "bounce": {"count": 1, "cones": "villegas4", "max_distance": 0.95},
    "cone": {"diffuse": "villegas6", "step": 0.5, "start": 2.0, "opacity": "raw", "max_distance": 0.95,
             "box_test": true, "raw_unit": 2.0},
    "ao": {"enabled": false, "falloff": 800.0, "alpha": 0.0, "normalized": false, "skip_black": true},
    "gbuffer": {"color": "unorm8", "cull_back_faces": true, "decode_textures": false, "depth": "unorm24",
                "discard_alpha": 0.01, "geometric_normal": false, "normal": "float16"},
    "phong": {"albedo_power": 2.2, "divide_by_pi": false, "specular_twice": true},
    "pixel": {"shadow": "cone", "shadow_cone": {"aperture": 0.03, "tolerance": 0.1}, "brdf": "blinn_phong",
              "specular_cone": "glossiness"},
    "composite": {"bounce_strength": 2.0, "indirect_power": 2.2}})");
  CHECK(to_json(voxref::profile("villegas2016")) == expected);
  CHECK_NOTHROW(validate(voxref::profile("villegas2016")));
  CHECK_NOTHROW(validate(voxref::profile("radiometric")));
  CHECK_THROWS_AS(voxref::profile("villegas"), voxref::Error);
  Settings from_file;
  apply_json(from_file, json::parse(R"({"profile": "villegas2016", "cone": {"step": 0.25}})"));
  CHECK(from_file.render.cone.step == 0.25f);
  CHECK(from_file.storage == voxref::Storage::unorm8);
}

TEST_CASE("values that contradict each other are refused by name", "[settings]") {
  const auto contradiction = [](const char* name, const char* assignment) -> std::string {
    Settings settings = voxref::profile(name);
    apply_assignment(settings, assignment);
    try {
      validate(settings);
    } catch (const voxref::Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(contains(contradiction("villegas2016", "grid.cubic=false"), "voxelize.method"));
  CHECK(contains(contradiction("radiometric", "voxelize.method=raster"), "grid.cubic=true"));
  CHECK(contains(contradiction("radiometric", "voxelize.average=running_floor8"), "voxelize.average"));
  CHECK(contains(contradiction("villegas2016", "voxelize.opacity=coverage"), "voxelize.opacity"));
  CHECK(contradiction("villegas2016", "voxelize.average=area") == "");
  CHECK(contradiction("villegas2016", "storage=float32") == "");
  CHECK(contradiction("radiometric", "storage=unorm8") == "");
}

TEST_CASE("the count of bounces is a number or left to the pipeline", "[settings]") {
  Settings settings;
  apply_assignment(settings, "bounce.count=2");
  CHECK(settings.bounce.count == 2);
  apply_assignment(settings, "bounce.count=auto");
  CHECK(!settings.bounce.count.has_value());
}

TEST_CASE("a settings file with one bad value changes nothing", "[settings]") {
  Settings settings;
  CHECK_THROWS_AS(apply_json(settings, json::parse(R"({"cone": {"diffuse": 9, "step": 99}})")), voxref::Error);
  CHECK(to_json(settings) == to_json(Settings{}));
}
