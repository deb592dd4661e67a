#include "options.h"

#include <glm/geometric.hpp>

#include "error.h"
#include "file.h"
#include "parse.h"

namespace voxref {

namespace {

constexpr float largest = 1e18f;  // squares of coordinates and radiances still fit a float

/// A flag that reads a number into a field.
template <class Field>
void add_number(CLI::App& command, const std::string& flag, const std::string& value, const std::string& help,
                double low, double high, Field& field) {
  add_value_option(command, flag, value, help, [&field, flag, low, high](const std::string& text) {
    field = static_cast<float>(parse_number(flag, text, low, high));
  });
}

Light parse_sun(const std::string& flag, const std::string& text) {
  size_t comma = 0;
  for (int i = 0; i < 3 && comma != std::string::npos; ++i) comma = text.find(',', comma + (i > 0));
  if (comma == std::string::npos) throw Error(flag, "'" + text + "' is not six numbers dx,dy,dz,r,g,b");
  const glm::vec3 direction = parse_vector(flag, text.substr(0, comma), -largest, largest);
  if (!(glm::length(direction) > 0.0f)) throw Error(flag, "'" + text + "' has no direction");
  Light sun;
  sun.name = "sun";
  sun.type = LightType::directional;
  sun.direction = glm::normalize(direction);
  sun.intensity = parse_vector(flag, text.substr(comma + 1), 0.0f, largest);
  return sun;
}

template <class Field>
void add_vector(CLI::App& command, const std::string& flag, const std::string& value, const std::string& help,
                float low, Field& field) {
  add_value_option(command, flag, value, help,
                   [&field, flag, low](const std::string& text) { field = parse_vector(flag, text, low, largest); });
}

}  // namespace

void add_value_option(CLI::App& command, const std::string& flag, const std::string& value, const std::string& help,
                      const std::function<void(const std::string& text)>& take) {
  command.add_option_function<std::string>(flag, take, help)->type_name(value);
}

void add_common_options(CLI::App& command, CommonOptions& options) {
  add_value_option(command, "--threads", "N", "threads (default: all cores); the result is the same for any number",
                   [&options](const std::string& text) {
                     options.threads = static_cast<int>(parse_integer("--threads", text, 1, 4096));
                   });
  command.add_flag("--quiet", options.quiet, "neither progress nor summary");
  command.add_flag("--json", options.json, "the result as one JSON object on stdout");
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("SCENE", options.file, "glTF 2.0 file, .gltf or .glb")->required()->type_name("");
  add_loading_options(command, options);
}

void add_loading_options(CLI::App& command, SceneOptions& options) {
  add_number(command, "--light-scale", "S", "multiplies all lights and all emission", 0, largest,
             options.load.light_scale);
  add_value_option(command, "--at", "T", "the animation's time in seconds (default: animations are ignored)",
                   [&options](const std::string& text) { options.load.time = parse_number("--at", text, 0, 1e9); });
  command.add_option("--dynamic", options.load.dynamic, "a node that counts as moving (repeatable)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command
      .add_option_function<std::vector<std::string>>(
          "--sun",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) options.suns.push_back(parse_sun("--sun", text));
          },
          "adds a directional light: the way it travels, and its irradiance on a facing surface, W/m^2 (repeatable)")
      ->type_name("DX,DY,DZ,R,G,B")
      ->allow_extra_args(false);
}

void add_view_options(CLI::App& command, ViewOptions& options) {
  add_value_option(command, "--size", "WxH", "image size (default: 512 wide, the camera's aspect)",
                   [&options](const std::string& text) { options.size = parse_size("--size", text); });
  add_camera_options(command, options);
  add_value_option(command, "--pixel", "center|box", "one position per pixel, as a GPU renders (default), or its mean",
                   [&options](const std::string& text) {
                     if (text != "center" && text != "box")
                       throw Error("--pixel", "'" + text + "' is not center or box");
                     options.pixel = text == "box" ? PixelSampling::box : PixelSampling::center;
                   });
}

void add_camera_options(CLI::App& command, ViewOptions& options) {
  add_value_option(command, "--camera", "NAME|INDEX", "one of the scene's cameras (default: the first)",
                   [&options](const std::string& text) { options.camera = text; });
  add_vector(command, "--eye", "X,Y,Z", "camera position, world units", -largest, options.eye);
  add_vector(command, "--target", "X,Y,Z", "what the camera looks at", -largest, options.target);
  add_vector(command, "--up", "X,Y,Z", "the image's upward direction (default: 0,1,0)", -largest, options.up);
  add_number(command, "--yfov", "DEG", "vertical field of view (default: the camera's, or 45)", 0.01, 179,
             options.yfov);
  add_vector(command, "--background", "R,G,B", "constant radiance from outside (default: 0,0,0)", 0,
             options.background);
}

