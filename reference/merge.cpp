#include "reference/merge.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "error.h"
#include "reference/identity.h"

namespace voxref {

namespace {

constexpr const char* part_attribute = "voxref:part";
constexpr const char* spp_attribute = "voxref:part_spp";
constexpr const char* render_attribute = "voxref:render";

std::string name_of(const Part& part) {
  return "part " + std::to_string(part.index) + "/" + std::to_string(part.count);
}

const std::string& attribute(const std::string& file, const Image& part, const char* name) {
  const auto found = part.attributes.find(name);
  if (found == part.attributes.end() || !part.has("samples"))
    throw Error(file, "header", "is no part of an image: it was not rendered with --part");
  return found->second;
}

/// Calls visit(pixel) for all pixels of the part.
template <class Visit>
void visit_pixels(const Image& image, const Part& part, const Visit& visit) {
  const TileGrid tiles(image.width(), image.height());
  for (const size_t tile : tiles.tiles_of(part))
    tiles.visit_pixels(tile, [&](int x, int y) {
      visit(static_cast<size_t>(y) * static_cast<size_t>(image.width()) + static_cast<size_t>(x));
    });
}

}  // namespace

void mark_part(Image& image, const Part& part, int spp, const std::string& render) {
  image.attributes[part_attribute] = std::to_string(part.index) + "/" + std::to_string(part.count);
  image.attributes[spp_attribute] = std::to_string(spp);
  image.attributes[render_attribute] = render;
  const std::span<float> channel = image.channel("samples");
  std::vector<float> samples(channel.size(), 0.0f);
  visit_pixels(image, part, [&](size_t pixel) { samples[pixel] = channel[pixel]; });
  std::copy(samples.begin(), samples.end(), channel.begin());
}

void PartMerger::require_same_render(const std::string& file, const Image& part) const {
  if (const std::optional<std::string> difference = difference_of(render_, attribute(file, part, render_attribute)))
    throw Error(file, *difference + " in " + first_file_ + ": a part of another render");
  if (part.channels() != image_.channels() || part.width() != image_.width() || part.height() != image_.height())
    throw Error(file, "channels", "are not those of " + first_file_ + ": a part of another render");
}

void PartMerger::add(const std::string& file, const Image& image) {
  const std::string& text = attribute(file, image, part_attribute);
  const std::optional<Part> part = parse_part(text);
  if (!part) throw Error(file, part_attribute, "'" + text + "' is not I/N");
  if (parts_.empty()) {
    image_ = Image(image.width(), image.height());
    for (const std::string& name : image.channels()) image_.add(name);
    image_.attributes = image.attributes;
    render_ = attribute(file, image, render_attribute);
    spp_ = attribute(file, image, spp_attribute);
    count_ = part->count;
    first_file_ = file;
  }
  require_same_render(file, image);
  if (part->count != count_)
    throw Error(file, name_of(*part), "cannot be joined with one of " + std::to_string(count_) + ", " + first_file_);
  const auto [place, is_new] = parts_.emplace(part->index, Added{file});
  if (!is_new) throw Error(file, name_of(*part), "is there already: " + place->second.file);

  for (const std::string& name : image.channels()) {
    const std::span<const float> from = image.channel(name);
    const std::span<float> to = image_.channel(name);
    visit_pixels(image, *part, [&](size_t pixel) { to[pixel] = from[pixel]; });
  }
  const std::span<const float> samples = image.channel("samples");
  place->second.samples = *std::max_element(samples.begin(), samples.end());
  std::erase_if(image_.attributes, [&](const auto& item) {
    const auto same = image.attributes.find(item.first);
    return same == image.attributes.end() || same->second != item.second;
  });
}

Image PartMerger::finish() {
  for (int index = 1; index <= count_; ++index) {
    const auto part = parts_.find(index);
    if (part == parts_.end()) throw Error("merge", name_of({index, count_}) + " is missing");
    const std::string samples = std::to_string(static_cast<int>(part->second.samples));
    if (samples != spp_)
      throw Error(part->second.file, name_of({index, count_}),
                  "was stopped at " + samples + " samples of " + spp_ + "; path --resume finishes it");
  }
  image_.attributes.erase(part_attribute);
  image_.attributes.erase(spp_attribute);
  return std::move(image_);
}

}  // namespace voxref
