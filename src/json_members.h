#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "error.h"
#include "printable.h"

namespace voxref {

/// @throws Error with the path, and the byte where it is not valid JSON
nlohmann::json read_json(const std::filesystem::path& file);

/// Reads members of an object that somebody else wrote, and says where and what is wrong. Types are not converted: 2.5
/// is no whole number, an array of another length not that array.
class JsonMembers {
 public:
  /// @param place of the object in the file; empty: the whole
  JsonMembers(const nlohmann::json& object, std::string file, std::string place)
      : object_(object), file_(std::move(file)), place_(std::move(place)) {
    if (!object.is_object()) fail("", "is not an object");
  }
  bool has(const std::string& key) const { return object_.contains(key); }
  template <class T>
  T get(const std::string& key) const {
    if (!has(key)) fail(key, "is missing");
    T value;
    if (!convert(object_.at(key), value)) fail(key, "has the wrong type");
    return value;
  }
  template <class T>
  T get(const std::string& key, const T& absent) const {
    return has(key) ? get<T>(key) : absent;
  }
  /// @throws Error naming the first key that is none of these
  void require_only(std::initializer_list<std::string> keys) const {
    for (const auto& [key, _] : object_.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) fail(printable(key), "is no key of this file");
  }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw Error(file_, place_ + (place_.empty() || key.empty() ? "" : ".") + key, what);
  }

 private:
  template <class T>
  static bool convert(const nlohmann::json& from, T& to) {
    if constexpr (std::same_as<T, bool>) {
      if (!from.is_boolean()) return false;
    } else if constexpr (std::integral<T>) {
      // The parser holds what fits neither of its 64-bit integers as a floating-point number.
      if (!from.is_number_integer()) return false;
      if (from.is_number_unsigned() ? !std::in_range<T>(from.get<uint64_t>()) : !std::in_range<T>(from.get<int64_t>()))
        return false;
    } else if constexpr (std::floating_point<T>) {
      if (!from.is_number() || !std::isfinite(from.get<T>())) return false;
    } else if constexpr (std::same_as<T, std::string>) {
      if (!from.is_string()) return false;
    } else if constexpr (std::same_as<T, nlohmann::json>) {
      to = from;
      return true;
    } else {  // arrays
      if (!from.is_array()) return false;
      if constexpr (requires { to.resize(0); }) to.resize(from.size());
      if (to.size() != from.size()) return false;
      for (size_t i = 0; i < to.size(); ++i)
        if (!convert(from[i], to[i])) return false;
      return true;
    }
    to = from.get<T>();
    return true;
  }

  const nlohmann::json& object_;
  std::string file_, place_;
};

}  // namespace voxref
