#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "bench_lookups.h"
#include "bench_mesh.h"
#include "bench_rays.h"
#include "bench_spread.h"
#include "bench_stages.h"
#include "commands.h"
#include "inputs.h"
#include "json.h"
#include "parallel.h"
#include "parse.h"
#include "provenance.h"
#include "summary.h"

namespace voxref {

namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> scenes;
  ViewOptions view;
  SettingsOptions settings;
  int rounds = 5;
  double seconds = 1.0;                                ///< of path tracing per round
  bool mesh = false;                                   ///< put one into each scene
  std::string published = "../shared/gpu/cornell_64";  ///< folder of the published shaders' scene and settings
};

struct SceneBench {
  std::string scene;
  Spread path, bare;                  ///< million rays per second
  Spread ratio;                       ///< path / bare of the same round
  double occlusion_share = 0;         ///< of the path tracer's rays, and of the bare loop's
  Spread path_gain, arithmetic_gain;  ///< rates of all threads / of one: path tracing, and a loop of arithmetic alone
  std::vector<StageBench> stages;
  std::vector<LookupBench> lookups;
};

/// A scene that has no light of its own gets a sun that stands 45 degrees high, so that there are shadow rays to cast.
void ensure_light(Scene& scene) {
  if (!scene.lights.empty() || scene.has_emission()) return;
  Light sun;
  sun.name = "bench";
  sun.type = LightType::directional;
  sun.direction = glm::normalize(glm::vec3(1.0f, -std::numbers::sqrt2_v<float>, -1.0f));
  scene.lights.push_back(sun);
}

PathResult timed_path(const Scene& scene, const Caster& caster, const View& view, double seconds, int seed,
                      const Progress& progress) {
  PathOptions options;
  options.spp = 0;
  options.seconds = seconds;
  options.seed = static_cast<uint64_t>(seed);
  PathResult result = path_trace(scene, caster, view, options, progress);
  progress.check();
  return result;
}

/// Path tracing and the bare loop in turn, so that a machine that slows down or speeds up treats both alike. The first
/// path tracing is not measured: it says in what proportion the bare loop casts its two kinds of rays.
void bench_rays(SceneBench& bench, const Scene& scene, const Caster& caster, const View& view, const Options& options,
                const Progress& progress) {
  constexpr double warm_up_seconds = 0.1;
  const PathResult warm_up = timed_path(scene, caster, view, warm_up_seconds, 0, progress);
  bench.occlusion_share = static_cast<double>(warm_up.occlusion_rays) / static_cast<double>(warm_up.rays);
  constexpr size_t pool = size_t{1} << 20;  // 36 MiB: beyond the caches, as a path tracer's rays come from nowhere near
  const std::vector<BareRay> rays = walk_rays(scene, caster, view, pool, bench.occlusion_share);
  std::vector<double> path, bare, ratio;
  for (int round = 0; round < options.rounds; ++round) {
    const PathResult result = timed_path(scene, caster, view, options.seconds, round, progress);
    const double count = static_cast<double>(result.rays);
    path.push_back(1e-6 * count / result.seconds);
    bare.push_back(1e-6 * count / cast_seconds(caster, rays, result.rays));
    ratio.push_back(path.back() / bare.back());
  }
  bench.path = spread(path);
  bench.bare = spread(bare);
  bench.ratio = spread(ratio);
}

/// What further threads bring, beside what the machine itself has to give.
void bench_threads(SceneBench& bench, const Scene& scene, const Caster& caster, const View& view,
                   const Options& options, const Progress& progress) {
  std::vector<double> path, arithmetic;
  const auto rate = [&](int round) {
    const PathResult result = timed_path(scene, caster, view, options.seconds, round, progress);
    return static_cast<double>(result.rays) / result.seconds;
  };
  for (int round = 0; round < options.rounds; ++round) {
    const double all_path = rate(round), all_arithmetic = arithmetic_seconds();
    const ThreadLimit one(1);
    path.push_back(all_path / rate(round));
    arithmetic.push_back(arithmetic_seconds() / all_arithmetic);
  }
  bench.path_gain = spread(path);
  bench.arithmetic_gain = spread(arithmetic);
}

SceneBench bench_scene(const std::string& file, const Options& options, const Settings& settings, Terminal& terminal) {
  Scene scene = load_scene({file, {}, {}}, terminal);
  ensure_light(scene);
  if (options.mesh) add_mesh(scene);
  const View view = make_view(options.view, scene, std::max(path_bytes_per_pixel({}), cone_bytes_per_pixel));
  const Caster caster(scene);
  // The progress is for Ctrl-C alone: drawing it would be measured too.
  Progress silent = terminal.progress();
  silent.report = nullptr;
  SceneBench bench;
  bench.scene = options.mesh ? file + " with a mesh" : file;
  bench_rays(bench, scene, caster, view, options, silent);
  bench_threads(bench, scene, caster, view, options, silent);
  View base_test = view;  // the thesis's, table 4.3
  if (!options.view.size) base_test.width = 1280, base_test.height = 720;
  bench.stages = bench_stages(scene, caster, base_test, settings, std::min(options.rounds, 3), false, silent);
  bench.lookups = bench_lookups(scene, settings);
  return bench;
}

std::vector<std::string> default_scenes() {
  const std::string usual = "scenes/cornell_box.glb";
  if (!std::filesystem::exists(usual)) throw Error("SCENE", "needed here: there is no " + usual + " in this folder");
  return {usual};
}

