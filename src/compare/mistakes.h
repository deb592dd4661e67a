#pragma once
#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <string>
#include <vector>

#include "compare/field.h"

namespace voxref {

/// Where the texels of an array come from: of the one under test, the texel that belongs at a place of the reference.
struct Placement {
  std::string mistake;       ///< empty: everything is in its place
  glm::ivec3 axes{0, 1, 2};  ///< coordinate k of the source is coordinate axes[k] of the place ...
  glm::bvec3 flips{false};   ///< ... counted from the other end ...
  glm::ivec3 shift{0};       ///< ... plus this
  glm::ivec3 half{0};        ///< the reference half-way to the neighbour in this direction is what was stored

  /// @return false when the place has no source
  bool source(const glm::ivec3& place, const glm::ivec3& source_size, glm::ivec3& from) const;
  /// The size that an array of this one has after it.
  glm::ivec3 result_size(const glm::ivec3& source_size) const;
};

/// How the values were changed, undone.
struct Recoding {
  std::string mistake;  ///< empty: none
  std::function<glm::vec4(const glm::vec4&)> undo;
  float clips_above = std::numeric_limits<float>::infinity();  ///< values under test that reach this tell nothing: they
                                                               ///< were clipped there
};

/// The classic mistakes of place for an array of this size: y or z flipped, axes swapped, shifted by one texel or half
/// of one. The first has none.
std::vector<Placement> placements(const glm::ivec3& size);
/// The classic mistakes of value: swapped channels, transfer functions, premultiplication, encodings, factors. The
/// first has none. @param factor by which the array under test would have to be multiplied to have the reference's
/// values
std::vector<Recoding> recodings(int channels, double factor);

/// One mistake of place, one of value.
struct Mistake {
  const Placement* placement;
  const Recoding* recoding;

  std::string name() const;
  /// The array under test with the mistake undone, at a place of the reference, and what to hold against it.
  /// @return false where the comparison tells nothing
  bool undo(const Field& a, const Field& b, const glm::ivec3& place, glm::vec4& undone, glm::vec4& reference) const;
};

}  // namespace voxref
