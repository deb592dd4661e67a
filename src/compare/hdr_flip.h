#pragma once
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "progress.h"

namespace voxref {

/// The exposures that HDR-FLIP looks at a picture with: stops, `count` of them at equal distances from start to stop.
struct FlipExposures {
  float start = 0.0f, stop = 0.0f;
  int count = 2;
};

/// From the brightest luminance just below white to the median one there, after the tone mapper (Andersson et al. 2021,
/// section 4). @param reference linear RGB, finite; a black picture gets one stop around 0
FlipExposures flip_exposures(std::span<const glm::vec3> reference);

/// HDR-FLIP, Andersson, Nilsson, Shirley and Akenine-Moller 2021, "Visualizing Errors in Rendered High Dynamic Range
/// Images": per pixel the largest LDR-FLIP (flip.h) over the exposures, after the tone mapper of ACES as Narkowicz 2015
/// fitted it. @param reference, test width x height pixels, linear RGB, finite, of any range @return values in [0,1]
std::vector<float> hdr_flip_map(int width, int height, std::span<const glm::vec3> reference,
                                std::span<const glm::vec3> test, const FlipExposures& exposures,
                                const Progress& progress = {});

}  // namespace voxref
