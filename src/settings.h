#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cone/bounce.h"
#include "cone/render.h"
#include "scene/light.h"
#include "voxel/grid.h"
#include "voxel/mipmap.h"
#include "voxel/shade.h"
#include "voxel/texel.h"
#include "voxel/voxelize.h"

namespace voxref {

/// Every parameter of the cone tracer. A profile is such an object with a name.
struct Settings {
  std::string profile = "radiometric";
  GridOptions grid;
  VoxelizeOptions voxelize;
  Storage storage = Storage::float32;
  LightOptions light;
  ShadeOptions shade;
  MipmapOptions mipmap;
  BounceOptions bounce;
  RenderOptions render;  ///< JSON keys cone.*, ao.*, pixel.*, composite.*
};

/// Defaults of a profile: radiometric or villegas2016. @throws Error for an unknown name, listing those there are
Settings profile(std::string_view name);

/// JSON objects nest as the dots of the parameter names say; a file may name the profile it starts from.
nlohmann::json to_json(const Settings& settings);
/// Applies the keys that `json` holds. @throws Error naming an unknown key and the nearest known one, or the range
void apply_json(Settings& settings, const nlohmann::json& json);
/// Applies one `key=value`, for instance "cone.step=0.25". @throws Error as apply_json
void apply_assignment(Settings& settings, std::string_view assignment);

/// Refuses values that contradict each other; each alone is in its range. @throws Error naming a parameter
void validate(const Settings& settings);

/// One line per parameter for the help: key, value in each profile, range, meaning.
struct ParameterHelp {
  std::string key, radiometric, villegas2016, range, meaning;
};
std::vector<ParameterHelp> parameter_help();

}  // namespace voxref
