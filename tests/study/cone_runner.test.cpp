#include "study/cone_runner.h"

#include <algorithm>

#include "catch.h"
#include "study/study_scenes.h"

using namespace voxref;

TEST_CASE("Settings that share stages give the bits of cone_trace alone", "[study]") {
  const StudyScene scene = cornell_point_scene();
  const Caster caster(scene.scene);
  const View view = sized(scene.view, 12);
  ConeRunner runner(scene.scene, caster, view);
  Settings settings;
  settings.grid.resolution = 20;
  settings.bounce.count = 1;
  const auto same = [&] {
    const ConeTraceResult shared = runner(settings), alone = cone_trace(scene.scene, caster, view, settings);
    for (const char* channel : {"R", "diffuse.G", "direct.B"}) {
      const auto a = shared.image.image.channel(channel), b = alone.image.image.channel(channel);
      CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    }
    CHECK(shared.seconds.voxelize > 0.0);
    CHECK(shared.seconds.total >= shared.seconds.voxelize + shared.seconds.bounce + shared.seconds.cone_trace);
  };
  same();
  settings.render.cone.diffuse = 9;  // the same volume
  same();
  settings.render.cone.step = 1.0f;  // the bounce's cones march in it too
  same();
  settings.storage = Storage::unorm8;
  same();
  settings.render.pixel.shadow = PixelShadow::visibility;
  same();
  settings.grid.resolution = 18;
  same();
}

TEST_CASE("A runner's time holds each stage as often as it ran", "[study]") {
  const StudyScene scene = cornell_point_scene();
  const Caster caster(scene.scene);
  ConeRunner runner(scene.scene, caster, sized(scene.view, 12));
  Settings settings;
  settings.grid.resolution = 20;
  settings.bounce.count = 1;
  double sum = 0.0;
  /// @param voxelized,lit whether the settings need that anew
  const auto ran = [&](bool voxelized, bool lit) {
    runner(settings);
    const StageSeconds& seconds = runner.ran();
    CHECK((seconds.voxelize > 0.0) == voxelized);
    for (const double stage : {seconds.shade, seconds.mipmap, seconds.bounce, seconds.prepare})
      CHECK((stage > 0.0) == lit);
    CHECK(seconds.cone_trace > 0.0);
    CHECK(seconds.total >=
          seconds.voxelize + seconds.shade + seconds.mipmap + seconds.bounce + seconds.prepare + seconds.cone_trace);
    sum += seconds.total;
  };
  ran(true, true);
  settings.render.cone.diffuse = 9;
  ran(false, false);
  settings.storage = Storage::unorm8;
  ran(false, true);
  settings.grid.resolution = 18;
  ran(true, true);
  CHECK(runner.spent() == Approx(sum));
  // Of another size, from the same volume.
  const View large = sized(scene.view, 20);
  const ConeTraceResult shared = runner(settings, large), alone = cone_trace(scene.scene, caster, large, settings);
  const auto a = shared.image.image.channel("R"), b = alone.image.image.channel("R");
  CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  CHECK(runner.ran().shade == 0.0);
}
