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
  for (const char* assignment :
       {"grid.resolution=64", "voxelize.opacity=coverage", "shade.shadow=volume", "mipmap.filter=isotropic",
        "bounce.count=3", "bounce.cones=9", "cone.diffuse=16", "cone.step=0.1", "cone.start=2.5", "ao.enabled=true",
        "ao.falloff=12.5", "pixel.shadow=cone", "pixel.shadow_cone.aperture=0.2"})
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
    CHECK(refusal(line.key + "=" + line.value) == "");
    CHECK(!line.range.empty());
    CHECK(!line.meaning.empty());
    CHECK(keys.insert(line.key).second);
  }
  CHECK(keys.size() == 32);  // the specification's table
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
  CHECK(refusal("grid.resolution=16") == "");
  CHECK(refusal("grid.resolution=2048") == "");
}

TEST_CASE("a value of the wrong type is refused, not converted", "[settings]") {
  for (const char* wrong :
       {"grid.resolution=128.5", "grid.resolution=\"128\"", "grid.resolution=true", "cone.step=fast", "cone.step=nan",
        "cone.step=inf", "cone.step=1e999", "cone.step=", "cone.step=[1]", "cone.step=null", "ao.enabled=1",
        "ao.enabled=yes", "bounce.count=1.5", "bounce.count=many", "shade.shadow=1", "pixel=none", "cone.step"}) {
    CAPTURE(wrong);
    CHECK(refusal(wrong) != "");
  }
  Settings settings;
  const json not_a_number = {{"cone", {{"step", std::numeric_limits<double>::quiet_NaN()}}}};
  CHECK_THROWS_AS(apply_json(settings, not_a_number), voxref::Error);
  CHECK_THROWS_AS(apply_json(settings, json::array({1})), voxref::Error);
  CHECK_THROWS_AS(apply_json(settings, json::parse(R"({"cone": 1})")), voxref::Error);
}

TEST_CASE("a value that this pipeline does not have is refused with what is available", "[settings]") {
  CHECK(contains(refusal("voxelize.method=raster"), "only \"exact\""));
  CHECK(contains(refusal("storage=unorm8"), "only \"float32\""));
  CHECK(contains(refusal("grid.cubic=true"), "only false"));
  CHECK(contains(refusal("composite.indirect_power=2.2"), "only 1"));
  CHECK(refusal("composite.indirect_power=1.0") == "");
  CHECK_THROWS_AS(voxref::profile("villegas2016"), voxref::Error);
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
