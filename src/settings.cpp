#include "settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "error.h"
#include "printable.h"
#include "settings_table.h"

namespace voxref {

namespace {

using nlohmann::json;

/// Levenshtein's: insertions, deletions and replacements that turn one into the other.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

const Parameter& find_parameter(const std::string& key) {
  const auto nearer = [&](const Parameter& a, const Parameter& b) {
    return edit_distance(a.key, key) < edit_distance(b.key, key);
  };
  const auto nearest = std::min_element(parameters().begin(), parameters().end(), nearer);
  if (nearest->key != key) throw Error(printable(key), "unknown parameter; the nearest is '" + nearest->key + "'");
  return *nearest;
}

bool is_group(const std::string& key) {
  return std::any_of(parameters().begin(), parameters().end(),
                     [&](const Parameter& p) { return p.key.compare(0, key.size() + 1, key + ".") == 0; });
}

void apply_group(Settings& settings, const json& group, const std::string& prefix) {
  for (const auto& [name, value] : group.items()) {
    const std::string key = prefix + name;
    if (is_group(key)) {
      if (!value.is_object()) refuse(key, value, "a group of parameters, {...}");
      apply_group(settings, value, key + ".");
    } else {
      find_parameter(key).set(settings, value);
    }
  }
}

/// The place in nested objects that the dots of `key` name.
json::json_pointer pointer_to(std::string key) {
  std::replace(key.begin(), key.end(), '.', '/');
  return json::json_pointer("/" + key);
}

/// What the published shaders compute: the table of spec.md.
Settings villegas2016() {
  Settings s;
  s.profile = "villegas2016";
  s.grid.cubic = true;
  s.voxelize = {VoxelizeMethod::raster, VoxelAverage::running_floor8, VoxelOpacity::occupied, /*static_wins=*/true};
  s.storage = Storage::unorm8;
  s.light.falloff = LightFalloff::attenuated;
  s.shade.position = ShadePosition::corner;
  s.shade.two_sided = false;
  s.shade.normal_weighted = true;
  s.shade.normalization = ShadeNormalization::none;
  s.shade.shadow = VoxelShadow::volume;
  s.shade.shadow_hit = 0.5f;
  s.bounce.count = 1;
  s.bounce.cones = published_cones;
  s.bounce.max_distance = 0.95f;
  s.render.cone.diffuse = published_cones;
  s.render.cone.start = 2.0f;
  s.render.cone.opacity = ConeOpacity::raw;
  s.render.cone.max_distance = 0.95f;
  s.render.ao.normalized = false;
  s.render.ao.skip_black = true;
  s.render.gbuffer.cull_back_faces = true;
  s.render.gbuffer.discard_alpha = 0.01f;
  s.render.gbuffer.decode_textures = false;
  s.render.gbuffer.geometric_normal = false;
  s.render.gbuffer.normal = NormalFormat::float16;
  s.render.gbuffer.color = ColorFormat::unorm8;
  s.render.gbuffer.depth = DepthFormat::unorm24;
  s.render.pixel.brdf = PixelBrdf::blinn_phong;
  s.render.pixel.phong = {/*divide_by_pi=*/false, /*albedo_power=*/2.2f, /*specular_twice=*/true};
  s.render.pixel.specular_cone = SpecularCone::glossiness;
  s.render.pixel.shadow = PixelShadow::cone;
  s.render.composite = {2.0f, 2.2f};
  return s;
}

}  // namespace

Settings profile(std::string_view name) {
  if (name == "radiometric") return {};
  if (name == "villegas2016") return villegas2016();
  throw Error("profile '" + printable(name) + "' is not available; there are: radiometric, villegas2016");
}

void validate(const Settings& settings) {
  const auto require = [](bool condition, const char* key, const char* why) {
    if (!condition) throw Error(key, why);
  };
  const bool raster = settings.voxelize.method == VoxelizeMethod::raster;
  require(!raster || settings.grid.cubic, "voxelize.method", "raster draws into a cube: it needs grid.cubic=true");
  require(raster || settings.voxelize.average == VoxelAverage::area, "voxelize.average",
          "running_floor8 averages the fragments of voxelize.method=raster");
  require(!raster || settings.voxelize.opacity == VoxelOpacity::occupied, "voxelize.opacity",
          "coverage is known to voxelize.method=exact only");
}

json to_json(const Settings& settings) {
  json result = {{"profile", settings.profile}};
  for (const Parameter& parameter : parameters()) result[pointer_to(parameter.key)] = parameter.get(settings);
  return result;
}

void apply_json(Settings& settings, const json& values) {
  if (!values.is_object()) refuse("settings", values, "an object of parameters, {...}");
  Settings result = settings;  // so that an error leaves the caller's alone
  json own = values;
  if (const auto name = own.find("profile"); name != own.end()) {
    if (!name->is_string()) refuse("profile", *name, "the name of a profile");
    result = profile(name->get<std::string>());
    own.erase(name);
  }
  apply_group(result, own, "");
  settings = result;
}

void apply_assignment(Settings& settings, std::string_view assignment) {
  const size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throw Error("'" + std::string(assignment) + "'", "is not of the form key=value");
  const std::string text(assignment.substr(equals + 1));
  json value = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (value.is_discarded()) value = text;  // words need no quotes on a command line
  find_parameter(std::string(assignment.substr(0, equals))).set(settings, value);
}

std::vector<ParameterHelp> parameter_help() {
  const Settings radiometric = profile("radiometric"), published = profile("villegas2016");
  std::vector<ParameterHelp> lines;
  for (const Parameter& p : parameters())
    lines.push_back({p.key, p.get(radiometric).dump(), p.get(published).dump(), p.range, p.meaning});
  return lines;
}

}  // namespace voxref
