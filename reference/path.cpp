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
// passes on, 18 %, it serves; so a known number of samples is cut in at least so many passes, if not asked otherwise,
// of a power of two, at which Sobol points are best balanced, and a shorter pass where that leaves a rest. On the
// Cornell box at 64 samples 16 randomizations have 1.5 times the squared error of a single one.
constexpr int enough_passes = 16;

// A render that is stopped keeps its finished passes, so they must not last: about 4 million samples, which take
// seconds, but at least 16 per pixel, below which stratification has little effect, and at most a wave of paths, which
// takes milliseconds: only between two waves is a request to stop heard.
constexpr size_t samples_of_long_pass = size_t{1} << 22;
constexpr size_t fewest_at_most = 16, most_at_most = Wave::most_paths;

// Where the number of samples is open (a noise or a time to reach) it doubles after each 16 passes from the 32nd on, up
// to the longest pass: passes stay short against the whole, and the scatter is that of at least 48 equal ones.
constexpr int most_doublings = 10;

// Single samples are far from normally distributed, and a rule that stops where their scatter happens to be small takes
// too small an error bar: by 14 % where roulette is at work. Means of four are near enough.
constexpr int least_samples_before_noise = 4;

/// @returns a power of two
int most_samples_of_pass(const View& view) {
  const size_t pixels = static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
  return static_cast<int>(std::bit_floor(std::clamp(samples_of_long_pass / pixels, fewest_at_most, most_at_most)));
}

int samples_of_pass(int pass, const PathOptions& options, int most) {
  if (!options.noise && !options.seconds) {
    const auto equal = static_cast<unsigned>(std::max(1, options.spp / options.randomizations));
    return std::min(static_cast<int>(std::bit_floor(equal)), most);
  }
  const int least = options.noise ? least_samples_before_noise : 1;
  return std::min(least << std::clamp(pass / enough_passes - 1, 0, most_doublings), most);
}

void check(const PathOptions& options, const View& view) {
  (void)Image(view.width, view.height);  // refuses a bad size before anything is allocated
  if (options.spp < 0) throw Error("spp", std::to_string(options.spp) + " is below 0");
  if (options.spp == 0 && !options.noise && !options.seconds)
    throw Error("spp", "0, no limit, needs a noise or a time at which to stop");
  if (options.randomizations < 1) throw Error("randomizations", std::to_string(options.randomizations) + " is below 1");
  if (options.noise && !(*options.noise > 0.0)) throw Error("noise", "must be above 0");
  if (options.seconds && !(*options.seconds > 0.0)) throw Error("time", "must be above 0 seconds");
  if (options.max_depth && *options.max_depth < 0)
    throw Error("max-depth", std::to_string(*options.max_depth) + " is below 0");
  if (options.part.index < 1 || options.part.index > options.part.count ||
      static_cast<size_t>(options.part.count) > TileGrid(view.width, view.height).count())
    throw Error("part", "must be I/N, I from 1 to N, and N at most the number of tiles of " +
                            std::to_string(TileGrid::side) + "x" + std::to_string(TileGrid::side) + " pixels");
  if (options.part.count > 1 && (options.noise || options.seconds))
    throw Error("part", "needs a number of samples: parts cannot agree on a noise or a time at which to stop");
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

/// A render under way.
class Render {
 public:
  Render(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options)
      : view_(view),
        options_(options),
        renderer_(scene, caster, view, {options.max_depth, options.energy_compensation}, options.seed, options.extra,
                  options.part),
        film_(view.width, view.height, options.extra) {
    if (options.checkpoint.resume) resume();
  }

  /// Until the goal is reached or the caller cancels. @throws Interrupted before the first samples
  PathResult run(const Progress& progress) {
    bool interrupted = false;
    while (!interrupted && begin_pass()) {
      const bool finished = renderer_.advance(
          progress, [this] { return checkpoint_due(); },
          [&](double fraction) {
            progress("path tracing", voxref::finished(options_, now_, fraction * renderer_.pass().samples, seconds()));
          });
      if (finished) end_pass();
      interrupted = progress.cancelled() && (!finished || begin_pass());
      if (interrupted && now_.passes == 0) throw Interrupted();
      if (interrupted || checkpoint_due()) save();
    }
    return result(interrupted);
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// False when there is nothing left to do.
  bool begin_pass() {
    if (!renderer_.finished()) return true;
    const int samples = next_samples(options_, now_, most_samples_of_pass(view_));
    if (samples > 0) renderer_.begin({now_.passes, samples, now_.samples});
    return samples > 0;
  }

  void end_pass() {
    film_.add(renderer_.batches(), renderer_.pass().samples, renderer_.extra_batches());
    counts_.add(renderer_.counts());
    measure();
  }

  void measure() {
    now_ = {film_.passes(), film_.samples(), seconds(), now_.noise};
    if (options_.noise && now_.passes >= enough_passes) now_.noise = film_.noise();
  }

  double seconds() const { return seconds_before_ + std::chrono::duration<double>(Clock::now() - start_).count(); }

  bool checkpoint_due() const {
    return !options_.checkpoint.file.empty() &&
           std::chrono::duration<double>(Clock::now() - last_save_).count() >= options_.checkpoint.interval;
  }

  void save() {
    if (options_.checkpoint.file.empty()) return;
    write_checkpoint(options_.checkpoint, [this](StateWriter& writer) {
      writer.value(seconds());
      writer.value(counts_);
      film_.save(writer);
      renderer_.save(writer);
    });
    last_save_ = Clock::now();
  }

  void resume() {
    if (read_checkpoint(options_.checkpoint, [this](StateReader& reader) {
          reader.value(seconds_before_);
          reader.value(counts_);
          film_.load(reader);
          renderer_.load(reader);
        }))
      measure();
  }

  PathResult result(bool interrupted) const {
    PathResult result;
    result.image = film_.image();
    result.mean = film_.mean();
    result.mean_stderr = film_.mean_stderr();
    result.spp = now_.samples;
    result.seconds = now_.seconds;
    result.closest_rays = counts_.paths.closest_rays;
    result.occlusion_rays = counts_.paths.occlusion_rays;
    result.rays = result.closest_rays + result.occlusion_rays;
    result.nonfinite = counts_.paths.nonfinite;
    if (result.nonfinite > 0) result.first_nonfinite = describe(counts_.first_nonfinite, view_.width);
    result.interrupted = interrupted;
    return result;
  }

  const View& view_;
  const PathOptions& options_;
  PassRenderer renderer_;
  Film film_;
  PassCounts counts_;
  Standing now_;
  double seconds_before_ = 0.0;  // it was resumed
  Clock::time_point start_ = Clock::now(), last_save_ = start_;
};

}  // namespace

PathResult path_trace(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options,
                      const Progress& progress) {
  check(options, view);
  return Render(scene, caster, view, options).run(progress);
}

}  // namespace voxref
