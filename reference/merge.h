#pragma once
#include <map>
#include <string>

#include "image/image.h"
#include "reference/tiles.h"

namespace voxref {

// Parts are images like any other: outside their tiles all channels, `samples` too, are zero. Three attributes of the
// header say what they belong to: "voxref:part", I/N; "voxref:part_spp", how many samples it has once it is finished;
// "voxref:render", what the image depends on, a JSON object.

/// Marks a part: attributes as above, and no samples outside its tiles.
/// @param spp samples per pixel of the finished part @param render JSON object; equal for all parts of an image
void mark_part(Image& image, const Part& part, int spp, const std::string& render);

/// Joins all parts of an image to the bits of a single render. Holds one image however many parts there are.
class PartMerger {
 public:
  /// In any order. @param file for messages
  /// @throws Error naming the file: it is no part, its part is there already, or it belongs to another render (which
  /// differs in what)
  void add(const std::string& file, const Image& part);

  /// The image, with the attributes that all parts have alike.
  /// @throws Error naming the part that is missing, or the file of one that was stopped early
  Image finish();

 private:
  struct Added {
    std::string file;
    float samples = 0.0f;
  };
  void require_same_render(const std::string& file, const Image& part) const;

  std::string render_;
  std::string spp_;
  int count_ = 0;
  std::string first_file_;
  std::map<int, Added> parts_;  // by index
  Image image_;
};

}  // namespace voxref
