#include "compare/causes.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "parallel.h"

namespace voxref {

namespace {

constexpr size_t most_samples = 16384;  // places that rank the mistakes; the judge sees all
constexpr double halved = 0.5;          // of the difference must be gone before the judge is asked
constexpr size_t most_judged = 6;       // candidates, the best first

struct Candidate {
  Mistake mistake;
  double before = 0.0, after = 0.0;
};

double relative_difference(const glm::vec4& a, const glm::vec4& b, int channels) {
  double difference = 0.0, sum = 0.0;
  for (int c = 0; c < channels; ++c) {
    difference += std::abs(double{a[c]} - double{b[c]});
    sum += std::abs(double{a[c]}) + std::abs(double{b[c]});
  }
  return sum > 0.0 ? difference / sum : 0.0;
}

bool empty(const glm::vec4& texel, int channels) {
  for (int c = 0; c < channels; ++c)
    if (texel[c] != 0.0f) return false;
  return true;
}

/// Evenly spread over the reference's places that are not empty.
std::vector<glm::ivec3> sample_places(const Field& b) {
  std::vector<size_t> filled;
  for (size_t i = 0; i < b.texel_count(); ++i)
    if (!empty(b.texel(b.place(i)), b.channels)) filled.push_back(i);
  std::vector<glm::ivec3> places;
  const size_t count = std::min(filled.size(), most_samples);
  for (size_t k = 0; k < count; ++k) places.push_back(b.place(filled[k * filled.size() / count]));
  return places;
}

float median_magnitude(const Field& field) {
  std::vector<float> values;
  const size_t stride = std::max<size_t>(1, field.texel_count() / most_samples);
  for (size_t i = 0; i < field.texel_count(); i += stride)
    for (int c = 0; c < std::min(field.channels, 3); ++c)
      if (const float v = std::abs(field.values[i * size_t(field.channels) + size_t(c)]); v > 0.0f) values.push_back(v);
  if (values.empty()) return 0.0f;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Whether most of the difference is gone; fills in how much there was and is.
bool helps(Candidate& candidate, const Field& a, const Field& b, const std::vector<glm::ivec3>& places) {
  double before = 0.0, after = 0.0;
  size_t count = 0;
  const bool same_size = a.size == b.size;
  for (const glm::ivec3& place : places) {
    glm::vec4 undone, reference;
    if (!candidate.mistake.undo(a, b, place, undone, reference)) continue;
    ++count;
    after += relative_difference(undone, reference, b.channels);
    before += same_size ? relative_difference(a.texel(place), b.texel(place), b.channels) : 1.0;
  }
  if (2 * count < places.size()) return false;  // told by less than half: a shift out of the picture, a clipped image
  candidate.before = before / double(count);
  candidate.after = after / double(count);
  return candidate.after < halved * candidate.before;
}

/// Drops the candidates that do not help.
void keep_helpful(std::vector<Candidate>& candidates, const Field& a, const Field& b,
                  const std::vector<glm::ivec3>& places, const Progress& progress) {
  std::vector<uint8_t> helpful(candidates.size());
  parallel_for(candidates.size(), 1, [&](size_t i, size_t) {
    progress.check();
    progress("looking for the cause", 0.5 * double(i) / double(candidates.size()));
    helpful[i] = helps(candidates[i], a, b, places);
  });
  std::vector<Candidate> kept;
  for (size_t i = 0; i < candidates.size(); ++i)
    if (helpful[i]) kept.push_back(candidates[i]);
  candidates = std::move(kept);
}

struct Count {
  size_t compared = 0, agreeing = 0;
};

/// Of every stride-th place that is not empty, how many agree once the mistake is undone.
Count agreement(const Mistake& mistake, const Field& a, const Field& b, const Tolerance& tolerance, size_t stride) {
  constexpr size_t grain = 1 << 14;
  const size_t places = (b.texel_count() + stride - 1) / stride;
  std::vector<Count> counts((places + grain - 1) / grain);
  parallel_for(places, grain, [&](size_t begin, size_t end) {
    Count& count = counts[begin / grain];
    for (size_t i = begin; i < end; ++i) {
      glm::vec4 undone, reference;
      if (!mistake.undo(a, b, b.place(stride * i), undone, reference)) continue;
      if (empty(undone, b.channels) && empty(reference, b.channels)) continue;
      bool agrees = true;
      for (int c = 0; c < b.channels; ++c) agrees &= tolerance.accepts(undone[c], reference[c]);
      ++count.compared;
      count.agreeing += agrees;
    }
  });
  Count all;
  for (const Count& count : counts) {
    all.compared += count.compared;
    all.agreeing += count.agreeing;
  }
  return all;
}

std::vector<Cause> judged(std::vector<Candidate> candidates, const std::function<bool(const Mistake&)>& vanishes,
                          const Progress& progress) {
  const auto better = [](const Candidate& x, const Candidate& y) { return x.after < y.after; };
  std::stable_sort(candidates.begin(), candidates.end(), better);
  if (candidates.size() > most_judged) candidates.resize(most_judged);
  constexpr double as_good = 2.0, rounding = 1e-6;
  std::vector<Cause> causes;
  for (const Candidate& candidate : candidates) {
    if (!causes.empty() && candidate.after > as_good * causes.front().after + rounding) break;
    progress.check();
    progress("looking for the cause", 0.5);
    if (vanishes(candidate.mistake)) causes.push_back({candidate.mistake.name(), candidate.before, candidate.after});
  }
  return causes;
}

}  // namespace

std::vector<Cause> likely_causes(const Field& a, const Field& b, const std::function<bool(const Mistake&)>& vanishes,
                                 const Progress& progress) {
  const std::vector<glm::ivec3> places = sample_places(b);
  if (places.empty() || a.channels != b.channels) return {};
  const std::vector<Placement> all_places = placements(a.size);
  const double factor = double{median_magnitude(b)} / double{median_magnitude(a)};
  const std::vector<Recoding> all_codes = recodings(a.channels, factor);
  std::vector<Candidate> alone, together;
  for (const Placement& placement : all_places) {
    if (placement.result_size(a.size) != b.size) continue;
    const bool moved = placement.shift != glm::ivec3(0) || placement.half != glm::ivec3(0);
    for (const Recoding& recoding : all_codes) {
      const Candidate candidate{{&placement, &recoding}};
      if (placement.mistake.empty() || recoding.mistake.empty())
        alone.push_back(candidate);
      else if (!moved)
        together.push_back(candidate);
    }
  }
  for (std::vector<Candidate>* candidates : {&alone, &together}) {
    keep_helpful(*candidates, a, b, places, progress);
    if (std::vector<Cause> causes = judged(std::move(*candidates), vanishes, progress); !causes.empty()) return causes;
  }
  return {};
}

bool explains(const Mistake& mistake, const Field& a, const Field& b, const Tolerance& tolerance) {
  constexpr double share = 0.999;  // silhouettes and rounding at edges may be left
  // A few places tell of most mistakes that they do not explain it. Of one that does, 0.1 % of these disagree; chance
  // makes that more than 1 % and five places in not one of 100,000 samples of any size.
  constexpr double of_sample = 0.99, by_chance = 5.0;
  const Count sample = agreement(mistake, a, b, tolerance, std::max<size_t>(1, b.texel_count() / most_samples));
  if (double(sample.agreeing) + by_chance < of_sample * double(sample.compared)) return false;
  const Count all = agreement(mistake, a, b, tolerance, 1);
  return double(all.agreeing) >= share * double(all.compared);
}

nlohmann::json to_json(const std::vector<Cause>& causes) {
  nlohmann::json json = nlohmann::json::array();
  for (const Cause& cause : causes)
    json.push_back({{"mistake", cause.mistake}, {"before", cause.before}, {"after", cause.after}});
  return json;
}

}  // namespace voxref
