#pragma once
#include <array>
#include <limits>
#include <string_view>

namespace voxref {

// What Villegas 2016 measured, on an AMD R9 380; milliseconds unless said. What carries over are ratios between rows.

inline constexpr double not_published = std::numeric_limits<double>::quiet_NaN();
inline constexpr double misprint = not_published;  // printed, but another column's

/// Tables 4.3 and 4.4. In the rows of 128 voxels the totals repeat another column, and a time of the cones does.
struct ThesisStages {
  std::string_view scene;
  int voxels;
  double fixed, clear, dynamic, shade, mipmap, bounce, bounce_mipmap, cones, total;
};
inline constexpr std::array thesis_stages = {
    ThesisStages{"sibenik", 64, 3.00, 0.01, 9.17, 0.04, 0.11, 0.12, 0.10, 5.17, 14.74},
    ThesisStages{"cornell_box", 64, 0.07, 0.02, 2.13, 0.06, 0.11, 0.29, 0.11, 4.79, 7.51},
    ThesisStages{"conference", 64, 39.68, 0.01, 5.98, 0.03, 0.11, 0.10, 0.11, 5.38, 11.72},
    ThesisStages{"sponza", 64, 22.87, 0.01, 13.93, 0.05, 0.17, 0.13, 0.17, 5.49, 19.97},
    ThesisStages{"sibenik", 128, 2.17, 0.08, 3.93, 0.17, 0.26, 0.62, 0.26, misprint, misprint},
    ThesisStages{"cornell_box", 128, 0.16, 0.10, 1.38, 0.28, 0.26, 1.62, 0.26, 5.75, misprint},
    ThesisStages{"conference", 128, 39.19, 0.07, 2.47, 0.15, 0.26, 0.54, 0.26, 6.42, misprint},
    ThesisStages{"sponza", 128, 15.15, 0.08, 4.00, 0.20, 0.26, 0.82, 0.26, 5.47, misprint},
    ThesisStages{"sibenik", 256, 1.80, 0.58, 2.11, 0.95, 1.39, 3.88, 1.38, 7.31, 17.60},
    ThesisStages{"cornell_box", 256, 0.51, 0.78, 1.30, 1.33, 1.38, 8.41, 1.37, 7.23, 21.81},
    ThesisStages{"conference", 256, 46.04, 0.56, 1.52, 0.86, 1.38, 3.23, 1.37, 7.50, 16.42},
    ThesisStages{"sponza", 256, 11.29, 0.60, 2.03, 1.13, 1.37, 5.44, 1.38, 7.01, 18.97},
    ThesisStages{"sibenik", 512, 2.36, 4.51, 1.35, 6.06, 10.92, 23.23, 10.91, 8.57, 65.55},
    ThesisStages{"cornell_box", 512, 6.18, 6.08, 1.80, 7.54, 10.70, 41.14, 10.87, 7.87, 86.00},
    ThesisStages{"conference", 512, 47.44, 4.46, 1.28, 5.63, 11.57, 18.70, 11.35, 8.56, 61.56},
    ThesisStages{"sponza", 512, 9.05, 4.55, 1.39, 6.87, 11.16, 28.09, 10.79, 7.64, 70.49},
};

/// Cone tracing by screen size and step (tables 4.5, 4.6: 256 voxels), shadows (4.7, 4.8).
struct ThesisCones {
  std::string_view scene;
  double at_1080, at_720;                             ///< step 0.5
  double step_0_10, step_0_25, step_0_50, step_2_50;  ///< by the step, at 1280x720
  double shade, shade_shadows;                        ///< voxels' shading without and with shadows through the volume
  double cones, visibility_volume, shadow_cones;
};
inline constexpr std::array thesis_cones = {
    ThesisCones{"sibenik", 14.30, 7.31, 29.55, 12.73, 7.31, 2.67, 0.95, 4.57, 7.31, 6.03, 8.58},
    ThesisCones{"cornell_box", 15.17, 7.23, 26.80, 11.57, 7.23, 2.68, 1.33, 20.32, 7.23, 6.50, 10.31},
    ThesisCones{"conference", 16.27, 7.50, 29.73, 12.93, 7.50, 2.85, 0.86, 4.77, 7.50, 5.65, 5.65},
    ThesisCones{"sponza", 16.69, 7.01, 29.81, 12.92, 7.01, 2.81, 1.13, 3.31, 7.01, 6.28, 8.30},
};

/// Table 4.9: megabytes of its dense volumes, whatever the scene.
struct ThesisMemory {
  int voxels;
  double megabytes;
};
inline constexpr std::array thesis_memory = {ThesisMemory{64, 216.7}, ThesisMemory{128, 253.0},
                                             ThesisMemory{256, 540.3}, ThesisMemory{512, 2800.0}};

}  // namespace voxref
