#include "settings_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "error.h"
#include "printable.h"

namespace voxref {

namespace {

using nlohmann::json;

/// The double with the float's shortest decimals: 0.03f is written 0.03, not 0.029999999329447746.
double with_shortest_decimals(float value) { return std::stod(fmt::format("{}", value)); }

int parse_integer(const std::string& key, const json& value, int low, int high, const std::string& expected) {
  if (!value.is_number_integer()) refuse(key, value, expected);
  const double number = value.get<double>();  // also holds integers beyond int64, which the JSON parser admits
  if (number < low || number > high) refuse(key, value, "in the range " + expected);
  return value.get<int>();
}

float parse_number(const std::string& key, const json& value, float low, float high, const std::string& expected) {
  if (!value.is_number()) refuse(key, value, expected);
  const float number = value.get<float>();
  if (!(number >= low && number <= high)) refuse(key, value, "in the range " + expected);
  return number;
}

glm::vec3 parse_vector(const std::string& key, const json& value, float low, float high, const std::string& expected) {
  if (!value.is_array() || value.size() != 3) refuse(key, value, expected);
  glm::vec3 vector;
  for (int i = 0; i < 3; ++i) vector[i] = parse_number(key, value[size_t(i)], low, high, expected);
  return vector;
}

json to_json(const glm::vec3& v) {
  return {with_shortest_decimals(v.x), with_shortest_decimals(v.y), with_shortest_decimals(v.z)};
}

// In the builders below, `field` maps Settings& to the member's reference, const or not.

template <class Field>
Parameter integer(std::string key, int low, int high, std::string meaning, Field field) {
  const std::string range = fmt::format("{} to {}", low, high);
  return {key, range, std::move(meaning), [field](const Settings& s) { return json(field(s)); },
          [=](Settings& s, const json& value) { field(s) = parse_integer(key, value, low, high, range); }};
}

template <class Field>
Parameter number(std::string key, float low, float high, std::string meaning, Field field) {
  const std::string range = fmt::format("{} to {}", low, high);
  return {key, range, std::move(meaning), [field](const Settings& s) { return json(with_shortest_decimals(field(s))); },
          [=](Settings& s, const json& value) { field(s) = parse_number(key, value, low, high, range); }};
}

/// A number, or null for an empty std::optional.
template <class Field>
Parameter optional_number(std::string key, float low, float high, std::string meaning, Field field) {
  const std::string range = fmt::format("null, {} to {}", low, high);
  return {key, range, std::move(meaning),
          [field](const Settings& s) { return field(s) ? json(with_shortest_decimals(*field(s))) : json(); },
          [=](Settings& s, const json& value) {
            if (value.is_null())
              field(s).reset();
            else
              field(s) = parse_number(key, value, low, high, range);
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

/// A count of cones, or the name of the published shaders' own set.
template <class Field>
Parameter cone_count(std::string key, const std::string& published, std::string meaning, Field field) {
  const std::string range = fmt::format("1 to {}, {}", most_cones, published);
  return {key, range, std::move(meaning),
          [=](const Settings& s) { return field(s) == published_cones ? json(published) : json(field(s)); },
          [=](Settings& s, const json& value) {
            field(s) = value == published ? published_cones : parse_integer(key, value, 1, most_cones, range);
          }};
}

Parameter bounce_count() {
  const std::string key = "bounce.count", range = "\"auto\", 0 to 1000";
  return {key, range,
          "bounces at the voxels; auto: until one adds less than 1 %, which leaves out at most gain / (1 - gain) % of "
          "the light",
          [](const Settings& s) { return s.bounce.count ? json(*s.bounce.count) : json("auto"); },
          [=](Settings& s, const json& value) {
            if (value == "auto")
              s.bounce.count.reset();
            else
              s.bounce.count = parse_integer(key, value, 0, 1000, range);
          }};
}

Parameter grid_bounds() {
  constexpr float far = 1e30f;
  const std::string key = "grid.bounds", range = "null, [[x,y,z],[x,y,z]]";
  return {
      key, range, "box in place of the scene's own, minimum and maximum, taken without a margin",
      [](const Settings& s) {
        return s.grid.bounds ? json{to_json(s.grid.bounds->min), to_json(s.grid.bounds->max)} : json();
      },
      [=](Settings& s, const json& value) {
        s.grid.bounds.reset();
        if (value.is_null()) return;
        if (!value.is_array() || value.size() != 2) refuse(key, value, range);
        const Bounds box{parse_vector(key, value[0], -far, far, range), parse_vector(key, value[1], -far, far, range)};
        for (int axis = 0; axis < 3; ++axis)
          if (!(box.min[axis] < box.max[axis])) refuse(key, value, "a box whose minimum lies below its maximum");
        s.grid.bounds = box;
      }};
}

Parameter light_attenuation() {
  const std::string key = "light.attenuation", range = "[c,l,q], each 0 to 1e+06";
  return {key, range, "coefficients of the attenuated falloff 1 / (1 + c + l d + q d^2)",
          [](const Settings& s) { return to_json(s.light.attenuation); },
          [=](Settings& s, const json& value) { s.light.attenuation = parse_vector(key, value, 0.0f, 1e6f, range); }};
}

std::vector<Parameter> grid_and_voxel_parameters() {
  return {
      integer(
          "grid.resolution", GridOptions::least_resolution, GridOptions::most_resolution,
          "voxels along the longest side", [](auto& s) -> auto& { return s.grid.resolution; }),
      flag(
          "grid.cubic", "a cube from the scene's minimum corner instead of a fitted box",
          [](auto& s) -> auto& { return s.grid.cubic; }),
      grid_bounds(),
      choice(
          "voxelize.method", {"exact", "raster"},
          "triangles are clipped against voxels, or rasterized along their main axis",
          [](auto& s) -> auto& { return s.voxelize.method; }),
      choice(
          "voxelize.average", {"area", "running_floor8"}, "by area, or in bytes that each fragment rounds down",
          [](auto& s) -> auto& { return s.voxelize.average; }),
      choice(
          "voxelize.opacity", {"occupied", "coverage"}, "opacity of a voxel with surface: 1, or projected coverage",
          [](auto& s) -> auto& { return s.voxelize.opacity; }),
      flag(
          "voxelize.static_wins", "dynamic surfaces never overwrite static voxels",
          [](auto& s) -> auto& { return s.voxelize.static_wins; }),
      choice(
          "storage", {storage_names.begin(), storage_names.end()},
          "number format of the volumes of radiance and opacity", [](auto& s) -> auto& { return s.storage; }),
      choice(
          "light.falloff", {"inverse_square", "attenuated"}, "of point and spot lights",
          [](auto& s) -> auto& { return s.light.falloff; }),
      light_attenuation(),
      choice(
          "shade.position", {"centroid", "corner"}, "where in the voxel light arrives",
          [](auto& s) -> auto& { return s.shade.position; }),
      flag(
          "shade.two_sided", "voxels in which opposite normals cancel are lit from both sides",
          [](auto& s) -> auto& { return s.shade.two_sided; }),
      flag(
          "shade.normal_weighted", "attenuation weighted by the normal's axes instead of Lambert's cosine",
          [](auto& s) -> auto& { return s.shade.normal_weighted; }),
      choice(
          "shade.normalization", {"lambert", "none"}, "albedo over pi, or albedo",
          [](auto& s) -> auto& { return s.shade.normalization; }),
      choice(
          "shade.shadow", {"none", "rays", "volume"}, "shadows at the voxels",
          [](auto& s) -> auto& { return s.shade.shadow; }),
      optional_number(
          "shade.shadow_hit", 0.0f, 10.0f, "root of what a voxel of a marched shadow blocks; null: its extinction",
          [](auto& s) -> auto& { return s.shade.shadow_hit; }),
      choice(
          "mipmap.filter", {"anisotropic", "isotropic"}, "directional volumes, or one plain mean",
          [](auto& s) -> auto& { return s.mipmap.filter; }),
      bounce_count(),
      cone_count(
          "bounce.cones", "villegas4", "cones over the hemisphere of each voxel",
          [](auto& s) -> auto& { return s.bounce.cones; }),
      optional_number(
          "bounce.max_distance", 0.0f, 10.0f, "end of villegas4's cones, in sides of the grid; null: the grid's own",
          [](auto& s) -> auto& { return s.bounce.max_distance; }),
  };
}

std::vector<Parameter> image_parameters() {
  return {
      cone_count(
          "cone.diffuse", "villegas6", "cones over the hemisphere of each pixel",
          [](auto& s) -> auto& { return s.render.cone.diffuse; }),
      number(
          "cone.step", 0.01f, 4.0f,
          "step length in texels that the cone reads, about its diameter wide; of raw cones: in diameters",
          [](auto& s) -> auto& { return s.render.cone.step; }),
      number(
          "cone.start", 0.0f, 16.0f, "voxels from the surface to a cone's apex",
          [](auto& s) -> auto& { return s.render.cone.start; }),
      choice(
          "cone.opacity", {"extinction", "raw"}, "what is interpolated between texels",
          [](auto& s) -> auto& { return s.render.cone.opacity; }),
      optional_number(
          "cone.max_distance", 0.0f, 10.0f, "end of raw cones, in sides of the grid; null: the grid's own",
          [](auto& s) -> auto& { return s.render.cone.max_distance; }),
      number(
          "cone.raw_unit", 0.1f, 16.0f, "voxels to a raw cone's first sample, and across its finest texels",
          [](auto& s) -> auto& { return s.render.cone.raw_unit; }),
      flag(
          "cone.box_test", "raw cones gather nothing where the ray from the surface misses the scene's box",
          [](auto& s) -> auto& { return s.render.cone.box_test; }),
      flag(
          "ao.enabled", "ambient occlusion in the channel ao.Y", [](auto& s) -> auto& { return s.render.ao.enabled; }),
      number(
          "ao.falloff", 0.0f, 1e6f, "how fast occlusion fades with distance",
          [](auto& s) -> auto& { return s.render.ao.falloff; }),
      number(
          "ao.alpha", 0.0f, 1.0f, "added to the openness", [](auto& s) -> auto& { return s.render.ao.alpha; }),
      flag(
          "ao.normalized", "occlusion is the cones' mean; else their sum with weights that make pi",
          [](auto& s) -> auto& { return s.render.ao.normalized; }),
      flag(
          "ao.skip_black", "surfaces without diffuse albedo count as open",
          [](auto& s) -> auto& { return s.render.ao.skip_black; }),
      flag(
          "gbuffer.cull_back_faces", "the camera sees through clockwise triangles, double-sided ones too",
          [](auto& s) -> auto& { return s.render.gbuffer.cull_back_faces; }),
      optional_number(
          "gbuffer.discard_alpha", 0.0f, 1.0f,
          "the camera sees through what has at most this alpha; null: through masks",
          [](auto& s) -> auto& { return s.render.gbuffer.discard_alpha; }),
      flag(
          "gbuffer.decode_textures", "sRGB texels become linear; else blinn_phong and emission take them as they are",
          [](auto& s) -> auto& { return s.render.gbuffer.decode_textures; }),
      flag(
          "gbuffer.geometric_normal", "bounds where shading normals let light in",
          [](auto& s) -> auto& { return s.render.gbuffer.geometric_normal; }),
      choice(
          "gbuffer.normal", {"float32", "float16"}, "number format of normals; float16 is cut off, not rounded",
          [](auto& s) -> auto& { return s.render.gbuffer.normal; }),
      choice(
          "gbuffer.color", {"float32", "unorm8"}, "of albedo, specular and emission",
          [](auto& s) -> auto& { return s.render.gbuffer.color; }),
      choice(
          "gbuffer.depth", {"float32", "unorm24"}, "of depth, from which the position is computed",
          [](auto& s) -> auto& { return s.render.gbuffer.depth; }),
      choice(
          "pixel.brdf", {"ggx", "blinn_phong"}, "how a pixel's surface reflects",
          [](auto& s) -> auto& { return s.render.pixel.brdf; }),
      flag(
          "phong.divide_by_pi", "blinn_phong's diffuse light is albedo / pi times irradiance; else albedo times it",
          [](auto& s) -> auto& { return s.render.pixel.phong.divide_by_pi; }),
      number(
          "phong.albedo_power", 0.1f, 10.0f, "exponent on blinn_phong's albedo in direct light",
          [](auto& s) -> auto& { return s.render.pixel.phong.albedo_power; }),
      flag(
          "phong.specular_twice", "Ks multiplies blinn_phong's lobe, whose Fresnel term holds it already",
          [](auto& s) -> auto& { return s.render.pixel.phong.specular_twice; }),
      choice(
          "pixel.specular_cone", {"ggx", "glossiness"},
          "half-angle: fitted to the lobe, or 90 degrees (1 - glossiness)",
          [](auto& s) -> auto& { return s.render.pixel.specular_cone; }),
      choice(
          "pixel.shadow", {"none", "rays", "cone", "visibility"}, "shadows of the image's direct light",
          [](auto& s) -> auto& { return s.render.pixel.shadow; }),
      number(
          "pixel.shadow_cone.aperture", 1e-4f, 10.0f, "tangent of the shadow cone's half-angle",
          [](auto& s) -> auto& { return s.render.pixel.shadow_cone_aperture; }),
      number(
          "pixel.shadow_cone.tolerance", 0.0f, 1.0f, "t: raw shadow cones multiply opacity by 2^(7 t)",
          [](auto& s) -> auto& { return s.render.pixel.shadow_cone_tolerance; }),
      number(
          "composite.bounce_strength", 0.0f, 1000.0f, "factor on the indirect light",
          [](auto& s) -> auto& { return s.render.composite.bounce_strength; }),
      number(
          "composite.indirect_power", 0.1f, 10.0f, "exponent on the indirect light, after the factor",
          [](auto& s) -> auto& { return s.render.composite.indirect_power; }),
  };
}

}  // namespace

void refuse(const std::string& key, const json& value, const std::string& expected) {
  const std::string text = value.dump(-1, ' ', /*ensure_ascii=*/true, json::error_handler_t::replace);
  throw Error(key, printable(text) + " is not " + expected);
}

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> all = grid_and_voxel_parameters();
    std::ranges::move(image_parameters(), std::back_inserter(all));
    return all;
  }();
  return table;
}

}  // namespace voxref
