#include "reference/light_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace voxref {

namespace {

constexpr float pi = std::numbers::pi_v<float>;
// Bins along an axis where a group may be cut: as in the paper.
constexpr int bin_count = 12;
// From here on groups are cut in halves, so that a way down fits in the bits of a trail: 2^24 lights more.
constexpr int most_uneven_depth = 40;
// Of one of two groups that both give something: a step of the numbers just below 1.
constexpr float least_share = 0x1p-24f;

Bounds joined(Bounds a, const Bounds& b) {
  if (b.empty()) return a;
  a.add(b.min);
  a.add(b.max);
  return a;
}

/// The smallest cone of axes around both.
LightBounds joined(const LightBounds& a, const LightBounds& b) {
  if (!(a.intensity > 0.0f)) return b;
  if (!(b.intensity > 0.0f)) return a;
  const LightBounds& wide = a.spread >= b.spread ? a : b;
  const LightBounds& narrow = a.spread >= b.spread ? b : a;
  LightBounds both = wide;
  both.box = joined(a.box, b.box);
  both.reach = std::max(a.reach, b.reach);
  both.intensity = a.intensity + b.intensity;
  const float angle = std::acos(std::clamp(glm::dot(wide.axis, narrow.axis), -1.0f, 1.0f));
  if (std::min(angle + narrow.spread, pi) <= wide.spread) return both;
  both.spread = 0.5f * (wide.spread + angle + narrow.spread);
  const glm::vec3 across = narrow.axis - glm::dot(wide.axis, narrow.axis) * wide.axis;
  if (both.spread >= pi || !(glm::length(across) > 0.0f)) {
    both.spread = pi;
    return both;
  }
  const float turn = both.spread - wide.spread;
  both.axis = glm::normalize(std::cos(turn) * wide.axis + std::sin(turn) * glm::normalize(across));
  return both;
}

/// Intensity x area of the box x solid angle into which the group shines, the paper's eq. 1 and 2.
float cost(const LightBounds& group) {
  if (!(group.intensity > 0.0f)) return 0.0f;
  const glm::vec3 side = group.box.extent();
  const float area = side.x * side.y + side.y * side.z + side.z * side.x;
  const float o = group.spread, w = std::min(o + group.reach, pi);
  const float angle =
      2.0f * pi * (1.0f - std::cos(o)) +
      0.5f * pi * (2.0f * w * std::sin(o) - std::cos(o - 2.0f * w) - 2.0f * o * std::sin(o) + std::cos(o));
  return group.intensity * area * angle;
}

}  // namespace

/// Builds the nodes depth first.
struct LightTree::Builder {
  LightTree& tree;
  std::span<const LightBounds> lights;

  LightBounds bounds(std::span<const uint32_t> group) const {
    LightBounds all;
    for (const uint32_t light : group) all = joined(all, lights[light]);
    return all;
  }

  void build(std::span<uint32_t> group, uint64_t trail, int depth) {
    const LightBounds all = bounds(group);
    const size_t index = tree.nodes_.size();
    const glm::vec3 extent = all.box.extent();
    tree.nodes_.push_back({.center = all.box.center(),
                           .radius_squared = 0.25f * glm::dot(extent, extent),
                           .axis = all.axis,
                           .cos_spread = std::cos(all.spread),
                           .sin_spread = std::sin(all.spread),
                           .cos_reach = std::max(std::cos(all.reach), 0.0f),  // of pi/2 rounding makes less
                           .intensity = all.intensity});
    if (group.size() == 1) {
      tree.nodes_[index].leaf = true;
      tree.nodes_[index].next = group[0];
      tree.trails_[group[0]] = trail;
      return;
    }
    const size_t first = cut(group, extent, depth);
    build(group.first(first), trail, depth + 1);
    tree.nodes_[index].next = static_cast<uint32_t>(tree.nodes_.size());
    build(group.subspan(first), trail | uint64_t{1} << depth, depth + 1);
  }

  /// Sorts the group in two parts, so that the sum of their costs is least. @returns the size of the first
  size_t cut(std::span<uint32_t> group, const glm::vec3& extent, int depth) const {
    Bounds centers;
    for (const uint32_t light : group) centers.add(lights[light].box.center());
    const float longest = std::max({extent.x, extent.y, extent.z});
    float least = std::numeric_limits<float>::infinity();
    int best_axis = 0, best_bin = -1;
    const auto bin_of = [&](uint32_t light, int axis) {
      const float place = (lights[light].box.center()[axis] - centers.min[axis]) / centers.extent()[axis];
      return std::clamp(static_cast<int>(place * bin_count), 0, bin_count - 1);
    };
    for (int axis = 0; axis < 3 && depth < most_uneven_depth; ++axis) {
      if (!(centers.extent()[axis] > 0.0f)) continue;
      std::array<LightBounds, bin_count> bins, above;
      for (const uint32_t light : group) {
        LightBounds& bin = bins[bin_of(light, axis)];
        bin = joined(bin, lights[light]);
      }
      above[bin_count - 1] = bins[bin_count - 1];
      for (int bin = bin_count - 2; bin > 0; --bin) above[bin] = joined(bins[bin], above[bin + 1]);
      LightBounds below;
      for (int bin = 0; bin + 1 < bin_count; ++bin) {
        below = joined(below, bins[bin]);
        if (!(below.intensity > 0.0f) || !(above[bin + 1].intensity > 0.0f)) continue;
        // Cutting across the longest side is preferred: thin groups are poorly bounded by spheres.
        const float total = longest / extent[axis] * (cost(below) + cost(above[bin + 1]));
        if (total < least) {
          least = total;
          best_axis = axis;
          best_bin = bin;
        }
      }
    }
    if (best_bin < 0) return group.size() / 2;
    const auto middle = std::stable_partition(group.begin(), group.end(),
                                              [&](uint32_t light) { return bin_of(light, best_axis) <= best_bin; });
    return static_cast<size_t>(middle - group.begin());
  }
};