void say(Terminal& terminal, const SceneBench& bench, double bandwidth) {
  const auto line = [&](const char* what, const Spread& s, const char* unit) {
    terminal.say(fmt::format("  {:<28} {:>8.3f}  ({:.3f} to {:.3f}){}", what, s.median, s.least, s.greatest, unit));
  };
  terminal.say(bench.scene);
  line("path tracing", bench.path, " million rays/s");
  line("bare casting", bench.bare, " million rays/s");
  line("ratio", bench.ratio, "");
  terminal.say(fmt::format("  {:<28} {:>8.3f}", "occlusion rays / all rays", bench.occlusion_share));
  const std::string threads = fmt::format("{} threads / one, ", thread_count());
  line((threads + "paths").c_str(), bench.path_gain, "");
  line((threads + "arithmetic").c_str(), bench.arithmetic_gain, "");
  say(terminal, bench.stages, bandwidth);
  say(terminal, bench.lookups);
}

void say_machine(Terminal& terminal, const std::string& cpu, int rounds, double bandwidth) {
  terminal.say(fmt::format("{}, {} threads, triad {:.1f} GB/s; medians of {} rounds (least to greatest)", cpu,
                           thread_count(), 1e-9 * bandwidth, rounds));
}

/// The villegas2016 profile on the published shaders' scene, on one thread, where the folder is there.
void bench_published(const Options& options, Terminal& terminal, nlohmann::json& result) {
  const std::filesystem::path folder = options.published;
  if (!std::filesystem::exists(folder / "scene.glb")) return;
  const Settings settings =
      make_settings({"villegas2016", (folder / "settings.json").string(), {"grid.resolution=256"}});
  const Scene scene = load_scene({(folder / "scene.glb").string(), {}, {}}, terminal);
  ViewOptions size;
  size.size = glm::ivec2(256);
  const ThreadLimit one(1);
  const Caster caster(scene);
  Progress silent = terminal.progress();
  silent.report = nullptr;
  const std::vector<StageBench> stages =
      bench_stages(scene, caster, make_view(size, scene, cone_bytes_per_pixel), settings, options.rounds, true, silent);
  terminal.say((folder / "scene.glb").string() + ", villegas2016 at 256 voxels, 256x256 pixels");
  say_published(terminal, stages);
  result["published"] = published_to_json(stages);
}

int run_bench(const Options& options) {
  const Settings settings = make_settings(options.settings);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const std::string cpu = cpu_model();
  const double bandwidth = triad_bandwidth();
  nlohmann::json result = {{"version", VOXREF_VERSION}, {"cpu", cpu},
                           {"threads", thread_count()}, {"triad_bytes_per_second", bandwidth},
                           {"rounds", options.rounds},  {"scenes", nlohmann::json::array()}};
  for (const std::string& file : options.scenes.empty() ? default_scenes() : options.scenes) {
    const SceneBench bench = bench_scene(file, options, settings, terminal);
    if (result["scenes"].empty()) say_machine(terminal, cpu, options.rounds, bandwidth);
    say(terminal, bench, bandwidth);
    result["scenes"].push_back({{"scene", bench.scene},
                                {"path_million_rays_per_second", to_json(bench.path)},
                                {"bare_million_rays_per_second", to_json(bench.bare)},
                                {"ratio", to_json(bench.ratio)},
                                {"occlusion_share", bench.occlusion_share},
                                {"path_gain_of_threads", to_json(bench.path_gain)},
                                {"arithmetic_gain_of_threads", to_json(bench.arithmetic_gain)},
                                {"stages", to_json(bench.stages, bandwidth)},
                                {"lookups", to_json(bench.lookups)}});
  }
  bench_published(options, terminal, result);
  terminal.result(result);
  return exit_done;
}

}  // namespace

void add_bench(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("bench", "path tracing beside bare ray casting; the cone tracer's stages");
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scenes, "glTF 2.0 files (default: scenes/cornell_box.glb)")->type_name("");
  add_value_option(*command, "--rounds", "N", "measurements of each (default: 5)", [options](const std::string& text) {
    options->rounds = static_cast<int>(parse_integer("--rounds", text, 1, 1000));
  });
  add_value_option(
      *command, "--seconds", "S", "of path tracing per round (default: 1)",
      [options](const std::string& text) { options->seconds = parse_number("--seconds", text, 0.01, 3600); });
  command->add_flag("--mesh", options->mesh, "puts a ball of about 70,000 triangles into each scene");
  command
      ->add_option("--published", options->published,
                   "folder of the published shaders' scene (default: ../shared/gpu/cornell_64 where it is there)")
      ->type_name("DIR");
  add_settings_options(*command, options->settings);
  add_view_options(*command, options->view);
  add_common_options(*command, options->common);
  command->footer(
      "The bare loop casts as many rays as the path tracer did, one by one, with the same threads, and does nothing\n"
      "else. Its rays are prepared beforehand by walking the scene as a path tracer does: from what the camera sees,\n"
      "in cosine-distributed directions (closest hit) from surface to surface, and from each to a light (occlusion),\n"
      "in the proportion in which the path tracer casts these two kinds. It calls Embree through the same thin class,\n"
      "one ray at a time. A scene without light gets a sun that stands 45 degrees high, for both. What further "
      "threads\n"
      "bring to path tracing stands beside what they bring to a loop that uses neither memory nor Embree.\n\n"
      "The cone tracer's stages are those of the thesis's base test: 1280x720 pixels unless --size is given. Bytes "
      "are\n"
      "those that a stage takes and makes, each once; the triad is a[i] = b[i] + s c[i] over 192 MiB. Where the "
      "published\n"
      "shaders' scene is there, the same stages of villegas2016 on one core stand beside the published times.\n\n"
      "Examples:\n  voxref bench scenes/cornell_box.glb --rounds 9\n"
      "  voxref bench scenes/cornell_box_empty.glb --mesh");
  on_run(command, run, [options] { return run_bench(*options); });
}

}  // namespace voxref
