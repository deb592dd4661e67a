#include "reference/identity.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace voxref {

namespace {

using nlohmann::json;

std::string text_of(const json& object, const std::string& key) {
  return object.contains(key) ? object[key].dump(-1, ' ', false, json::error_handler_t::replace) : "none";
}

/// Of a JSON pointer: "/camera/size/0" is camera.size.0
std::string dotted(std::string pointer) {
  std::replace(pointer.begin(), pointer.end(), '/', '.');
  return pointer.substr(1);
}

}  // namespace

std::optional<Part> parse_part(std::string_view text) {
  Part part;
  const char* end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, part.index);
  if (index.ec != std::errc() || index.ptr == end || *index.ptr != '/') return std::nullopt;
  const auto count = std::from_chars(index.ptr + 1, end, part.count);
  if (count.ec != std::errc() || count.ptr != end || part.index < 1 || part.index > part.count) return std::nullopt;
  return part;
}

std::optional<std::string> difference_of(const std::string& expected, const std::string& found) {
  const json a = json::parse(expected, nullptr, false), b = json::parse(found, nullptr, false);
  if (!a.is_object() || !b.is_object()) return "what it was rendered from: unreadable";
  const json flat_a = a.flatten(), flat_b = b.flatten();
  // What stands outside first: of another scene the camera is another too.
  for (const bool nested : {false, true})
    for (const json* object : {&flat_a, &flat_b})
      for (const auto& [key, value] : object->items())
        if ((key.rfind('/') > 0) == nested && text_of(flat_a, key) != text_of(flat_b, key))
          return dotted(key) + ": " + text_of(flat_b, key) + ", but " + text_of(flat_a, key);
  return std::nullopt;
}

}  // namespace voxref
