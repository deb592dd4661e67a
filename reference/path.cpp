#include "reference/path.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <limits>
#include <string>

#include "reference/film.h"
#include "reference/pass.h"

namespace voxref {

namespace {

// Each pass adds one randomization to every pixel. More samples per pass are better stratified, and so less noisy; more
// passes tell the error better: with R of them the standard error is itself known to 1 / sqrt(2 (R - 1)). From 16
// passes on, 18 %, it serves; so a known number of samples is cut in at least 16 passes of a power of two, at which
// Sobol points are best balanced, and a shorter pass where that leaves a rest.
constexpr int least_passes = 16;

// A render that is stopped keeps its finished passes, so they must not last: about 4 million samples, which take
// seconds, but at least 16 per pixel, below which stratification has little effect, and at most 1024, which take
// milliseconds: only between two pixels is a request to stop heard.
constexpr size_t samples_of_long_pass = size_t{1} << 22;
constexpr size_t fewest_at_most = 16, most_at_most = 1024;

// Where the number of samples is open (a noise or a time to reach) it doubles after each 16 passes from the 32nd on, up
// to the longest pass: passes stay short against the whole, and the scatter is that of at least 48 equal ones.
constexpr int most_doublings = 10;

/// @returns a power of two
int most_samples_of_pass(const View& view) {
  const size_t pixels = static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
  return static_cast<int>(std::bit_floor(std::clamp(samples_of_long_pass / pixels, fewest_at_most, most_at_most)));
}

int samples_of_pass(int pass, const PathOptions& options, int most) {
  if (!options.noise && !options.seconds) {
    const auto equal = static_cast<unsigned>(std::max(1, options.spp / least_passes));
    return std::min(static_cast<int>(std::bit_floor(equal)), most);
  }
  return std::min(1 << std::clamp(pass / least_passes - 1, 0, most_doublings), most);
}

void check(const PathOptions& options, const View& view) {
  (void)Image(view.width, view.height);  // refuses a bad size before anything is allocated
  if (options.spp < 0) throw Error("spp", std::to_string(options.spp) + " is below 0");
  if (options.spp == 0 && !options.noise && !options.seconds)
    throw Error("spp", "0, no limit, needs a noise or a time at which to stop");
  if (options.noise && !(*options.noise > 0.0)) throw Error("noise", "must be above 0");
  if (options.seconds && !(*options.seconds > 0.0)) throw Error("time", "must be above 0 seconds");
  if (options.max_depth && *options.max_depth < 0)
    throw Error("max-depth", std::to_string(*options.max_depth) + " is below 0");
  if (options.extra.bounces < 0) throw Error("bounces", std::to_string(options.extra.bounces) + " is below 0");
}

/// How far a render is, between two passes.
struct Standing {
  int passes = 0, samples = 0;
  double seconds = 0.0;
  double noise = std::numeric_limits<double>::infinity();  ///< unknown before there are enough passes
};

int most_samples(const PathOptions& options) { return options.spp > 0 ? options.spp : std::numeric_limits<int>::max(); }

/// Samples of the next pass, at most `most`; 0 when the goal is reached. There is always a first pass.
int next_samples(const PathOptions& options, const Standing& now, int most) {
  const int samples = std::min(samples_of_pass(now.passes, options, most), most_samples(options) - now.samples);
  if (now.passes == 0) return samples;
  // The noise is a mean over the image: what a single pixel happened to find has next to no say in when it stops, and
  // so stopping does not bias the pixel.
  if (options.noise && now.noise <= *options.noise) return 0;
  // A pass that would end too late is not begun.
  if (options.seconds && now.seconds + now.seconds / now.samples * samples > *options.seconds) return 0;
  return samples;
}

/// Finished fraction of the work after `samples` further samples.
double finished(const PathOptions& options, const Standing& now, double samples, double seconds) {
  const double taken = now.samples + samples;
  double fraction = taken / most_samples(options);
  if (options.seconds) fraction = std::max(fraction, seconds / *options.seconds);
  // The error falls with the square root of the samples.
  if (options.noise && now.samples > 0)
    fraction = std::max(fraction, *options.noise * *options.noise / (now.noise * now.noise) * taken / now.samples);
  return std::min(fraction, 1.0);
}

std::string describe(const SamplePlace& place, int width) {
  const size_t columns = static_cast<size_t>(width);
  return "pixel (" + std::to_string(place.pixel % columns) + ", " + std::to_string(place.pixel / columns) +
         ") sample " + std::to_string(place.sample);
}

}  // namespace

PathResult path_trace(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options,
                      const Progress& progress) {
  check(options, view);
  PassRenderer renderer(scene, caster, view, options.max_depth, options.seed, options.extra);
  Film film(view.width, view.height, options.extra);
  PathResult result;
  PassCounts counts;
  Standing now;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };

  while (const int samples = next_samples(options, now, most_samples_of_pass(view))) {
    const std::optional<PassCounts> pass = renderer.render(
        {now.passes, samples, now.samples}, progress,
        [&](double fraction) { progress("path tracing", finished(options, now, fraction * samples, seconds())); });
    if (!pass) {
      if (now.passes == 0) throw Interrupted();
      result.interrupted = true;
      break;
    }
    film.add(renderer.batches(), samples, renderer.extra_batches());
    counts.add(*pass);
    now = {film.passes(), film.samples(), seconds(), now.noise};
    if (options.noise && now.passes >= least_passes) now.noise = film.noise();
  }

  result.image = film.image();
  result.mean = film.mean();
  result.mean_stderr = film.mean_stderr();
  result.spp = now.samples;
  result.seconds = now.seconds;
  result.closest_rays = counts.paths.closest_rays;
  result.occlusion_rays = counts.paths.occlusion_rays;
  result.rays = result.closest_rays + result.occlusion_rays;
  result.nonfinite = counts.paths.nonfinite;
  if (result.nonfinite > 0) result.first_nonfinite = describe(counts.first_nonfinite, view.width);
  return result;
}

}  // namespace voxref
