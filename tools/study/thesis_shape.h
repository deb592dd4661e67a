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

/// Medians of several times, which each call of `round` returns: five rounds where the longest time of the first is
/// under a second, else three, so that each has a spread.
std::vector<Timing> repeated(const std::function<std::vector<double>()>& round);

/// A line of a published table.
struct ShapeLine {
  std::string name;
  Timing ours;
  double published = 0;  ///< in the publication's unit; NaN: not_published or misprint
};

/// Why these rows, and no others, differ from the published ones.
struct ShapeReason {
  std::string quantity;
  bool larger;                    ///< which way it explains
  std::vector<std::string> rows;  ///< "SCENE LINE", or "LINE" of the rows of all scenes
  std::string text;
};

/// The scene of blocks whose lines are the scenes.
inline constexpr const char* all_scenes = "all";

/// A published table measured again. What must agree is its shape: each line of a block is set over the block's base,
/// ours and the published one.
///
/// A ratio r agrees with the published p when the whole spread of |ln r - ln p| is within half of |ln p|, but within
/// ln 1.1 at the least, since no time is repeated more closely, and ln 2 at the most. So both go the same way, and a
/// time that never changes passes only where the published one changes by less than 10 %: those rows are counted.
class Shape {
 public:
  /// @param unit of what is measured here; the publication's is that of its table
  Shape(const std::string& name, const std::string& caption, const std::string& unit,
        const std::string& published_unit);

  /// @param base index of the line that the others are set over
  void add_block(const std::string& scene, const std::string& quantity, const std::vector<ShapeLine>& lines,
                 size_t base);

  const Table& table() const { return table_; }
  /// Of every quantity: how many ratios agree, how many would if nothing ever changed, which are unsure since their
  /// spread reaches both sides of the limit, which differ, and why where that is known.
  std::string summary(std::span<const ShapeReason> reasons = {}) const;

 private:
  Table table_;
};

/// Lines of one block as a pair of series over that block's base: ours, with the spread as error bar (none where a time
/// was below the clock's step, so that it has no end), and the published one, dashed. Lines that are not numbers stand
/// at 0, 1, 2 ...
std::vector<Series> shape_series(const Table& shape, const std::string& scene, const std::string& quantity,
                                 const std::string& title);

/// "CLAIM: true for 2 of 3 scenes."
std::string finding(const std::string& claim, const std::vector<bool>& held, const std::string& what);

}  // namespace voxref
