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

TEST_CASE("Rays between the walls of a closed cube are as long as its mean chord, on whichever side they are",
          "[plan]") {
  // Convex body, cosine-distributed from the surface: 4 V / S = 4/3 of the half side for a cube of side 2. Rays outward
  // meet nothing. 4096 rays whose lengths scatter by a half.
  Scene cube = furnace(0.5f);
  CHECK(mean_sight(cube, Caster(cube)) == Approx(4.0 / 3.0).epsilon(0.02));
  for (glm::uvec3& triangle : cube.triangles) std::swap(triangle.x, triangle.y);
  CHECK(mean_sight(cube, Caster(cube)) == Approx(4.0 / 3.0).epsilon(0.032));  // other rays; four standard errors
  const Scene plane = point_light_over_plane();
  CHECK(mean_sight(plane, Caster(plane)) == 0.0);
  CHECK(mean_sight({}, Caster({})) == 0.0);
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
  CostModel model(4.0 / 3.0, {});
  ConeTraceResult measured = run(setting(64, 2, 6));
  measured.seconds.cone_trace = 1e-3;
  model.learn(setting(64, 2, 6), measured, 48 * 48, measured.seconds);
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

TEST_CASE("What an image takes whatever its size is not charged to its pixels", "[plan]") {
  // Of 10 ms 8 are there before the first pixel: four times the pixels take 8 + 4 x 2, not 40.
  CostModel model(4.0 / 3.0, {});
  for (const double seconds : {8e-3, 9e-1, 8e-3}) model.learn_image(seconds);  // one of them in a busy moment
  ConeTraceResult measured = run(setting(64, 2, 6));
  measured.seconds.cone_trace = 10e-3;
  model.learn(setting(64, 2, 6), measured, 1000, measured.seconds);
  CHECK(model.predict(setting(64, 2, 6), 1000).cone_trace == Approx(10e-3));
  CHECK(model.predict(setting(64, 2, 6), 4000).cone_trace == Approx(16e-3));
}

TEST_CASE("Where images of hardly any pixels met a busy moment, pixels are not free", "[plan]") {
  // Each of the three took longer than the image that is learned from, which says nothing of its pixels then.
  CostModel model(4.0 / 3.0, {});
  for (int image = 0; image < 3; ++image) model.learn_image(20e-3);
  ConeTraceResult measured = run(setting(64, 2, 6));
  measured.seconds.cone_trace = 10e-3;
  model.learn(setting(64, 2, 6), measured, 1000, measured.seconds);
  const auto seconds = [&](int cones, size_t pixels) {
    return model.predict(setting(64, 2, cones), pixels).cone_trace;
  };
  CHECK(seconds(6, 4000) > seconds(6, 1000));
  CHECK(seconds(32, 1000) > seconds(6, 1000));
  // A quieter image does.
  measured.seconds.cone_trace = 30e-3;
  model.learn(setting(64, 2, 6), measured, 1000, measured.seconds);
  CHECK(seconds(6, 4000) == Approx(20e-3 + 4 * 10e-3));
}

TEST_CASE("One busy moment does not move the model's rates", "[plan]") {
  CostModel model(4.0 / 3.0, {});
  for (const double busy : {1.0, 1.0, 50.0}) {
    const ConeTraceResult result = run(setting(64, 2, 6), busy);
    model.learn(setting(64, 2, 6), result, 100, result.seconds);
  }
  CHECK(model.predict(setting(64, 2, 6), 100).prepare == Approx(run(setting(64, 2, 6)).seconds.prepare));
}

TEST_CASE("A busy moment counts once, however many settings share the stage that it hit", "[plan]") {
  // As the runner has it: 64 voxels are voxelized in a busy moment for a volume with images of six numbers of cones,
  // then again, after another resolution, for one image each.
  CostModel model(4.0 / 3.0, {});
  const auto learn = [&](const Settings& settings, double busy, bool volume) {
    const ConeTraceResult result = run(settings, busy);
    StageSeconds ran = result.seconds;
    if (!volume) ran = StageSeconds{.cone_trace = ran.cone_trace};
    model.learn(settings, result, 100, ran);
  };
  for (const int cones : {4, 6, 9, 16, 32, 64}) learn(setting(64, 2, cones), 50.0, cones == 4);
  for (int again = 0; again < 2; ++again) {
    learn(setting(32, 2, 4), 1.0, true);
    learn(setting(64, 2, 4), 1.0, true);
  }
  const StageSeconds quiet = run(setting(64, 2, 4)).seconds, found = model.predict(setting(64, 2, 32), 100);
  CHECK(found.voxelize == Approx(quiet.voxelize));
  CHECK(found.shade == Approx(quiet.shade + quiet.mipmap));
  CHECK(found.bounce == Approx(quiet.bounce));
  CHECK(found.prepare == Approx(quiet.prepare));
}

TEST_CASE("A stage's rate is that of runs alike in what the stage depends on", "[plan]") {
  // 32 voxels with every step and storage, and 256, where a voxel takes three times as long, with one of each.
  CostModel model(4.0 / 3.0, {});
  const auto with = [](int resolution, float step, Storage storage) {
    Settings settings = setting(resolution, 2, 6);
    settings.render.cone.step = step;
    settings.storage = storage;
    return settings;
  };
  const auto learn = [&](const Settings& settings, double busy) {
    const ConeTraceResult result = run(settings, busy);
    model.learn(settings, result, 100, result.seconds);
  };
  for (const Storage storage : {Storage::unorm8, Storage::float32})
    for (const float step : {1.0f, 0.5f}) learn(with(32, step, storage), 1.0);
  learn(with(256, 1.0f, Storage::unorm8), 3.0);
  // Neither step nor storage is anything to voxelization, and the step nothing to shading and making ready.
  const StageSeconds there = run(with(256, 1.0f, Storage::unorm8), 3.0).seconds;
  CHECK(model.predict(with(256, 0.5f, Storage::float32), 100).voxelize == Approx(there.voxelize));
  const StageSeconds other_step = model.predict(with(256, 0.5f, Storage::unorm8), 100);
  CHECK(other_step.voxelize == Approx(there.voxelize));
  CHECK(other_step.shade == Approx(there.shade + there.mipmap));
  CHECK(other_step.prepare == Approx(there.prepare));
  // And at one resolution the storage is.
  learn(with(256, 1.0f, Storage::float32), 6.0);
  CHECK(model.predict(with(256, 0.5f, Storage::float32), 100).prepare == Approx(2.0 * there.prepare));
  CHECK(model.predict(with(256, 0.5f, Storage::unorm8), 100).prepare == Approx(there.prepare));
  // So a busy moment is outvoted by runs of any step and storage.
  for (const float step : {1.0f, 2.0f}) learn(with(128, step, Storage::unorm8), 1.0);
  learn(with(128, 0.5f, Storage::float32), 50.0);
  const Settings hit = with(128, 0.5f, Storage::float32);
  CHECK(model.predict(hit, 100).voxelize == Approx(run(hit).seconds.voxelize));
}
