#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bench_spread.h"
#include "bench_stages.h"

namespace voxref {
namespace {

/// Of the published shaders at 256 voxels and 256x256 pixels, through a software OpenGL on one core, milliseconds. Both
/// passes of the mipmaps; the bounce without its own.
struct Published {
  const char* stage;
  double milliseconds;
};
constexpr std::array<Published, 5> published = {
    {{"voxelize", 117}, {"shade", 2741}, {"mipmap", 424}, {"bounce", 9334}, {"image", 1219}}};

double seconds_of(const std::vector<StageBench>& stages, const std::string& stage) {
  return spread(std::ranges::find(stages, stage, &StageBench::stage)->seconds).median;
}

/// The same work as the published time's.
double same_work(const std::vector<StageBench>& stages, const std::string& stage) {
  const double mipmap = seconds_of(stages, "mipmap");
  if (stage == "mipmap") return 2.0 * mipmap;
  if (stage == "image") return seconds_of(stages, "prepare") + seconds_of(stages, stage);
  return seconds_of(stages, stage) - (stage == "bounce" ? mipmap : 0.0);
}

}  // namespace

void say(Terminal& terminal, const std::vector<StageBench>& stages, double bandwidth) {
  for (const StageBench& s : stages) {
    const double seconds = spread(s.seconds).median;
    terminal.say(fmt::format(
        "  {:<12} {:>9.4f} s ({:.4f} to {:.4f})  {:>9.3f} million {}/s  {:>6.2f} GB/s, {:.1f} % of the triad", s.stage,
        seconds, *std::ranges::min_element(s.seconds), *std::ranges::max_element(s.seconds), 1e-6 * s.count / seconds,
        s.unit, 1e-9 * s.bytes / seconds, 100.0 * s.bytes / seconds / bandwidth));
  }
}

nlohmann::json to_json(const std::vector<StageBench>& stages, double bandwidth) {
  nlohmann::json list = nlohmann::json::array();
  for (const StageBench& s : stages) {
    const double seconds = spread(s.seconds).median;
    list.push_back({{"stage", s.stage},
                    {"seconds", s.seconds},
                    {"unit", s.unit},
                    {"count", s.count},
                    {"per_second", s.count / seconds},
                    {"bytes_per_second", s.bytes / seconds},
                    {"share_of_bandwidth", s.bytes / seconds / bandwidth}});
  }
  return list;
}

void say_published(Terminal& terminal, const std::vector<StageBench>& stages) {
  for (const Published& p : published) {
    const double milliseconds = 1e3 * same_work(stages, p.stage);
    terminal.say(fmt::format("  {:<12} {:>9.1f} ms on one core, published shaders {:.0f} ms: {:.1f} times", p.stage,
                             milliseconds, p.milliseconds, p.milliseconds / milliseconds));
  }
}

nlohmann::json published_to_json(const std::vector<StageBench>& stages) {
  nlohmann::json list = nlohmann::json::array();
  for (const Published& p : published) {
    const double milliseconds = 1e3 * same_work(stages, p.stage);
    list.push_back({{"stage", p.stage},
                    {"milliseconds", milliseconds},
                    {"published_milliseconds", p.milliseconds},
                    {"times_faster", p.milliseconds / milliseconds}});
  }
  return list;
}

}  // namespace voxref
