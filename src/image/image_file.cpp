// The one file that knows about image files.
#include "image/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "error.h"
#include "file.h"
#include "parallel.h"

namespace voxref {

namespace {

/// OpenImageIO's messages may have several lines; ours have one.
std::string one_line(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) message.pop_back();
  std::ranges::replace(message, '\n', ' ');
  return message;
}

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw Error(file, "cannot be read as an image: " + one_line(why));
}

/// No compression that OpenImageIO knows packs a picture tighter; without the check a damaged header of a few bytes
/// could ask for all memory.
constexpr uint64_t tightest_packing = 1 << 16;

/// Where the pixels of a file lie in its picture.
struct Window {
  int left = 0, top = 0;      ///< of the first pixel that the file holds
  int width = 0, height = 0;  ///< of the picture
  bool operator==(const Window&) const = default;
};

/// OpenEXR's data window within its display window. Other formats' offsets are places on a page of paper.
Window window_of(const OIIO::ImageInput& input, const std::string& file) {
  const OIIO::ImageSpec& spec = input.spec();
  if (std::string_view(input.format_name()) != "openexr") return {0, 0, spec.width, spec.height};
  const Window window{spec.x - spec.full_x, spec.y - spec.full_y, spec.full_width, spec.full_height};
  if (window.left < 0 || window.top < 0 || spec.width > window.width - window.left ||
      spec.height > window.height - window.top)
    refuse(file, "it has pixels outside its display window");
  return window;
}

void require_plausible(const std::string& file, const OIIO::ImageSpec& spec, const Window& window) {
  if (spec.deep || spec.depth > 1) refuse(file, "it holds more than one value per pixel and channel");
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(file, error);
  const auto pixels =
      static_cast<uint64_t>(std::max(window.width, 0)) * static_cast<uint64_t>(std::max(window.height, 0));
  if (!error && pixels * spec.pixel_bytes(/*native=*/true) / tightest_packing > bytes)
    refuse(file, "its header asks for " + std::to_string(window.width) + "x" + std::to_string(window.height) +
                     " pixels, which no file of " + std::to_string(bytes) + " bytes can hold");
}

/// The pixels that a file holds, at their place in its picture.
std::vector<float> placed(const std::vector<float>& pixels, const OIIO::ImageSpec& spec, const Window& window,
                          size_t channels) {
  std::vector<float> picture(channels * static_cast<size_t>(window.width) * static_cast<size_t>(window.height), 0.0f);
  const size_t row = channels * static_cast<size_t>(spec.width);
  for (int y = 0; y < spec.height; ++y) {
    const size_t to =
        static_cast<size_t>(window.top + y) * static_cast<size_t>(window.width) + static_cast<size_t>(window.left);
    std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(row * static_cast<size_t>(y)), row,
                picture.begin() + static_cast<std::ptrdiff_t>(channels * to));
  }
  return picture;
}

/// OpenImageIO has threads of its own, and OpenEXR its own again.
void limit_threads() {
  OIIO::attribute("threads", thread_count());
  OIIO::attribute("exr_threads", thread_count());
}

/// The channels' names; those of a further part that have no layer, or are there already, get the part's name as layer.
std::vector<std::string> channel_names(const OIIO::ImageSpec& spec, const Image& image, int part) {
  std::vector<std::string> names = spec.channelnames;
  if (part == 0) return names;
  const std::string layer = spec.get_string_attribute("oiio:subimagename", std::to_string(part));
  for (std::string& name : names)
    if (name.find('.') == name.npos || image.has(name)) name = channel_name(layer, name);
  return names;
}

