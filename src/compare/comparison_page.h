#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/image.h"

namespace voxref {

/// What the page's viewer can show: the sums of these layers of either image, side by side.
struct PageLayer {
  std::string name;
  std::vector<std::string> a, b;
};

struct PageTable {
  std::string title;
  std::vector<std::string> head;               ///< one per column
  std::vector<std::vector<std::string>> rows;  ///< plain text; the first column names the row
};

enum class PageTone : uint8_t { open, good, bad };

/// A self-contained report page: two images to flip between, and tables.
struct ComparisonPage {
  std::string command;  ///< "voxref check"
  std::string title;    ///< what was compared
  std::string verdict;  ///< a word or two
  PageTone tone = PageTone::open;
  std::string summary;            ///< one or a few sentences
  std::string unit;               ///< of the images' values, a sentence
  std::string name_a, name_b;     ///< of the images, short: "cone", "path"
  const Image &a, &b;             ///< of equal size
  float exposure = 0.0f;          ///< stops
  std::vector<PageLayer> layers;  ///< those that an image lacks are left out; one at least is in both
  std::vector<PageTable> tables;
  nlohmann::json provenance;  ///< object, shown key by key
};

/// An HTML page that opens from disk: no resource from elsewhere, below 3 MiB whatever the images' size (they are
/// reduced by a whole factor, which the page states, when they have more than 512x512 pixels or noise that does not
/// compress).
std::string comparison_page(const ComparisonPage& page);

}  // namespace voxref
