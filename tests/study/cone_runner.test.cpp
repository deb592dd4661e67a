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
