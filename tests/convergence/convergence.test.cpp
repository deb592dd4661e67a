#include "convergence/convergence.h"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "catch.h"
#include "make_scenes/builders.h"

// The proof that cone tracer and path tracer solve the same equation: what separates them shrinks as voxels, cones and
// steps do.

namespace voxref {
namespace {

void print_header(const std::string& title) {
  fmt::print("\n{}\n{:>6} {:>6} {:>6} {:>7} | {:>10} {:>9} {:>8} {:>6}\n", title, "voxels", "cones", "step", "bounce",
             "mean_ratio", "rel_error", "+-", "order");
}

/// Measures the rungs, prints them as a table, and returns their distances. The order is that of the error in the
/// voxel's side where that is halved from row to row.
std::vector<Distance> climb(const std::string& title, std::span<const Rung> rungs, const Scene& scene, const View& view,
                            int bounces, const Image& path) {
  print_header(title);
  std::vector<Distance> distances;
  for (const Rung& rung : rungs) {
    const Distance d = distance_at(rung, scene, view, bounces, path);
    const std::string order =
        distances.empty() ? "" : fmt::format("{:.2f}", std::log2(distances.back().rel_error / d.rel_error));
    fmt::print("{:6} {:6} {:6.2f} {:7} | {:10.4f} {:9.4f} {:8.4f} {:>6}\n", rung.resolution, rung.cones,
               double(rung.step), rung.bounce_cones, d.mean_ratio, d.rel_error, d.error_bar, order);
    std::fflush(stdout);
    distances.push_back(d);
  }
  return distances;
}

}  // namespace

TEST_CASE("Cone traced light comes nearer to path traced light as voxels and cones refine", "[consistency]") {
  const Scene scene = cornell_box(CornellLight::point);
  const View view = square_view(scene, 24);
  const Image path = indirect_reference(scene, view, 0, 1024);
  const Distance coarse = distance_at({64, 16}, scene, view, 0, path);
  const Distance finer = distance_at({128, 64}, scene, view, 0, path);
  const Distance many_cones = distance_at({128, 256}, scene, view, 0, path);
  CAPTURE(coarse.rel_error, finer.rel_error, many_cones.rel_error, coarse.error_bar);
  // Measured 0.29, 0.21 and 0.07; mean 1.07, 1.08 and 1.00. The path tracer's noise moves them by 0.001.
  CHECK(coarse.rel_error < 0.32);
  CHECK(finer.rel_error < 0.24);
  CHECK(finer.rel_error < coarse.rel_error);
  CHECK(many_cones.rel_error < 0.09);
  CHECK(std::abs(many_cones.mean_ratio - 1.0) < 0.03);
}

// Not in the default run: the last rung alone traces four million cones at the pixels. `voxref_tests "[.long]"` runs
// it.
TEST_CASE("With voxels, cones and bounces refined together the error falls below 5 %", "[.long][consistency]") {
  const Scene scene = cornell_box(CornellLight::point);
  const View view = square_view(scene, 64);
  constexpr int bounces = 1;
  const Image path = indirect_reference(scene, view, bounces, 4096);
  const auto run = [&](const std::string& title, const std::vector<Rung>& rungs) {
    return climb(title, rungs, scene, view, bounces, path);
  };
  const std::vector<Distance> together =
      run("Together", {{64, 16, 0.5f, 6}, {128, 64, 0.5f, 16}, {256, 256, 0.5f, 32}, {512, 1024, 0.5f, 64}});
  for (size_t i = 1; i < together.size(); ++i)
    CHECK(together[i].rel_error + 3.0 * together[i].error_bar < together[i - 1].rel_error);
  CHECK(together.back().rel_error + 3.0 * together.back().error_bar < 0.05);
  // Measured 0.0457 +- 0.0004 and 1.024: bounces gathered with 64 cones are what is still too bright in the mean. With
  // 1024 cones and no bounce it is 1.004.
  CHECK(std::abs(together.back().mean_ratio - 1.0) < 0.03);

  run("Voxels alone", {{32, 64}, {64, 64}, {128, 64}, {256, 64}});
  run("Cones alone", {{128, 4}, {128, 16}, {128, 64}, {128, 256}, {128, 1024}});
  run("Step alone", {{128, 64, 1.0f}, {128, 64, 0.5f}, {128, 64, 0.25f}, {128, 64, 0.1f}});
}

}  // namespace voxref
