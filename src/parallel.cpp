// The one file that knows about threads.
#include "parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <xmmintrin.h>

#include <algorithm>

namespace voxref {

namespace {

/// IEEE 754 arithmetic while it lives, denormal numbers included, rounding to nearest. Embree leaves some of the
/// threads that it shares with us in a mode that takes denormals for zero: results would depend on which thread got
/// which work.
class PlainArithmetic {
 public:
  PlainArithmetic() : found_(_mm_getcsr()) { _mm_setcsr(usual); }
  ~PlainArithmetic() { _mm_setcsr(found_); }
  PlainArithmetic(const PlainArithmetic&) = delete;

 private:
  static constexpr unsigned usual = 0x1f80;  ///< the processor's state at start: all exceptions masked
  unsigned found_;
};

}  // namespace

struct ThreadLimit::Impl {
  explicit Impl(size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : impl_(std::make_unique<Impl>(
          static_cast<size_t>(threads > 0 ? threads : std::max(1, tbb::info::default_concurrency())))) {}
ThreadLimit::~ThreadLimit() = default;

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
  grain = std::max<size_t>(grain, 1);
  const size_t chunks = (count + grain - 1) / grain;
  tbb::parallel_for(
      size_t{0}, chunks,
      [&](size_t chunk) {
        const PlainArithmetic plain;
        body(chunk * grain, std::min(count, (chunk + 1) * grain));
      },
      tbb::simple_partitioner());
}

}  // namespace voxref
