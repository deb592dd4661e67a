// Every parameter once, in one table, which serves defaults, files, --set and the help alike.
#include "settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "error.h"

namespace voxref {

namespace {

using nlohmann::json;

struct Parameter {
  std::string key, range, meaning;
  std::function<json(const Settings&)> get;
  std::function<void(Settings&, const json&)> set;  // throws Error when the value does not fit
};

[[noreturn]] void refuse(const std::string& key, const json& value, const std::string& expected) {
  throw Error(key, value.dump() + " is not " + expected);
}

/// The double with the float's shortest decimals: 0.03f is written 0.03, not 0.029999999329447746.
double with_shortest_decimals(float value) { return std::stod(fmt::format("{}", value)); }

// In the builders below, `field` maps Settings& to the member's reference, const or not.

template <class Field>
Parameter integer(std::string key, int low, int high, std::string meaning, Field field) {
  const std::string range = fmt::format("{} to {}", low, high);
  return {key, range, std::move(meaning), [field](const Settings& s) { return json(field(s)); },
          [=](Settings& s, const json& value) {
            if (!value.is_number_integer()) refuse(key, value, "an integer, " + range);
            const double number =
                value.get<double>();  // also holds integers beyond int64, which the JSON parser admits
            if (number < low || number > high) refuse(key, value, "in the range " + range);
            field(s) = value.get<int>();
          }};
}

template <class Field>
Parameter number(std::string key, float low, float high, std::string meaning, Field field) {
  const std::string range = fmt::format("{} to {}", low, high);
  return {key, range, std::move(meaning), [field](const Settings& s) { return json(with_shortest_decimals(field(s))); },
          [=](Settings& s, const json& value) {
            if (!value.is_number()) refuse(key, value, "a number, " + range);
            const float number = value.get<float>();
            if (!(number >= low && number <= high)) refuse(key, value, "in the range " + range);
            field(s) = number;
          }};
}

template <class Field>
Parameter flag(std::string key, std::string meaning, Field field) {
  return {key, "true, false", std::move(meaning), [field](const Settings& s) { return json(field(s)); },
          [=](Settings& s, const json& value) {
            if (!value.is_boolean()) refuse(key, value, "true or false");
            field(s) = value.get<bool>();
          }};
}

/// An enumeration whose values are 0, 1, 2 ... in the order of `names`.
template <class Field>
Parameter choice(std::string key, std::vector<std::string> names, std::string meaning, Field field) {
  const std::string range = fmt::format("{}", fmt::join(names, ", "));
  return {key, range, std::move(meaning), [=](const Settings& s) { return json(names[static_cast<size_t>(field(s))]); },
          [=](Settings& s, const json& value) {
            const auto found = std::find(names.begin(), names.end(), value);
            if (found == names.end()) refuse(key, value, "one of " + range);
            using Enum = std::remove_reference_t<decltype(field(s))>;
            field(s) = static_cast<Enum>(found - names.begin());
          }};
}

Parameter bounce_count() {
  const Parameter counted = integer(
      "bounce.count", 0, 1000, "", [](auto& s) -> auto& { return *s.bounce.count; });
  return {counted.key, "\"auto\", " + counted.range,
          "bounces at the voxels; auto: until one adds less than 1 %, which leaves out at most gain / (1 - gain) % of "
          "the light",
          [](const Settings& s) { return s.bounce.count ? json(*s.bounce.count) : json("auto"); },
          [counted](Settings& s, const json& value) {
            std::optional<int> count;
            if (value != "auto") {
              if (!value.is_number_integer()) refuse(counted.key, value, "\"auto\" or an integer, " + counted.range);
              Settings parsed = s;
              parsed.bounce.count = 0;
              counted.set(parsed, value);
              count = parsed.bounce.count;
            }
            s.bounce.count = count;
          }};
}

/// A parameter of the specification of which this pipeline has one value.
Parameter fixed(const std::string& key, const json& only, std::string meaning) {
  const std::string range = "only " + only.dump();
  return {key, range, std::move(meaning), [only](const Settings&) { return only; },
          [=](Settings&, const json& value) {
            if (value != only) throw Error(key, value.dump() + " is not available; " + range + " is");
          }};
}

std::vector<Parameter> make_parameters() {
  // Cone sets have 1 to 16384 cones (partition_hemisphere); steps of 0.01 to 4 are march()'s.
  constexpr int most_cones = 16384;
  return {
      integer(
          "grid.resolution", 16, 2048, "voxels along the longest side",
          [](auto& s) -> auto& { return s.grid.resolution; }),
      fixed("grid.cubic", false, "a cube from the scene's minimum corner instead of a fitted box"),
      fixed("grid.bounds", nullptr, "box that overrides the scene's own"),
      fixed("voxelize.method", "exact", "how triangles become voxels"),
      fixed("voxelize.average", "area", "what weighs the pieces of surface in a voxel"),
      choice(
          "voxelize.opacity", {"occupied", "coverage"}, "opacity of a voxel with surface: 1, or projected coverage",
          [](auto& s) -> auto& { return s.voxelize.opacity; }),
      fixed("voxelize.static_wins", false, "dynamic surfaces never overwrite static voxels"),
      fixed("storage", "float32", "number format of the volumes"),
      fixed("light.falloff", "inverse_square", "of point and spot lights"),
      fixed("light.attenuation", nullptr, "coefficients of the attenuated falloff"),
      fixed("shade.position", "centroid", "where in the voxel light arrives"),
      fixed("shade.normal_weighted", false, "attenuation weighted by the normal's axes instead of Lambert's cosine"),
      fixed("shade.normalization", "lambert", "albedo over pi"),
      choice(
          "shade.shadow", {"none", "rays", "volume"}, "shadows at the voxels",
          [](auto& s) -> auto& { return s.shade.shadow; }),
      fixed("shade.shadow_hit", nullptr, "opacity of a hit of the marched shadow"),
      choice(
          "mipmap.filter", {"anisotropic", "isotropic"}, "directional volumes, or one plain mean",
          [](auto& s) -> auto& { return s.mipmap.filter; }),
      bounce_count(),
      integer(
          "bounce.cones", 1, most_cones, "cones over the hemisphere of each voxel",
          [](auto& s) -> auto& { return s.bounce.cones; }),
      fixed("bounce.max_distance", nullptr, "cut-off of a bounce's cones"),
      integer(
          "cone.diffuse", 1, most_cones, "cones over the hemisphere of each pixel",
          [](auto& s) -> auto& { return s.render.cone.diffuse; }),
      number(
          "cone.step", 0.01f, 4.0f, "step length in cone diameters",
          [](auto& s) -> auto& { return s.render.cone.step; }),
      number(
          "cone.start", 0.0f, 16.0f, "voxels from the surface to a cone's apex",
          [](auto& s) -> auto& { return s.render.cone.start; }),
      fixed("cone.opacity", "extinction", "what is interpolated between texels"),
      fixed("cone.max_distance", nullptr, "cut-off of a pixel's cones"),
      flag(
          "ao.enabled", "ambient occlusion in the channel ao.Y", [](auto& s) -> auto& { return s.render.ao.enabled; }),
      number(
          "ao.falloff", 0.0f, 1e6f, "how fast occlusion fades with distance",
          [](auto& s) -> auto& { return s.render.ao.falloff; }),
      fixed("ao.alpha", 0, "added to the openness"),
      choice(
          "pixel.shadow", {"none", "rays", "cone"}, "shadows of the image's direct light",
          [](auto& s) -> auto& { return s.render.pixel.shadow; }),
      number(
          "pixel.shadow_cone.aperture", 1e-4f, 10.0f, "tangent of the shadow cone's half-angle",
          [](auto& s) -> auto& { return s.render.pixel.shadow_cone_aperture; }),
      fixed("pixel.shadow_cone.tolerance", nullptr, "gain of the shadow cone's opacity"),
      fixed("composite.bounce_strength", 1, "factor on the indirect light"),
      fixed("composite.indirect_power", 1, "exponent on the indirect light"),
  };
}

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> table = make_parameters();
  return table;
}

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
  if (nearest->key != key) throw Error(key, "unknown parameter; the nearest is '" + nearest->key + "'");
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

}  // namespace

Settings profile(std::string_view name) {
  if (name != "radiometric") throw Error("profile '" + std::string(name) + "' is not available; there is: radiometric");
  return {};
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
  const Settings defaults;
  std::vector<ParameterHelp> lines;
  for (const Parameter& parameter : parameters())
    lines.push_back({parameter.key, parameter.get(defaults).dump(), parameter.range, parameter.meaning});
  return lines;
}

}  // namespace voxref
