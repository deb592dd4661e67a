#include "reference/identity.h"

#include <charconv>
#include <nlohmann/json.hpp>

namespace voxref {

namespace {

using nlohmann::json;

std::string text_of(const json& object, const std::string& key) {
  return object.contains(key) ? object[key].dump(-1, ' ', false, json::error_handler_t::replace) : "none";
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
  for (const json* object : {&a, &b})
    for (const auto& [key, value] : object->items())
      if (text_of(a, key) != text_of(b, key)) return key + ": " + text_of(b, key) + ", but " + text_of(a, key);
  return std::nullopt;
}

}  // namespace voxref
