#include "voxel/average_envelope.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>

#include "parallel.h"
#include "voxel/raster_fragments.h"
#include "voxel/running_average.h"

namespace voxref {

namespace {

constexpr size_t most_states = 1 << 16;  // some milliseconds

/// One step of the running average of one channel. It rises with both arguments, as long as nothing wraps.
uint8_t averaged(uint8_t before, size_t count, float value) {
  RunningAverage8 average{{before, 0, 0}, uint8_t(count)};
  average.add(glm::vec3(value, 0.0f, 0.0f));
  return average.value[0];
}

/// Least and greatest over all orders: over all states, that is, how many of each different value were averaged so far.
/// A step rises with the byte before it, so that only the least and the greatest byte of each state matter.
AverageEnvelope exact_envelope(const std::map<float, size_t>& values, size_t states) {
  std::vector<AverageEnvelope> reached(states, AverageEnvelope{255, 0, true});
  reached[0] = {0, 0, true};
  for (size_t state = 0; state < states; ++state) {
    size_t count = 0, rest = state;
    for (const auto& [value, times] : values) {
      count += rest % (times + 1);
      rest /= times + 1;
    }
    size_t stride = 1;
    for (const auto& [value, times] : values) {
      if (state / stride % (times + 1) < times) {
        AverageEnvelope& next = reached[state + stride];
        next.least = std::min(next.least, averaged(reached[state].least, count, value));
        next.greatest = std::max(next.greatest, averaged(reached[state].greatest, count, value));
      }
      stride *= times + 1;
    }
  }
  return reached.back();
}

// With V_k = 255 v_k and c_0 = 0 each step gives
//
//   k c_k + V - (k + 1)  <  (k + 1) c_(k+1)  <=  k c_k + V + e,
//
// where e is what float32 rounds up, below 0.004 (c k < 2^16). Summed over n steps:
//
//   mean V - (n + 1) / 2  <  c_n  <=  mean V + e.
//
// And an average of numbers never leaves their range, rounded down.
AverageEnvelope bounded_envelope(std::span<const float> values) {
  constexpr double rounding = 0.004;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double least = std::floor(*low * 255.0f), greatest = std::floor(*high * 255.0f);
  if (values.size() > 255) return {uint8_t(least), uint8_t(greatest), false};  // the count wraps and starts anew
  const double n = double(values.size()), mean = 255.0 * std::accumulate(values.begin(), values.end(), 0.0) / n;
  return {uint8_t(std::max(least, std::floor(mean - (n + 1.0) / 2.0))),
          uint8_t(std::min(greatest, std::floor(mean + rounding))), false};
}

/// A fragment on its own.
struct VoxelFragment {
  glm::ivec3 voxel;
  FragmentValue value;
};

bool before(const VoxelFragment& a, const VoxelFragment& b) { return voxref::before(a.voxel, b.voxel); }

std::array<AverageEnvelope, 3> envelopes(std::span<const VoxelFragment> fragments, glm::vec3 FragmentValue::*value) {
  std::array<AverageEnvelope, 3> result;
  std::vector<float> values(fragments.size());
  for (int channel = 0; channel < 3; ++channel) {
    std::ranges::transform(fragments, values.begin(),
                           [&](const VoxelFragment& f) { return (f.value.*value)[channel]; });
    result[size_t(channel)] = average_envelope(values);
  }
  return result;
}

/// The fragments of each voxel side by side. Those of dynamic objects in static voxels are left out where static ones
/// win.
std::vector<VoxelFragment> sorted_fragments(const Scene& scene, const Grid& grid, bool static_wins,
                                            const Progress& progress) {
  std::vector<VoxelFragment> all;
  for (const bool dynamic : {false, true}) {
    const size_t fixed = all.size();
    for (const VoxelFragments& chunk : draw_fragments(scene, grid, dynamic, progress))
      for (const VoxelFragments::Fragment& drawn : chunk.fragments) {
        const VoxelFragment fragment{glm::ivec3(drawn.voxel), chunk.values[drawn.value]};
        if (!dynamic || !static_wins ||
            !std::binary_search(all.begin(), all.begin() + std::ptrdiff_t(fixed), fragment, before))
          all.push_back(fragment);
      }
    if (!dynamic) std::stable_sort(all.begin(), all.end(), before);
  }
  std::stable_sort(all.begin(), all.end(), before);
  return all;
}

}  // namespace

AverageEnvelope average_envelope(std::span<const float> values) {
  assert(!values.empty());
  // What is no number, or wraps, lets a byte be anything.
  if (!std::ranges::all_of(values, [](float v) { return v >= 0.0f && v * 255.0f < 256.0f; })) return {0, 255, false};
  std::map<float, size_t> times;
  for (const float value : values) ++times[value];
  size_t states = 1;
  for (const auto& [value, count] : times) states = std::min(states * (count + 1), most_states + 1);
  if (values.size() > 255 || states > most_states) return bounded_envelope(values);
  return exact_envelope(times, states);
}

std::vector<VoxelEnvelope> raster_envelopes(const Scene& scene, const Grid& grid, bool static_wins,
                                            const Progress& progress) {
  const std::vector<VoxelFragment> fragments = sorted_fragments(scene, grid, static_wins, progress);
  std::vector<size_t> first;  // of each voxel
  for (size_t i = 0; i < fragments.size(); ++i)
    if (i == 0 || before(fragments[i - 1], fragments[i])) first.push_back(i);
  first.push_back(fragments.size());

  std::vector<VoxelEnvelope> result(first.size() - 1);
  parallel_for(result.size(), 256, [&](size_t begin, size_t end) {
    progress.check();
    for (size_t i = begin; i < end; ++i) {
      const std::span<const VoxelFragment> own(fragments.data() + first[i], first[i + 1] - first[i]);
      result[i] = {own[0].voxel, uint8_t(own.size()), envelopes(own, &FragmentValue::albedo),
                   envelopes(own, &FragmentValue::normal), envelopes(own, &FragmentValue::emission)};
    }
  });
  return result;
}

}  // namespace voxref