void add_path_options(CLI::App& command, PathOptions& options) {
  // Float counts samples exactly up to 2^24.
  constexpr int usual_spp = 64, most_spp = 1 << 24, most_depth = 1 << 16;
  options.spp = 0;
  add_value_option(command, "--spp", "N", "samples per pixel (default: 64); with --noise or --time the most",
                   [&options](const std::string& text) {
                     options.spp = static_cast<int>(parse_integer("--spp", text, 1, most_spp));
                   });
  add_value_option(command, "--randomizations", "N",
                   "independent ones that share the samples and tell their error (default: 16); fewer: less noise, a "
                   "rougher error; not with --noise, --time",
                   [&options](const std::string& text) {
                     constexpr int most_randomizations = 1 << 16;
                     options.randomizations =
                         static_cast<int>(parse_integer("--randomizations", text, 1, most_randomizations));
                   });
  add_value_option(command, "--noise", "R", "until mean standard error / mean value is at most R",
                   [&options](const std::string& text) { options.noise = parse_number("--noise", text, 1e-6, 1e6); });
  add_value_option(command, "--time", "S", "for S seconds",
                   [&options](const std::string& text) { options.seconds = parse_number("--time", text, 1e-3, 1e9); });
  add_value_option(command, "--max-depth", "N", "0: emission only, 1: direct, 2: one bounce ... (default: unlimited)",
                   [&options](const std::string& text) {
                     options.max_depth = static_cast<int>(parse_integer("--max-depth", text, 0, most_depth));
                   });
  add_value_option(command, "--seed", "N", "of the random numbers (default: 0)", [&options](const std::string& text) {
    options.seed = parse_integer("--seed", text, 0, std::numeric_limits<uint64_t>::max());
  });
  add_value_option(command, "--bounces", "N", "layers bounce.1 ... bounce.N too: indirect light by bounce",
                   [&options](const std::string& text) {
                     constexpr int most_bounces = 64;
                     options.extra.bounces = static_cast<int>(parse_integer("--bounces", text, 1, most_bounces));
                   });
  command.add_flag("--irradiance", options.extra.irradiance, "layer irradiance too: what arrives at the first hit");
  command.add_flag("--energy-compensation", options.energy_compensation,
                   "rough metals keep the light that facets throw at each other (default: as glTF, they lose it)");
  command.parse_complete_callback([&options, &command] {
    if (command.count("--randomizations") > 0 && (options.noise || options.seconds))
      throw Error("--randomizations", "not with --noise or --time: there, each pass is one, until the goal is reached");
    if (options.spp == 0 && !options.noise && !options.seconds) options.spp = usual_spp;
  });
}

void add_settings_options(CLI::App& command, SettingsOptions& options) {
  command.add_option("--profile", options.profile, "parameters to start from: radiometric (default) or villegas2016")
      ->type_name("NAME");
  command.add_option("--config", options.config, "parameters as JSON")->type_name("FILE");
  command.add_option("--set", options.assignments, "one parameter (repeatable); voxref cone --help lists them")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_volumes_option(CLI::App& command, ConeTraceOutputs& outputs) {
  add_value_option(command, "--volumes", "DIR", "also writes every volume into this folder",
                   [&outputs](const std::string& text) {
                     require_folder(text);
                     outputs.volumes = text;
                   });
}

void add_output_option(CLI::App& command, std::string& output, const std::string& what, const std::string& help) {
  command
      .add_option_function<std::string>(
          "-o",
          [&output, what](const std::string& text) {
            // "-o --json" forgot the file; a file of that name is "./--json".
            if (text.empty() || text.front() == '-') throw Error("-o", "'" + text + "' is no " + what);
            output = text;
          },
          help)
      ->required()
      ->type_name(what);
}

void add_render_options(CLI::App& command, RenderCommandOptions& options, const std::string& what,
                        const std::string& help, const std::function<void()>& add_own) {
  add_scene_options(command, options.scene);
  add_output_option(command, options.output, what, help);
  add_own();
  add_view_options(command, options.view);
  add_common_options(command, options.common);
}

void on_run(CLI::App* command, Run& run, const std::function<int()>& work) {
  command->allow_extras();  // so that refuse_leftovers words the error
  command->final_callback([command, &run, work] {
    refuse_leftovers(*command);
    run = work;
  });
}

void refuse_leftovers(const CLI::App& command) {
  const std::vector<std::string> leftovers = command.remaining();
  if (leftovers.empty()) return;
  const std::string& first = leftovers.front();
  const std::string help = command.get_parent() ? "voxref " + command.get_name() + " --help" : "voxref --help";
  if (first.starts_with("-")) throw Error(first.substr(0, first.find('=')), "unknown flag; see " + help);
  throw Error("'" + first + "'", (command.get_parent() ? "unexpected argument; see " : "unknown command; see ") + help);
}

void require_folder(const std::filesystem::path& folder) {
  std::filesystem::path existing = std::filesystem::absolute(folder);
  while (!std::filesystem::exists(existing) && existing.has_relative_path()) existing = existing.parent_path();
  if (!std::filesystem::is_directory(existing)) throw Error(existing.string(), "is not a folder");
  require_writable(existing / "voxref-output");
}

}  // namespace voxref
