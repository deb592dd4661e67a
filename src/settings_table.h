#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "settings.h"

namespace voxref {

/// A parameter of the cone tracer: how it is called, what it may be, and how it gets into Settings and out.
struct Parameter {
  std::string key, range, meaning;
  std::function<nlohmann::json(const Settings&)> get;
  std::function<void(Settings&, const nlohmann::json&)> set;  ///< throws Error when the value does not fit
};

/// Every parameter once, in the order of the pipeline: serves defaults, files, --set and the help alike.
const std::vector<Parameter>& parameters();

/// @throws Error: key: value is not expected
[[noreturn]] void refuse(const std::string& key, const nlohmann::json& value, const std::string& expected);

}  // namespace voxref
