#include "compare/select_layer.h"

#include <algorithm>
#include <array>
#include <optional>

#include "error.h"
#include "image/planes.h"

namespace voxref {

namespace {

std::optional<Planes> triple(const Image& image, const std::string& layer, const std::array<const char*, 3>& names) {
  Planes planes;
  for (size_t c = 0; c < 3; ++c) {
    const std::string name = channel_name(layer, names[c]);
    if (!image.has(name)) return std::nullopt;
    planes[c] = image.channel(name);
  }
  return planes;
}

/// What one term of the expression stands for.
Planes term_of(const Image& image, const std::string& term) {
  if (const auto colors = triple(image, term, {"R", "G", "B"})) return *colors;
  if (const auto vector = triple(image, term, {"X", "Y", "Z"}); vector && !term.empty()) return *vector;
  const std::string single = !term.empty()                  ? term
                             : image.has("Y")               ? "Y"
                             : image.channels().size() == 1 ? image.channels().front()
                                                            : term;
  if (!single.empty() && image.has(single)) {
    const std::span<const float> plane = image.channel(single);
    return {plane, plane, plane};
  }
  std::string channels;
  for (const std::string& name : image.channels()) channels += (channels.empty() ? "" : ", ") + name;
  throw Error("layer '" + term + "'", "not in an image with the channels " + channels);
}

void copy_errors(Image& result, const Image& image, const std::string& layer) {
  const auto copy = [&](const std::string& from, const std::string& to) {
    if (image.has(from)) std::ranges::copy(image.channel(from), result.add(to).begin());
  };
  if (layer.empty())
    for (const char* channel : {"R", "G", "B"}) copy(channel_name("stderr", channel), channel_name("stderr", channel));
  copy(layer.empty() ? "stderr.Y" : "stderr." + layer + ".Y", "stderr.Y");
}

}  // namespace

Image select_layer(const Image& image, const std::string& expression) {
  Image result(image.width(), image.height());
  result.attributes = image.attributes;
  result.add_layer("");
  const auto sum = result.layer("");
  for (size_t begin = 0; begin <= expression.size();) {
    const size_t end = std::min(expression.find('+', begin), expression.size());
    const Planes term = term_of(image, expression.substr(begin, end - begin));
    for (size_t c = 0; c < 3; ++c)
      std::ranges::transform(term[c], sum[c], sum[c].begin(), [](float x, float y) { return x + y; });
    begin = end + 1;
  }
  if (expression.find('+') == std::string::npos) copy_errors(result, image, expression);
  return result;
}

bool layer_needs(const std::string& expression, std::string_view channel) {
  if (channel.starts_with("stderr")) return true;
  if (expression.empty()) return channel.find('.') == channel.npos;
  for (size_t begin = 0; begin <= expression.size();) {
    const size_t end = std::min(expression.find('+', begin), expression.size());
    const std::string term = expression.substr(begin, end - begin);
    if (channel == term || channel.starts_with(term + ".") || (term.empty() && channel.find('.') == channel.npos))
      return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace voxref
