#include "compare/report_parts.h"

#include <fmt/format.h>

#include <cmath>

#include "error.h"

namespace voxref {

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(folder.string(), "cannot be made: " + failure.message());
}

std::string number_text(double value) {
  if (std::isinf(value)) return value > 0.0 ? "infinite" : "minus infinite";
  return std::isnan(value) ? "undefined" : fmt::format("{:.6g}", value);
}

std::string name_of(const std::filesystem::path& path) {
  const std::filesystem::path clean = path.lexically_normal();
  return (clean.has_filename() ? clean : clean.parent_path()).filename().string();
}

PageTone tone_of(Verdict verdict) {
  return verdict == Verdict::same ? PageTone::good : verdict == Verdict::different ? PageTone::bad : PageTone::open;
}

std::string verdict_words(Verdict verdict) {
  return verdict == Verdict::same ? "same" : verdict == Verdict::different ? "different" : "too noisy";
}

}  // namespace voxref
