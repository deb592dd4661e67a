#pragma once
#include <glm/vec3.hpp>

namespace voxref {

/// Cornell's measured spectra (Cornell University Program of Computer Graphics, Cornell Box Data, 400-700 nm) as linear
/// sRGB, rounded to four decimals: the measurements carry three. XYZ by the CIE 1931 colour matching functions in the
/// analytic form of Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions",
/// JCGT 2(2), 2013, their multi-lobe fit; trapezoid rule over the measurements' 4 nm steps.
struct CornellColors {
  /// Albedo as seen under D65, sRGB's own white: each channel is divided by a perfect reflector's, so that a grey
  /// spectrum keeps its value in all three.
  glm::vec3 white, red, green;
  /// The lamp's own albedo, 0.78 at all wavelengths.
  glm::vec3 lamp_albedo;
  /// Radiance, W/(sr m^2), scaled so that its luminance is the spectrum's mean under the eye's sensitivity.
  glm::vec3 lamp_radiance;
};

CornellColors cornell_colors();

}  // namespace voxref
