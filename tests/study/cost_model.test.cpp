#include "study/cost_model.h"

#include <cmath>

#include "catch.h"
#include "make_scenes/builders.h"

using namespace voxref;

namespace {

Settings setting(int resolution, int bounces, int cones) {
  Settings settings;
  settings.grid.resolution = resolution;
  settings.bounce.count = bounces;
  settings.render.cone.diffuse = cones;
  return settings;
}

/// A run of `pixels` whose stages took what units of work take, and twice that from `busy` on.
ConeTraceResult run(const Settings& settings, double busy = 1.0) {
  ConeTraceResult result;
  result.voxels_occupied = size_t(6 * settings.grid.resolution * settings.grid.resolution);
  result.grid.voxel = 2.0f / float(settings.grid.resolution);
  result.bounces = settings.bounce.count.value_or(0);
  const double voxels = double(result.voxels_occupied);
  result.seconds = {busy * 2e-6 * voxels,
                    busy * 3e-7 * voxels,
                    busy * 1e-7 * voxels,
                    busy * 1e-6 * voxels * result.bounces,
                    busy * 5e-7 * voxels,
                    0.0,
                    0.0};
  return result;
}

}  // namespace

TEST_CASE("Rays between the walls of a closed cube are as long as its mean chord", "[plan]") {
  // Convex body, cosine-distributed from the surface: 4 V / S = 4/3 of the half side for a cube of side 2.
  const Scene cube = furnace(0.5f);
  const Visibility visibility = measure_visibility(cube, Caster(cube));
  CHECK(visibility.hit_share == 1.0);
  CHECK(visibility.mean_distance == Approx(4.0 / 3.0).epsilon(0.02));  // 4096 rays whose lengths scatter by a half
}

TEST_CASE("The model's look-ups are those of a march", "[plan]") {
  for (const double step : {1.0, 0.5})
    for (const double tangent : {0.05, 0.3, 0.66}) {
      double s = 0.0;
      int counted = 0;
      for (; s < 100.0; ++counted) s += step * std::max(1.0, 2.0 * tangent * s);
      CAPTURE(step, tangent, counted);
      CHECK(CostModel::look_ups(tangent, step, 100.0) == Approx(counted).margin(2.0));  // the ends are cut differently
    }
}

TEST_CASE("What grows with voxels is not booked to pixels, and what grows with pixels not to voxels", "[plan]") {
  // 48^2 pixels at 64 voxels, an image of 1 ms; asked for at 256^2: 28.4 times the pixels, and 4 times the voxels of
  // 128. The walls are as far apart as rays of mean length 4/3 see them, which the look-ups' logarithm feels.
  CostModel model({1.0, 4.0 / 3.0}, {});
  ConeTraceResult measured = run(setting(64, 2, 6));
  measured.seconds.cone_trace = 1e-3;
  model.learn(setting(64, 2, 6), measured, 48 * 48, true);
  const double pixels = 256.0 * 256.0 / (48.0 * 48.0);
  const StageSeconds same = model.predict(setting(64, 2, 6), 256 * 256);
  CHECK(same.prepare == Approx(measured.seconds.prepare));
  CHECK(same.voxelize == Approx(measured.seconds.voxelize));
  CHECK(same.shade == Approx(measured.seconds.shade + measured.seconds.mipmap));
  CHECK(same.bounce == Approx(measured.seconds.bounce));
  CHECK(same.cone_trace == Approx(pixels * 1e-3));
  CHECK(same.total == Approx(same.voxelize + same.shade + same.bounce + same.prepare + same.cone_trace));
  const StageSeconds finer = model.predict(setting(128, 2, 6), 48 * 48);
  CHECK(finer.prepare == Approx(4.0 * measured.seconds.prepare));
  CHECK(finer.voxelize == Approx(4.0 * measured.seconds.voxelize));
  CHECK(finer.cone_trace > 1e-3);
  CHECK(finer.cone_trace < 1.5e-3);
  CHECK(model.predict(setting(64, 4, 6), 48 * 48).bounce == Approx(2.0 * measured.seconds.bounce));
}

TEST_CASE("One busy moment does not move the model's rates", "[plan]") {
  CostModel model({1.0, 4.0 / 3.0}, {});
  for (const double busy : {1.0, 1.0, 50.0}) model.learn(setting(64, 2, 6), run(setting(64, 2, 6), busy), 100, true);
  CHECK(model.predict(setting(64, 2, 6), 100).prepare == Approx(run(setting(64, 2, 6)).seconds.prepare));
}

TEST_CASE("Rates are those of runs with the same storage, where there are some", "[plan]") {
  CostModel model({1.0, 4.0 / 3.0}, {});
  Settings bytes = setting(64, 2, 6);
  bytes.storage = Storage::unorm8;
  model.learn(bytes, run(bytes, 3.0), 100, true);
  const double slow = model.predict(setting(64, 2, 6), 100).prepare;
  model.learn(setting(64, 2, 6), run(setting(64, 2, 6)), 100, true);
  CHECK(model.predict(bytes, 100).prepare == Approx(slow));
  CHECK(model.predict(setting(64, 2, 6), 100).prepare == Approx(slow / 3.0));
}
