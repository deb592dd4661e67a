#include "compare/mistakes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "image/transfer.h"

namespace voxref {

namespace {

constexpr std::array<char, 3> axis_names = {'x', 'y', 'z'};

bool inside(const glm::ivec3& v, const glm::ivec3& size) {
  return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < size.x && v.y < size.y && v.z < size.z;
}

std::string turned_name(const glm::ivec3& axes, const glm::bvec3& flips) {
  std::string name;
  if (axes != glm::ivec3(0, 1, 2)) {
    name = "axes swapped: ";
    for (int k = 0; k < 3; ++k) name += axis_names[size_t(axes[k])];
    name += " stored as xyz";
  }
  for (int k = 0; k < 3; ++k)
    if (flips[k]) name += fmt::format("{}{} flipped", name.empty() ? "" : ", ", axis_names[size_t(k)]);
  return name;
}

/// The 48 symmetries of the grid, simplest first; of a picture, which has one slice, the 8 that keep it one.
void add_turns(std::vector<Placement>& all, const glm::ivec3& size) {
  constexpr std::array<std::array<int, 3>, 6> orders = {
      {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}}};
  for (const auto& order : orders) {
    const glm::ivec3 axes(order[0], order[1], order[2]);
    if (size.z == 1 && axes.z != 2) continue;
    for (int bits = 0; bits < 8; ++bits) {
      const glm::bvec3 flips(bits & 1, bits & 2, bits & 4);
      if (size.z == 1 && flips.z) continue;
      if (bits == 0 && axes == glm::ivec3(0, 1, 2)) continue;
      all.push_back({turned_name(axes, flips), axes, flips});
    }
  }
}

void add_shifts(std::vector<Placement>& all, const glm::ivec3& size) {
  const char* texel = size.z == 1 ? "pixel" : "voxel";
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const glm::ivec3 step(x, y, z);
        if (step == glm::ivec3(0) || (size.z == 1 && z != 0)) continue;
        Placement whole, half;
        whole.mistake = fmt::format("shifted by ({}, {}, {}) {}", x, y, z, texel);
        whole.shift = step;
        half.mistake = fmt::format("shifted by half a {} towards ({}, {}, {})", texel, -x, -y, -z);
        half.half = step;
        all.push_back(std::move(whole));
        all.push_back(std::move(half));
      }
}

constexpr float never = std::numeric_limits<float>::infinity();

template <class Function>
Recoding of_colors(std::string mistake, Function&& function, float clips_above = never) {
  return {std::move(mistake),
          [function](const glm::vec4& t) { return glm::vec4(function(t.r), function(t.g), function(t.b), t.a); },
          clips_above};
}

void add_channel_orders(std::vector<Recoding>& all) {
  constexpr std::array<std::array<int, 3>, 5> orders = {{{2, 1, 0}, {1, 0, 2}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}}};
  constexpr std::array<char, 3> names = {'R', 'G', 'B'};
  for (const auto& order : orders) {
    std::string stored;
    for (const int c : order) stored += names[size_t(c)];
    all.push_back({stored + " stored as RGB",
                   [order](const glm::vec4& t) {
                     glm::vec4 undone = t;
                     for (int c = 0; c < 3; ++c) undone[order[size_t(c)]] = t[c];
                     return undone;
                   },
                   never});
  }
}

void add_factors(std::vector<Recoding>& all, double factor) {
  struct Named {
    double value;
    const char* mistake;
  };
  constexpr double pi = std::numbers::pi;
  constexpr std::array<Named, 6> named = {{{1.0 / pi, "missing 1/pi"},
                                           {pi, "1/pi applied twice"},
                                           {0.25 / pi, "missing 1/(4 pi)"},
                                           {255.0, "bytes divided by 255 twice"},
                                           {1.0 / 255.0, "bytes not divided by 255"},
                                           {2.0 * pi, "divided by 2 pi too often"}}};
  for (const Named& n : named) all.push_back(of_colors(n.mistake, [f = float(n.value)](float v) { return f * v; }));
  if (std::isfinite(factor) && factor > 0.0)
    all.push_back(of_colors(fmt::format("a constant factor: {:.5g} times the reference", 1.0 / factor),
                            [f = float(factor)](float v) { return f * v; }));
}

}  // namespace

bool Placement::source(const glm::ivec3& place, const glm::ivec3& source_size, glm::ivec3& from) const {
  for (int k = 0; k < 3; ++k) {
    from[k] = place[axes[k]];
    if (flips[k]) from[k] = source_size[k] - 1 - from[k];
    from[k] += shift[k];
  }
  return inside(from, source_size);
}

glm::ivec3 Placement::result_size(const glm::ivec3& source_size) const {
  glm::ivec3 size;
  for (int k = 0; k < 3; ++k) size[axes[k]] = source_size[k];
  return size;
}

std::vector<Placement> placements(const glm::ivec3& size) {
  std::vector<Placement> all(1);
  add_turns(all, size);
  add_shifts(all, size);
  return all;
}

std::vector<Recoding> recodings(int channels, double factor) {
  std::vector<Recoding> all = {{"", [](const glm::vec4& t) { return t; }, never}};
  if (channels >= 3) add_channel_orders(all);
  constexpr float white = 0.999f;  // an encoded value that may have been clipped
  all.push_back(of_colors("encoded as sRGB once too often", srgb_decode, white));
  all.push_back(of_colors("decoded from sRGB once too often", [](float v) { return srgb_encode(v); }));
  all.push_back(of_colors(
      "gamma 2.2 applied once too often", [](float v) { return v > 0.0f ? std::pow(v, 2.2f) : v; }, white));
  all.push_back(
      of_colors("gamma 2.2 undone once too often", [](float v) { return v > 0.0f ? std::pow(v, 1.0f / 2.2f) : v; }));
  all.push_back(of_colors("stored as 0.5 v + 0.5", [](float v) { return 2.0f * v - 1.0f; }));
  all.push_back(of_colors("not decoded from 0.5 v + 0.5, or decoded twice", [](float v) { return 0.5f * v + 0.5f; }));
  all.push_back(of_colors("of the opposite sign", [](float v) { return -v; }));
  if (channels == 4) {
    all.push_back({"premultiplied by alpha",
                   [](const glm::vec4& t) { return t.a > 0.0f ? glm::vec4(glm::vec3(t) / t.a, t.a) : t; }, never});
    all.push_back(
        {"not premultiplied by alpha", [](const glm::vec4& t) { return glm::vec4(glm::vec3(t) * t.a, t.a); }, never});
  }
  add_factors(all, factor);
  return all;
}

std::string Mistake::name() const {
  const bool both = !placement->mistake.empty() && !recoding->mistake.empty();
  return placement->mistake + (both ? ", and " : "") + recoding->mistake;
}

bool Mistake::undo(const Field& a, const Field& b, const glm::ivec3& place, glm::vec4& undone,
                   glm::vec4& reference) const {
  glm::ivec3 from;
  if (!placement->source(place, a.size, from)) return false;
  const glm::vec4 stored = a.texel(from);
  for (int c = 0; c < std::min(a.channels, 3); ++c)
    if (stored[c] >= recoding->clips_above) return false;
  undone = recoding->undo(stored);
  reference = b.texel(place);
  if (placement->half == glm::ivec3(0)) return true;
  const glm::ivec3 neighbour = place + placement->half;
  if (!inside(neighbour, b.size)) return false;
  reference = 0.5f * (reference + b.texel(neighbour));
  return true;
}

}  // namespace voxref
