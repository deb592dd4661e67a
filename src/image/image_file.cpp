// The one file that knows about image files.
#include "image/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

#include "error.h"
#include "file.h"

namespace voxref {

namespace {

/// OpenImageIO wants pixels interleaved; voxref keeps planes.
std::vector<float> interleave(const Image& image) {
  const size_t channels = image.channels().size();
  std::vector<float> pixels(channels * image.pixel_count());
  for (size_t c = 0; c < channels; ++c) {
    const std::span<const float> plane = image.channel(image.channels()[c]);
    for (size_t i = 0; i < plane.size(); ++i) pixels[i * channels + c] = plane[i];
  }
  return pixels;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
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

Image read_image(const std::filesystem::path& file) {
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
  if (!input) throw Error(file.string(), "cannot be read as an image: " + OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  Image image(spec.width, spec.height);
  const size_t channels = spec.channelnames.size();
  std::vector<float> pixels(channels * image.pixel_count());
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
    throw Error(file.string(), "cannot be read as an image: " + input->geterror());
  for (size_t c = 0; c < channels; ++c) {
    const std::span<float> plane = image.add(spec.channelnames[c]);
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = pixels[i * channels + c];
  }
  for (const OIIO::ParamValue& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING)
      image.attributes[attribute.name().string()] = attribute.get_string();
  return image;
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
