#include "parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "error.h"

namespace voxref {

namespace {

/// The whole of `text` as a number, or false.
template <class Number>
bool read_all(std::string_view text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [rest, status] = std::from_chars(text.data(), end, number);
  return status == std::errc() && rest == end;
}

[[noreturn]] void refuse(std::string_view flag, std::string_view text, const std::string& expected) {
  throw Error(std::string(flag), fmt::format("'{}' is not {}", text, expected));
}

}  // namespace

double parse_number(std::string_view flag, std::string_view text, double low, double high) {
  double number = 0;
  if (!read_all(text, number) || !std::isfinite(number)) refuse(flag, text, "a number");
  if (number < low || number > high) refuse(flag, text, fmt::format("in the range {} to {}", low, high));
  return number;
}

uint64_t parse_integer(std::string_view flag, std::string_view text, uint64_t low, uint64_t high) {
  uint64_t number = 0;
  if (!read_all(text, number) || number < low || number > high)
    refuse(flag, text, fmt::format("an integer, {} to {}", low, high));
  return number;
}

glm::vec3 parse_vector(std::string_view flag, std::string_view text, float low, float high) {
  glm::vec3 vector(0.0f);
  std::string_view rest = text;
  for (int i = 0; i < 3; ++i) {
    const size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) refuse(flag, text, "three numbers x,y,z");
    vector[i] = static_cast<float>(parse_number(flag, rest.substr(0, comma), low, high));
    if (i < 2) rest.remove_prefix(comma + 1);
  }
  return vector;
}

glm::ivec2 parse_size(std::string_view flag, std::string_view text) {
  const size_t cross = text.find('x');
  if (cross == std::string_view::npos) refuse(flag, text, "WxH, for instance 512x384");
  constexpr uint64_t most = 65536;  // Image's own limit
  return {static_cast<int>(parse_integer(flag, text.substr(0, cross), 1, most)),
          static_cast<int>(parse_integer(flag, text.substr(cross + 1), 1, most))};
}

}  // namespace voxref
