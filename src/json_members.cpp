#include "json_members.h"

#include "file.h"

namespace voxref {

nlohmann::json read_json(const std::filesystem::path& file) {
  try {
    return nlohmann::json::parse(read_file(file));
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(file.string(), "byte " + std::to_string(error.byte), "is not valid JSON");
  } catch (const nlohmann::json::out_of_range&) {
    throw Error(file.string(), "holds a number that no computer number comes near");
  }
}

}  // namespace voxref
