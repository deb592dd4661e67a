#pragma once
#include <string>
#include <vector>

#include "study/study.h"

namespace voxref {

/// A number that says how badly the method fails: the larger, the worse.
struct Threshold {
  std::string name;  ///< lower_case
  double value = 0;
  std::string unit;  ///< empty: none
  std::string meaning;
};

/// A way in which the method fails (spec section 8), as a curve; theory's own curve is drawn dashed where there is one.
struct Failure {
  std::string title, text;
  Table table;
  std::vector<Chart> charts;
  std::vector<Threshold> thresholds;
};

// Each takes a second or less. What is measured goes through the stages that renders go through.

Failure leak_by_level();      ///< a wall of one voxel in the filtered levels, by level and angle, both filters
Failure leak_by_thickness();  ///< light behind a wall, by its thickness in voxels
Failure contact_gap();        ///< self-lighting and what is lost near a contact, by the start offset
Failure step_dependence();    ///< transmittance of a medium by the step's length
Failure flicker();            ///< of what an object sends that moves by fractions of a voxel, and its spectrum
Failure camera_flicker();     ///< of a floor's light along a path of the gathering point
Failure rotation();           ///< a closed room that is turned against the grid
Failure scale();              ///< from 1e-3 to 1e6
Failure distance();           ///< from the origin, up to 1e6 sides of the scene
Failure clamping();           ///< of radiance above 1 in bytes
Failure feedback_gain();      ///< of the bounces, by albedo
Failure cone_gaps();          ///< of cone sets, for radiance that falls with the cosine
Failure odd_scenes();         ///< degenerate and huge triangles, albedo 1, nothing lit

/// All of them, in this order.
std::vector<Failure (*)()> failures();

}  // namespace voxref
