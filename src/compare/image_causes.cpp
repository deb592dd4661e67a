#include "compare/image_causes.h"

#include <cmath>

namespace voxref {

namespace {

/// Both images with a mistake undone in the first; where that tells nothing both are the reference.
struct Undone {
  Image a, b;
};
Undone undo(const Mistake& mistake, const Image& a, const Image& b, const Field& field_a, const Field& field_b) {
  Undone undone{Image(b.width(), b.height()), b};
  undone.a.attributes = a.attributes;
  undone.a.add_layer("");
  for (const char* channel : {"stderr.R", "stderr.G", "stderr.B", "stderr.Y"})
    if (a.has(channel)) undone.a.add(channel);
  const auto to = undone.a.layer(""), reference = undone.b.layer("");
  for (size_t i = 0; i < field_b.texel_count(); ++i) {
    glm::vec4 value, expected;
    const glm::ivec3 place = field_b.place(i);
    const bool told = mistake.undo(field_a, field_b, place, value, expected);
    if (!told) value = expected = field_b.texel(place);
    for (int c = 0; c < 3; ++c) {
      to[size_t(c)][i] = value[c];
      reference[size_t(c)][i] = expected[c];
    }
    glm::ivec3 from;
    if (!told || !mistake.placement->source(place, field_a.size, from)) continue;
    // Errors are small: one of the value before is the difference that it makes after.
    const size_t source = field_a.index(from);
    const auto carry = [&](const char* channel, size_t c) {
      if (!a.has(channel)) return;
      const glm::vec4 stored = field_a.texel(from);
      const float error = a.channel(channel)[source];
      const glm::vec4 moved = mistake.recoding->undo(stored + glm::vec4(glm::vec3(error), 0.0f));
      undone.a.channel(channel)[i] = std::abs(moved[int(c)] - value[int(c)]);
    };
    carry("stderr.R", 0);
    carry("stderr.G", 1);
    carry("stderr.B", 2);
    carry("stderr.Y", 1);
  }
  return undone;
}

}  // namespace

std::vector<Cause> image_causes(const ImageDiff& diff, const Image& a, const Image& b, const NoiseOptions& options,
                                const Progress& progress) {
  const Field field_a = field_of(a), field_b = field_of(b);
  // What an 8-bit file rounds away, and ten times the usual tolerance: a cause must explain, not reproduce.
  const Tolerance loose{10.0 * diff.tolerance.absolute + 1.0 / 255.0, 10.0 * diff.tolerance.relative};
  return likely_causes(
      field_a, field_b,
      [&](const Mistake& mistake) {
        if (!diff.noise) return explains(mistake, field_a, field_b, loose);
        const Undone undone = undo(mistake, a, b, field_a, field_b);
        return judge_noise(undone.a, undone.b, options).verdict != Verdict::different;
      },
      progress);
}

}  // namespace voxref
