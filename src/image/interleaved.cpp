#include "image/interleaved.h"

#include <algorithm>
#include <limits>

#include "error.h"
#include "parallel.h"

namespace voxref {

namespace {
constexpr size_t grain = 1 << 14;  // pixels that a thread moves at a time; those of a few channels fit into its cache
}

std::vector<float> interleave(const Image& image) {
  const size_t channels = image.channels().size();
  std::vector<float> pixels(channels * image.pixel_count());
  for (size_t c = 0; c < channels; ++c) {
    const std::span<const float> plane = image.channel(image.channels()[c]);
    for (size_t i = 0; i < plane.size(); ++i) pixels[i * channels + c] = plane[i];
  }
  return pixels;
}

void add_interleaved(Image& image, std::span<const float> pixels, std::span<const std::string> names,
                     const ChannelFilter& wanted) {
  std::vector<size_t> sources;
  for (size_t c = 0; c < names.size(); ++c) {
    if (wanted && !wanted(names[c])) continue;
    sources.push_back(c);
    image.add(names[c]);
  }
  std::vector<std::span<float>> planes;
  planes.reserve(sources.size());
  for (const size_t c : sources) planes.push_back(image.channel(names[c]));
  parallel_for(image.pixel_count(), grain, [&](size_t begin, size_t end) {
    for (size_t k = 0; k < planes.size(); ++k)
      for (size_t i = begin; i < end; ++i) planes[k][i] = pixels[i * names.size() + sources[k]];
  });
}

Image image_for_file(const std::string& file, size_t width, size_t height) {
  constexpr size_t most = std::numeric_limits<int>::max();
  try {
    return {int(std::min(width, most)), int(std::min(height, most))};
  } catch (const Error& error) {
    throw Error(file, error.what());
  }
}

}  // namespace voxref