LightTable::LightTable(std::span<const float> intensities) {
  assert(!intensities.empty() && intensities.size() <= most_lights);
  double total = 0.0, before = 0.0;
  for (const float intensity : intensities) total += intensity;
  constexpr double numbers = nowhere;
  begin_.fill(nowhere);
  const auto count = static_cast<double>(intensities.size());
  double end = 0.0;  // of the numbers given so far
  for (size_t i = 0; i < intensities.size(); ++i) {
    begin_[i] = static_cast<uint32_t>(end);
    before += intensities[i];
    const double left_for_others = count - 1.0 - static_cast<double>(i);
    const double begin = end;
    end = std::clamp(std::round(before / total * numbers), begin + 1.0, numbers - left_for_others);
    probability_[i] = static_cast<float>((end - begin) / numbers);
  }
}

LightTree::LightTree(std::span<const LightBounds> lights) : trails_(lights.size()), chosen_(lights.size()) {
  std::vector<uint32_t> group;
  for (uint32_t light = 0; light < lights.size(); ++light) {
    chosen_[light] = lights[light].intensity > 0.0f;
    if (chosen_[light]) group.push_back(light);
  }
  if (!group.empty()) Builder{*this, lights}.build(group, 0, 0);
}

// The paper's eq. 3. The group is seen within the angle u around the direction to its centre. The angle between its
// axes and the directions to the receiver is then at least theta - spread - u, that between the receiver's normal and
// the directions to the group at least theta_i - u; cosines of such differences come from the addition theorem. Within
// the sphere itself all directions are possible, and the distance counts as its radius, as the inverse square of the
// nearest light's would have no bound.
float LightTree::irradiance(const Node& node, const Receiver& receiver) {
  const glm::vec3 offset = node.center - receiver.position;
  const float distance_squared = glm::dot(offset, offset);
  const bool inside = distance_squared <= node.radius_squared;
  if (inside && distance_squared == 0.0f && node.radius_squared == 0.0f) return 0.0f;  // on the light itself
  const glm::vec3 to_light = offset / std::sqrt(std::max(distance_squared, std::numeric_limits<float>::min()));
  const float sin_u = inside ? 0.0f : std::sqrt(node.radius_squared / distance_squared);
  const float cos_u = inside ? -1.0f : std::sqrt(1.0f - sin_u * sin_u);
  // cos(max(0, a - b))
  const auto cos_less = [](float cos_a, float cos_b, float sin_b) {
    return cos_a >= cos_b ? 1.0f : cos_a * cos_b + std::sqrt(std::max(0.0f, 1.0f - cos_a * cos_a)) * sin_b;
  };
  const float cos_receiver = cos_less(glm::dot(receiver.normal, to_light), cos_u, sin_u);
  if (cos_receiver <= 0.0f) return 0.0f;
  const float cos_axis = -glm::dot(node.axis, to_light);
  const float cos_leaving = cos_less(cos_less(cos_axis, node.cos_spread, node.sin_spread), cos_u, sin_u);
  if (cos_leaving <= node.cos_reach) return 0.0f;
  return node.intensity * cos_leaving * cos_receiver / std::max(distance_squared, node.radius_squared);
}

float LightTree::irradiance(const Receiver& receiver) const {
  return nodes_.empty() ? 0.0f : irradiance(nodes_[0], receiver);
}

float LightTree::first_share(uint32_t node, const Receiver& receiver) const {
  const Node &one = nodes_[node + 1], &other = nodes_[nodes_[node].next];
  const float first = irradiance(one, receiver);
  const float second = irradiance(other, receiver);
  if (!(first + second > 0.0f)) return -1.0f;
  const float share = first / (first + second);
  // Rounding must not take from one of two that both give something all its chance.
  return first > 0.0f && second > 0.0f ? std::clamp(share, least_share, 1.0f - least_share) : share;
}

std::optional<LightChoice> LightTree::choose(const Receiver& receiver, double u) const {
  if (nodes_.empty()) return std::nullopt;
  constexpr double below_one = 1.0 - 0x1p-53;
  uint32_t node = 0;
  float probability = 1.0f;
  while (!nodes_[node].leaf) {
    const float share = first_share(node, receiver);
    if (share < 0.0f) return std::nullopt;
    if (u < share) {
      u = std::min(u / share, below_one);
      probability *= share;
      ++node;
    } else {
      u = std::min((u - share) / (1.0 - share), below_one);
      probability *= 1.0f - share;
      node = nodes_[node].next;
    }
  }
  return LightChoice{nodes_[node].next, probability, std::min(static_cast<float>(u), 0x1.fffffep-1f)};
}

float LightTree::probability(uint32_t light, const Receiver& receiver) const {
  if (!chosen_[light]) return 0.0f;
  uint32_t node = 0;
  float probability = 1.0f;
  for (uint64_t trail = trails_[light]; !nodes_[node].leaf; trail >>= 1) {
    const float share = first_share(node, receiver);
    if (share < 0.0f) return 0.0f;
    probability *= trail & 1 ? 1.0f - share : share;
    node = trail & 1 ? nodes_[node].next : node + 1;
  }
  return probability;
}

}  // namespace voxref
