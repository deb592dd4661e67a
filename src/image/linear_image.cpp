#include "image/linear_image.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

#include "error.h"
#include "parallel.h"
#include "voxel/array_file.h"

namespace voxref {

namespace {

constexpr size_t grain = 1 << 16;  // pixels that one thread decodes at a time

/// What a file says of its transfer, in OpenImageIO's words; none: nothing, or nothing that tells.
std::optional<Transfer> declared_transfer(const std::string& file, std::string color_space) {
  std::ranges::transform(color_space, color_space.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (color_space == "linear" || color_space == "gamma1.0" || color_space == "gamma1") return Transfer::linear;
  if (color_space == "srgb") return Transfer::srgb;
  if (color_space == "gamma2.2") return Transfer::gamma22;
  if (color_space.starts_with("gamma"))
    throw Error(file, "transfer", "'" + color_space + "' is none that voxref knows; say linear, srgb or gamma22");
  return std::nullopt;
}

bool is_color(const std::string& channel) {
  const std::string last = channel.substr(channel.rfind('.') + 1);
  return last == "R" || last == "G" || last == "B" || last == "Y";
}

void linearize(Image& image, Transfer transfer) {
  if (transfer == Transfer::linear) return;
  for (const std::string& name : image.channels()) {
    if (!is_color(name)) continue;
    const std::span<float> plane = image.channel(name);
    parallel_for(plane.size(), grain, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) plane[i] = decode(transfer, plane[i]);
    });
  }
}

Image read_array_image(const std::filesystem::path& path, const ChannelFilter& wanted, int mip, bool& srgb) {
  static const std::array<std::vector<std::string>, 4> names = {
      {{"Y"}, {"R", "G"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
  ArrayFile file(path, mip);
  const auto [depth, height, width, channels] = file.shape();
  if (depth != 1) throw Error(file.name(), "is a volume, not an image");
  if (channels > names.size()) throw Error(file.name(), "has " + std::to_string(channels) + " channels, not 1 to 4");
  Image image = image_for_file(file.name(), width, height);
  std::vector<float> pixels(file.slice_size());
  file.read_slice(0, pixels);
  srgb = file.srgb();
  add_interleaved(image, pixels, names[channels - 1], wanted);
  return image;
}

}  // namespace

Image read_linear_image(const std::filesystem::path& file, std::optional<Transfer> transfer,
                        const ChannelFilter& wanted, int mip) {
  if (is_array_file(file)) {
    bool srgb = false;
    Image image = read_array_image(file, wanted, mip, srgb);
    linearize(image, transfer.value_or(srgb ? Transfer::srgb : Transfer::linear));
    return image;
  }
  StoredImage stored = read_stored_image(file, wanted);
  if (!transfer) transfer = declared_transfer(file.string(), stored.color_space);
  linearize(stored.image, transfer.value_or(stored.integers ? Transfer::srgb : Transfer::linear));
  return std::move(stored.image);
}

}  // namespace voxref
