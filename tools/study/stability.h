#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "study/study.h"

namespace voxref {

/// Which way a threshold gets worse; either: it is to stay what it is.
enum class Worse : uint8_t { larger, smaller, either };

/// A number that says how badly the method fails, or where it begins to.
struct Threshold {
  std::string name;  ///< lower_case
  double value = 0;
  std::string unit;  ///< empty: none
  std::string meaning;
  Worse worse = Worse::larger;
};

/// A way in which the method fails (spec section 8), as a curve; theory's own curve is drawn dashed where there is one.
struct Failure {
  std::string title, text;
  Table table;
  std::vector<Chart> charts{};
  std::vector<Threshold> thresholds{};
  std::vector<std::string> warnings{};  ///< as Section's
};

// Each takes seconds at most. What is measured goes through the stages that renders go through.

Failure leak_by_level();       ///< a wall in the filtered levels, by level, angle and thickness, both filters
Failure leak_between_rooms();  ///< light behind a wall, by its thickness and its angle to the grid
Failure contact_gap();         ///< self-lighting and what is lost near a contact, by the start offset
Failure step_dependence();     ///< transmittance of a medium by the step's length, raw and as extinction
Failure step_bands();          ///< of a wall that a cone comes nearer to, by the step's length
Failure cone_bands();          ///< of a ball's light on a floor, by the number of cones
Failure emitter_growth();      ///< by the voxels that stand for it
Failure flicker();             ///< of what an object sends that moves by fractions of a voxel, and its spectrum
Failure camera_flicker();      ///< of a floor's light along a path of the gathering point
Failure rotation();            ///< a closed room that is turned against the grid
Failure scale();               ///< from 1e-3 to 1e6
Failure distance();            ///< from the origin, up to 1e6 m
Failure clamping();            ///< of radiance above 1 in bytes, and rounding far below
Failure opposite_normals();    ///< averaged in one voxel, by the thickness of a slab
Failure specular_blur();       ///< of an edge, by the cone's half-angle
Failure feedback_gain();       ///< of the bounces, by albedo
Failure cone_gaps();           ///< of cone sets: light, gaps, overlaps
Failure odd_scenes();          ///< degenerate and huge triangles, albedo 1, nothing lit

/// All of them, in this order.
std::vector<Failure (*)()> failures();

}  // namespace voxref
