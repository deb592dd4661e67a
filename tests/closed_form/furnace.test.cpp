#include "catch.h"
#include "closed_form/expect.h"
#include "reference/small_scenes.h"

namespace voxref {

TEST_CASE("A closed furnace of emission 1 and albedo r shows radiance 1/(1-r)", "[closed_form]") {
  // Any leak, any light lost or counted twice at any bounce, and any bias of Russian roulette changes the sum of the
  // geometric series; what a wrong distribution of directions would do it cannot see.
  for (const auto& [albedo, spp] : {std::pair(0.2f, 4096), {0.5f, 16384}, {0.9f, 32768}}) {
    Scene scene;
    add_cube_interior(scene, add_material(scene, lambert(glm::vec3(albedo), glm::vec3(1.0f))));
    CAPTURE(albedo);
    const double truth = 1.0 / (1.0 - static_cast<double>(albedo));
    expect_mean(render(scene, view_from({0.2f, 0.1f, 0.5f}, {0.0f, 0.0f, -1.0f}, 4, 4, 1.5f), spp), truth);
  }
}

TEST_CASE("Inside a glossy furnace the radiance stays within that of a perfectly white one", "[closed_form]") {
  // Emission 1 and a lobe that loses a little: at each bounce no more comes back than came. Without loss the radiance
  // after n scatterings is n + 1.
  for (const float roughness : {0.1f, 0.5f, 1.0f}) {
    Scene scene;
    Material metal = lambert(glm::vec3(1.0f), glm::vec3(1.0f));
    metal.metallic = 1.0f;
    metal.roughness = roughness;
    add_cube_interior(scene, add_material(scene, metal));
    const PathResult result = render(scene, view_from({0.2f, 0.1f, 0.5f}, {0.0f, 0.0f, -1.0f}, 12, 12, 1.5f), 256, 3);
    CAPTURE(roughness);
    CHECK(result.nonfinite == 0);
    CHECK(result.mean.g < 4.0f + 4.0f * result.mean_stderr.g);
  }
}

}  // namespace voxref
