#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compare/statistics.h"
#include "study/chart.h"
#include "study/table.h"

namespace voxref {

/// What was measured here, in `runs` runs.
struct Timing {
  Spread spread;
  int runs = 1;
};

/// Medians of several times, which each call of `round` returns: five rounds where the first takes under a second,
/// three where it takes under ten, else one.
std::vector<Timing> repeated(const std::function<std::vector<double>()>& round);

/// A line of a published table.
struct ShapeLine {
  std::string name;
  Timing ours;
  double published = 0;  ///< in the publication's unit; NaN: it has none
};

/// What is known of why ratios differ from the published ones.
struct ShapeReason {
  std::string quantity;
  bool larger;  ///< which way this explains
  std::string text;
};

/// A published table measured again. What must agree is its shape: each line of a block is set over the block's base,
/// ours and the published one.
class Shape {
 public:
  /// @param unit of what is measured here; the publication's is that of its table
  Shape(const std::string& name, const std::string& caption, const std::string& unit,
        const std::string& published_unit);

  /// @param base index of the line that the others are set over
  void add_block(const std::string& scene, const std::string& quantity, const std::vector<ShapeLine>& lines,
                 size_t base);

  const Table& table() const { return table_; }
  /// Of every quantity: how many ratios agree within a factor of 2, which do not, and why where that is known. A ratio
  /// whose spread reaches back within the factor counts as unsure.
  std::string summary(std::span<const ShapeReason> reasons = {}) const;

 private:
  Table table_;
};

/// Lines of one block as a pair of series over that block's base: ours, with the spread as error bar, and the published
/// one, dashed. Lines that are not numbers stand at 0, 1, 2 ...
std::vector<Series> shape_series(const Table& shape, const std::string& scene, const std::string& quantity,
                                 const std::string& title);

/// "CLAIM: true for 2 of 3 scenes."
std::string finding(const std::string& claim, const std::vector<bool>& held, const std::string& what);

}  // namespace voxref
