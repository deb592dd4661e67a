#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace voxref {

/// Numbers from `low` to `high`, both allowed.
struct Range {
  double low = -std::numeric_limits<float>::max(), high = std::numeric_limits<float>::max();

  static constexpr Range from(double low) { return {low, std::numeric_limits<float>::max()}; }
  static constexpr Range positive() { return {std::numeric_limits<float>::min(), std::numeric_limits<float>::max()}; }
  static constexpr Range unit() { return {0.0, 1.0}; }
};

/// A value of a glTF document and where it stands in it. Reading is checking: each reader tests type, length and range,
/// and its Error names the place, such as `nodes[3].rotation`. What the document leaves out is the caller's fallback;
/// what it says wrongly never is. The document must outlive its values.
class GltfValue {
 public:
  /// @param file shown in errors
  GltfValue(const nlohmann::json& value, const std::string& file, std::string place = "");

  [[noreturn]] void fail(const std::string& what) const;
  const std::string& place() const { return place_; }

  std::optional<GltfValue> find(const std::string& key) const;  ///< a member of this object, if it is there
  GltfValue at(const std::string& key) const;                   ///< a member that must be there
  std::optional<GltfValue> extension(const std::string& name) const;
  std::vector<std::string> keys() const;                       ///< names of this object's members
  std::vector<GltfValue> items() const;                        ///< the elements of this array
  std::vector<GltfValue> items(const std::string& key) const;  ///< of that member; none when it is absent

  double number(Range range = {}) const;
  uint64_t integer(uint64_t low = 0, uint64_t high = std::numeric_limits<uint32_t>::max()) const;
  const std::string& text() const;
  std::string quoted() const { return value_->dump(); }  ///< as JSON, on one line

  float number(const std::string& key, float fallback, Range range = {}) const;
  uint64_t integer(const std::string& key, uint64_t fallback) const;
  bool boolean(const std::string& key, bool fallback) const;
  std::string text(const std::string& key, const std::string& fallback = "") const;
  /// This integer, which counts from 0 in the list named `list` of `count` elements.
  uint32_t index(size_t count, const std::string& list) const;
  std::optional<uint32_t> index(const std::string& key, size_t count, const std::string& list) const;

  /// An array of exactly `count` numbers.
  std::vector<double> numbers(size_t count, Range range = {}) const;
  template <int N>
  glm::vec<N, float> vector(const std::string& key, const glm::vec<N, float>& fallback, Range range = {}) const {
    const std::optional<GltfValue> member = find(key);
    if (!member) return fallback;
    const std::vector<double> values = member->numbers(N, range);
    glm::vec<N, float> result;
    for (int i = 0; i < N; ++i) result[i] = static_cast<float>(values[i]);
    return result;
  }

 private:
  const nlohmann::json* value_;
  const std::string* file_;
  std::string place_;
};

/// Adds a line unless it is there already: what is ignored is said once.
void warn_once(std::vector<std::string>& warnings, const std::string& line);

}  // namespace voxref
