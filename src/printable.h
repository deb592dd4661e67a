#pragma once
#include <string>
#include <string_view>

namespace voxref {

/// Text of a file for a message of one line: what is not ASCII, or not to be seen, becomes a dot, what is long is cut.
inline std::string printable(std::string_view text) {
  constexpr size_t longest = 60;
  std::string shown(text.substr(0, longest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '.';
  return text.size() > longest ? shown + "..." : shown;
}

}  // namespace voxref
