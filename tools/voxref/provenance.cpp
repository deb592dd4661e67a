#include "provenance.h"

#include <fstream>
#include <glm/trigonometric.hpp>

#include "json.h"

namespace voxref {

namespace {

std::string command_line;  // set once, by main, before anything else runs

template <class Value>
nlohmann::json given(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json describe(const View& view) {
  const glm::mat4& frame = view.camera.world_from_camera;
  nlohmann::json json = {{"name", view.camera.name},
                         {"eye", to_json(glm::vec3(frame[3]))},
                         {"forward", to_json(-glm::vec3(frame[2]))},
                         {"up", to_json(glm::vec3(frame[1]))},
                         {"size", {view.width, view.height}},
                         {"pixel", view.pixel == PixelSampling::box ? "box" : "center"},
                         {"background", to_json(view.background)}};
  if (view.camera.orthographic)
    json["ymag"] = view.camera.ymag;
  else
    json["yfov_degrees"] = glm::degrees(view.camera.yfov);
  return json;
}

}  // namespace

std::string version() { return VOXREF_VERSION; }

std::string shell_word(const std::string& argument) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
  std::string result = "'";
  for (const char c : argument) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (const size_t colon = line.find(": "); line.starts_with("model name") && colon != std::string::npos)
      return line.substr(colon + 2);
  return "unknown processor";
}

void set_command_line(int argc, char* argv[]) {
  command_line = "voxref";
  for (int i = 1; i < argc; ++i) command_line += " " + shell_word(argv[i]);
}

nlohmann::json program_provenance() {
  return {{"version", version()}, {"libraries", VOXREF_LIBRARIES}, {"command_line", command_line}};
}

nlohmann::json provenance(const Scene& scene, const View& view) {
  nlohmann::json json = program_provenance();
  json["scene"] = scene.file;
  json["scene_sha256"] = scene.sha256;
  json["camera"] = describe(view);
  return json;
}

nlohmann::json describe(const SceneOptions& options) {
  nlohmann::json suns = nlohmann::json::array();
  for (const Light& sun : options.suns)
    suns.push_back({{"direction", to_json(sun.direction)}, {"irradiance", to_json(sun.intensity)}});
  return {{"light_scale", options.load.light_scale}, {"at", given(options.load.time)}, {"suns", suns}};
}

nlohmann::json describe(const PathOptions& options) {
  return {{"spp", options.spp > 0 ? nlohmann::json(options.spp) : nlohmann::json()},
          {"randomizations", options.randomizations},
          {"noise", given(options.noise)},
          {"time", given(options.seconds)},
          {"max_depth", given(options.max_depth)},
          {"energy_compensation", options.energy_compensation},
          {"seed", options.seed},
          {"bounces", options.extra.bounces},
          {"irradiance", options.extra.irradiance}};
}

void add_path_provenance(nlohmann::json& provenance, const PathOptions& options, int spp) {
  provenance["seed"] = options.seed;
  provenance["spp"] = spp;
  provenance["path"] = describe(options);
}

void attach(Image& image, const nlohmann::json& provenance) {
  for (const auto& [key, value] : provenance.items())
    image.attributes["voxref:" + key] = value.is_string()
                                            ? value.get<std::string>()
                                            : value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace voxref
