#pragma once
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace voxref {

/// Pixels per degree of visual angle of the paper's observer: 0.7 m from a 0.7 m wide monitor of 3840 pixels.
inline constexpr float flip_pixels_per_degree = 67.0f;

/// LDR-FLIP, Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images": the difference that an
/// observer sees when the pictures alternate, per pixel. Symmetric in its arguments.
/// @param reference, test width x height pixels from the top row, linear RGB with sRGB primaries, in [0,1]
/// @return width x height values in [0,1], 0: no difference seen
std::vector<float> flip_map(int width, int height, std::span<const glm::vec3> reference,
                            std::span<const glm::vec3> test, float pixels_per_degree = flip_pixels_per_degree);

}  // namespace voxref
