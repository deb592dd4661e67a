#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

namespace voxref {

// Values of flags, strictly: nothing may follow a number, and NaN and infinity are no numbers.
// All throw Error `FLAG: what is wrong`.

double parse_number(std::string_view flag, std::string_view text, double low, double high);
uint64_t parse_integer(std::string_view flag, std::string_view text, uint64_t low, uint64_t high);
/// "x,y,z" @param low,high of each component
glm::vec3 parse_vector(std::string_view flag, std::string_view text, float low, float high);
/// "WxH", each side 1 to 65536
glm::ivec2 parse_size(std::string_view flag, std::string_view text);

}  // namespace voxref
