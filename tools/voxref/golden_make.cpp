#include "commands.h"
#include "file.h"
#include "golden_command.h"
#include "image/image_file.h"
#include "json_members.h"
#include "parallel.h"
#include "provenance.h"
#include "terminal.h"

namespace voxref {

namespace fs = std::filesystem;

std::map<std::string, nlohmann::json> read_golden_index(const fs::path& file) {
  const nlohmann::json index = read_json(file);
  const auto entries = JsonMembers(index, file.string(), "").get<nlohmann::json>("cases");
  if (!entries.is_array()) throw Error(file.string(), "cases", "is no array");
  std::map<std::string, nlohmann::json> cases;
  for (size_t i = 0; i < entries.size(); ++i) {
    const JsonMembers members(entries[i], file.string(), "cases[" + std::to_string(i) + "]");
    cases[members.get<std::string>("name")] = entries[i];
  }
  return cases;
}

int make_goldens(const GoldenOptions& options) {
  require_folder(options.folder);
  fs::create_directories(options.folder);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  nlohmann::json index = program_provenance();
  index.erase("command_line");  // names folders of the machine that made the set
  index["instruction_set"] = instruction_set();
  index["cases"] = nlohmann::json::array();
  // Of what is not made anew the index keeps what it says, for that is what those files were made from.
  std::map<std::string, nlohmann::json> kept;
  if (!options.only.empty() && fs::exists(options.index_file())) kept = read_golden_index(options.index_file());
  for (const GoldenCase& golden : golden_cases()) {
    if (options.wants(golden)) {
      const Scene scene = load_gltf(options.scene_file(golden));
      if (golden.kind == GoldenKind::volumes) {
        write_golden_volumes(golden, scene, options.volume_folder(golden), terminal.progress());
      } else {
        Image image = render_golden(golden, scene, golden_seed, golden_spp, terminal.progress());
        for (const char* key : {"voxref:command_line", "voxref:scene"}) image.attributes.erase(key);
        write_exr(options.image_file(golden), image);
      }
      terminal.say("made      " + golden.name);
      kept[golden.name] = describe(golden, scene);
    }
    if (kept.contains(golden.name)) index["cases"].push_back(kept.at(golden.name));
  }
  write_text(options.index_file(), index.dump(1) + "\n");
  terminal.result({{"folder", options.folder}, {"cases", index["cases"].size()}});
  return exit_done;
}

}  // namespace voxref