/// Reads the part that `input` stands at, from the first wanted channel to the last.
void add_part(OIIO::ImageInput& input, const std::string& file, int part, Image& image, const ChannelFilter& wanted) {
  const OIIO::ImageSpec& spec = input.spec();
  const Window window = window_of(input, file);
  require_plausible(file, spec, window);
  if (window.width != image.width() || window.height != image.height())
    refuse(file, "part " + std::to_string(part) + " has another size than part 0");
  const std::vector<std::string> names = channel_names(spec, image, part);
  const auto is_wanted = [&](const std::string& name) { return !wanted || wanted(name); };
  const auto first = std::ranges::find_if(names, is_wanted);
  if (first == names.end()) return;
  const auto end = std::find_if(names.rbegin(), names.rend(), is_wanted).base();
  for (auto name = first; name != end; ++name)
    if (is_wanted(*name) && (image.has(*name) || std::find(first, name, *name) != name))
      refuse(file, "channel '" + *name + "' is there twice");
  const std::span<const std::string> read(first, end);
  std::vector<float> pixels(read.size() * static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height));
  if (!input.read_image(part, 0, int(first - names.begin()), int(end - names.begin()), OIIO::TypeDesc::FLOAT,
                        pixels.data()))
    refuse(file, input.geterror());
  const bool whole = window == Window{0, 0, spec.width, spec.height};
  add_interleaved(image, whole ? pixels : placed(pixels, spec, window, read.size()), read, wanted);
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
  limit_threads();
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    OIIO::ImageSpec spec(image.width(), image.height(), static_cast<int>(image.channels().size()),
                         OIIO::TypeDesc::FLOAT);
    spec.channelnames = image.channels();
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    for (const auto& [name, text] : image.attributes) spec.attribute(name, text);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("exr");
    if (!output) throw Error(file.string(), "cannot be written: " + OIIO::geterror());
    const std::vector<float> pixels = interleave(image);
    if (!output->open(temporary.string(), spec) || !output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) ||
        !output->close())
      throw Error(file.string(), "cannot be written: " + output->geterror());
  });
}

StoredImage read_stored_image(const std::filesystem::path& path, const ChannelFilter& wanted) {
  const std::string file = path.string();
  limit_threads();
  // Otherwise readers multiply colours by alpha, some of them before they undo the transfer.
  OIIO::ImageSpec as_stored;
  as_stored.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file, &as_stored);
  if (!input) refuse(file, OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  const Window window = window_of(*input, file);
  require_plausible(file, spec, window);
  StoredImage stored{image_for_file(file, size_t(std::max(window.width, 0)), size_t(std::max(window.height, 0))),
                     !spec.format.is_floating_point(), spec.get_string_attribute("oiio:ColorSpace")};
  for (const OIIO::ParamValue& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING)
      stored.image.attributes[attribute.name().string()] = attribute.get_string();
  // What further images of other formats are, thumbnails for instance, is no layer of the first.
  const bool parts = std::string_view(input->format_name()) == "openexr";
  for (int part = 0; part == 0 || (parts && input->seek_subimage(part, 0)); ++part)
    add_part(*input, file, part, stored.image, wanted);
  return stored;
}

Image read_image(const std::filesystem::path& file) { return read_stored_image(file).image; }

uint64_t yee_difference(const Image& a, const Image& b, float exposure) {
  limit_threads();
  const auto shown = [&](const Image& image) {
    const auto planes = image.layer("");
    const float scale = std::exp2(exposure);
    OIIO::ImageBuf buffer(OIIO::ImageSpec(image.width(), image.height(), 3, OIIO::TypeDesc::FLOAT));
    for (OIIO::ImageBuf::Iterator<float> pixel(buffer); !pixel.done(); ++pixel) {
      const size_t i = size_t(pixel.y()) * size_t(image.width()) + size_t(pixel.x());
      for (int c = 0; c < 3; ++c) pixel[c] = std::clamp(planes[size_t(c)][i] * scale, 0.0f, 1.0f);
    }
    return buffer;
  };
  OIIO::ImageBufAlgo::CompareResults result;
  return static_cast<uint64_t>(OIIO::ImageBufAlgo::compare_Yee(shown(a), shown(b), result));
}

std::vector<uint8_t> encode_png(int width, int height, std::span<const uint8_t> rgb) {
  std::vector<uint8_t> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
  if (!output || !output->set_ioproxy(&memory) || !output->open("picture.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !output->close())
    throw Error("PNG picture", "cannot be encoded: " + (output ? output->geterror() : OIIO::geterror()));
  return file;
}

std::vector<uint8_t> display_bytes(const Image& image, std::string_view layer, float exposure) {
  const std::array<std::span<const float>, 3> planes = image.layer(layer);
  const float scale = std::exp2(exposure);
  std::vector<uint8_t> bytes(3 * image.pixel_count());
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      // NaN fails the comparison and becomes 0 here; finding NaNs is the metrics' job, not the picture's.
      const float value = planes[c][i] * scale;
      const float clipped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
      bytes[3 * i + c] = static_cast<uint8_t>(std::lround(255.0f * srgb_encode(clipped)));
    }
  return bytes;
}

}  // namespace voxref
