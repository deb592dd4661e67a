#include "scene/gltf_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.h"

namespace voxref {
namespace {

std::string member_place(const std::string& parent, const std::string& key) {
  return parent.empty() ? key : parent + "." + key;
}

}  // namespace

GltfValue::GltfValue(const nlohmann::json& value, const std::string& file, std::string place)
    : value_(&value), file_(&file), place_(std::move(place)) {}

void GltfValue::fail(const std::string& what) const { throw Error(*file_, place_.empty() ? "document" : place_, what); }

std::optional<GltfValue> GltfValue::find(const std::string& key) const {
  if (!value_->is_object()) fail(fmt::format("must be an object, is {}", value_->type_name()));
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return GltfValue(*member, *file_, member_place(place_, key));
}

GltfValue GltfValue::at(const std::string& key) const {
  std::optional<GltfValue> member = find(key);
  if (!member) throw Error(*file_, member_place(place_, key), "missing");
  return *std::move(member);
}

std::optional<GltfValue> GltfValue::extension(const std::string& name) const {
  const std::optional<GltfValue> extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

std::vector<std::string> GltfValue::keys() const {
  if (!value_->is_object()) fail(fmt::format("must be an object, is {}", value_->type_name()));
  std::vector<std::string> result;
  for (const auto& member : value_->items()) result.push_back(member.key());
  return result;
}

std::vector<GltfValue> GltfValue::items() const {
  if (!value_->is_array()) fail(fmt::format("must be an array, is {}", value_->type_name()));
  std::vector<GltfValue> result;
  result.reserve(value_->size());
  for (size_t i = 0; i < value_->size(); ++i)
    result.emplace_back((*value_)[i], *file_, fmt::format("{}[{}]", place_, i));
  return result;
}

std::vector<GltfValue> GltfValue::items(const std::string& key) const {
  const std::optional<GltfValue> member = find(key);
  return member ? member->items() : std::vector<GltfValue>();
}

double GltfValue::number(Range range) const {
  if (!value_->is_number()) fail(fmt::format("must be a number, is {}", value_->type_name()));
  const double number = value_->get<double>();
  if (!(number >= range.low && number <= range.high))
    fail(fmt::format("{:g} is outside {:g} to {:g}", number, range.low, range.high));
  return number;
}

uint64_t GltfValue::integer(uint64_t low, uint64_t high) const {
  // JSON does not tell 3 from 3.0, and some exporters write the latter.
  const bool whole = value_->is_number_integer() ||
                     (value_->is_number_float() && value_->get<double>() == std::floor(value_->get<double>()));
  if (!whole)
    fail(value_->is_number() ? "must be an integer" : fmt::format("must be an integer, is {}", value_->type_name()));
  const double number = value_->get<double>();
  if (number < static_cast<double>(low) || number > static_cast<double>(high))
    fail(fmt::format("{:.0f} is outside {} to {}", number, low, high));
  return value_->get<uint64_t>();
}

const std::string& GltfValue::text() const {
  if (!value_->is_string()) fail(fmt::format("must be a string, is {}", value_->type_name()));
  return value_->get_ref<const std::string&>();
}

float GltfValue::number(const std::string& key, float fallback, Range range) const {
  const std::optional<GltfValue> member = find(key);
  return member ? static_cast<float>(member->number(range)) : fallback;
}

uint64_t GltfValue::integer(const std::string& key, uint64_t fallback) const {
  const std::optional<GltfValue> member = find(key);
  return member ? member->integer() : fallback;
}

bool GltfValue::boolean(const std::string& key, bool fallback) const {
  const std::optional<GltfValue> member = find(key);
  if (!member) return fallback;
  if (!member->value_->is_boolean())
    member->fail(fmt::format("must be true or false, is {}", member->value_->type_name()));
  return member->value_->get<bool>();
}

std::string GltfValue::text(const std::string& key, const std::string& fallback) const {
  const std::optional<GltfValue> member = find(key);
  return member ? member->text() : fallback;
}

uint32_t GltfValue::index(size_t count, const std::string& list) const {
  const uint64_t index = integer();
  if (index >= count) fail(fmt::format("there is no {}[{}], there are {}", list, index, count));
  return static_cast<uint32_t>(index);
}

std::optional<uint32_t> GltfValue::index(const std::string& key, size_t count, const std::string& list) const {
  const std::optional<GltfValue> member = find(key);
  return member ? std::optional(member->index(count, list)) : std::nullopt;
}

std::vector<double> GltfValue::numbers(size_t count, Range range) const {
  const std::vector<GltfValue> elements = items();
  if (elements.size() != count) fail(fmt::format("must hold {} numbers, holds {}", count, elements.size()));
  std::vector<double> result;
  result.reserve(count);
  for (const GltfValue& element : elements) result.push_back(element.number(range));
  return result;
}

void warn_once(std::vector<std::string>& warnings, const std::string& line) {
  if (std::find(warnings.begin(), warnings.end(), line) == warnings.end()) warnings.push_back(line);
}

}  // namespace voxref
