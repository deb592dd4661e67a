#include "reference/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/exponential.hpp>

#include "parallel.h"

namespace voxref {

namespace {

constexpr size_t pixels_per_task = 4096;

double luminance(const glm::dvec3& rgb) { return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b; }

void set(const std::array<std::span<float>, 3>& layer, size_t pixel, const glm::dvec3& value) {
  for (int i = 0; i < 3; ++i) layer[i][pixel] = static_cast<float>(value[i]);
}

}  // namespace

Film::Film(int width, int height, const ExtraLayers& extra)
    : width_(width),
      height_(height),
      pixels_(static_cast<size_t>(width) * static_cast<size_t>(height)),
      extra_layers_(extra),
      extra_(pixels_.size() * extra.count()) {}

void Film::add(std::span<const PixelBatch> batches, int samples, std::span<const glm::vec3> extra) {
  assert(batches.size() == pixels_.size() && extra.size() == extra_.size() && samples > 0);
  const double n = samples;
  parallel_for(pixels_.size(), pixels_per_task, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const PixelBatch& batch = batches[i];
      Pixel& pixel = pixels_[i];
      const glm::dvec3 emission = n * glm::dvec3(batch.layers.emission);
      const glm::dvec3 direct = n * glm::dvec3(batch.layers.direct);
      const glm::dvec3 indirect = n * glm::dvec3(batch.layers.indirect);
      pixel.emission += emission;
      pixel.direct += direct;
      pixel.indirect += indirect;
      const glm::dvec3 total = direct + indirect + emission;
      const std::array<double, quantity_count> values = {total.r, total.g, total.b, luminance(total),
                                                         luminance(indirect)};
      for (int q = 0; q < quantity_count; ++q) {
        pixel.moments[q].sum += values[q];
        pixel.moments[q].weighted_sum += n * values[q];
        pixel.moments[q].square_sum += values[q] * values[q];
      }
      pixel.hits += n * batch.hit_share;
      pixel.albedo += n * glm::dvec3(batch.albedo);
      pixel.normal += n * glm::dvec3(batch.normal);
      pixel.depth += n * batch.depth;
    }
  });
  for (size_t i = 0; i < extra.size(); ++i) extra_[i] += n * glm::dvec3(extra[i]);
  samples_ += samples;
  square_samples_ += n * n;
  ++passes_;
}

/// Squared standard error of the mean. One pass has no scatter: its own value stands for "unknown, all of it".
double Film::variance(const Moments& moments) const {
  const double mean = this->mean(moments);
  if (passes_ < 2) return mean * mean;
  const double scatter = moments.square_sum - 2.0 * mean * moments.weighted_sum + mean * mean * square_samples_;
  // Without scatter rounding may leave a little less than nothing.
  return std::max(scatter, 0.0) / (static_cast<double>(samples_) * samples_ - square_samples_);
}

double Film::noise() const {
  double error = 0.0, value = 0.0;
  for (const Pixel& pixel : pixels_) {
    error += std::sqrt(variance(pixel.moments[total_y]));
    value += mean(pixel.moments[total_y]);
  }
  return error == 0.0 ? 0.0 : error / value;
}

glm::vec3 Film::mean() const {
  glm::dvec3 sum(0.0);
  for (const Pixel& pixel : pixels_)
    for (int q = red; q <= blue; ++q) sum[q] += mean(pixel.moments[q]);
  return sum / static_cast<double>(pixels_.size());
}

glm::vec3 Film::mean_stderr() const {
  glm::dvec3 sum(0.0);
  for (const Pixel& pixel : pixels_)
    for (int q = red; q <= blue; ++q) sum[q] += variance(pixel.moments[q]);
  return glm::sqrt(sum) / static_cast<double>(pixels_.size());
}

Image Film::image() const {
  Image image(width_, height_);
  for (const char* layer : {"", "stderr", "direct", "indirect", "emission", "albedo"}) image.add_layer(layer);
  for (const char* channel : {"samples", "stderr.Y", "stderr.indirect.Y", "N.X", "N.Y", "N.Z", "Z"}) image.add(channel);
  const auto total = image.layer(""), error = image.layer("stderr");
  const auto direct = image.layer("direct"), indirect = image.layer("indirect"), emission = image.layer("emission");
  const auto albedo = image.layer("albedo");
  const std::array<std::span<float>, 3> normal = {image.channel("N.X"), image.channel("N.Y"), image.channel("N.Z")};
  const std::span<float> samples = image.channel("samples"), depth = image.channel("Z");
  const std::span<float> error_y = image.channel("stderr.Y"), error_indirect_y = image.channel("stderr.indirect.Y");
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& pixel = pixels_[i];
    const double n = samples_;
    set(direct, i, pixel.direct / n);
    set(indirect, i, pixel.indirect / n);
    set(emission, i, pixel.emission / n);
    for (int c = 0; c < 3; ++c) {
      total[c][i] = direct[c][i] + indirect[c][i] + emission[c][i];
      error[c][i] = static_cast<float>(std::sqrt(variance(pixel.moments[c])));
    }
    error_y[i] = static_cast<float>(std::sqrt(variance(pixel.moments[total_y])));
    error_indirect_y[i] = static_cast<float>(std::sqrt(variance(pixel.moments[indirect_y])));
    samples[i] = static_cast<float>(samples_);
    const double hits = pixel.hits > 0.0 ? pixel.hits : 1.0;
    set(albedo, i, pixel.albedo / hits);
    set(normal, i, pixel.normal / hits);
    depth[i] = static_cast<float>(pixel.depth / hits);
  }
  add_extra_layers(image);
  return image;
}

void Film::save(StateWriter& writer) const {
  writer.value(samples_);
  writer.value(passes_);
  writer.value(square_samples_);
  writer.values(std::span(pixels_));
  writer.values(std::span(extra_));
}

void Film::load(StateReader& reader) {
  reader.value(samples_);
  reader.value(passes_);
  reader.value(square_samples_);
  reader.values(std::span(pixels_));
  reader.values(std::span(extra_));
}

void Film::add_extra_layers(Image& image) const {
  const std::vector<std::string> names = extra_layers_.names();
  for (size_t layer = 0; layer < names.size(); ++layer) {
    image.add_layer(names[layer]);
    const auto planes = image.layer(names[layer]);
    const bool of_hits =
        names[layer] == "irradiance";  // only a surface has it; bounces are shares of the pixel's light
    for (size_t i = 0; i < pixels_.size(); ++i) {
      const double samples = of_hits ? std::max(pixels_[i].hits, 1.0) : samples_;
      set(planes, i, extra_[i * names.size() + layer] / samples);
    }
  }
}

}  // namespace voxref
