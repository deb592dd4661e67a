// The one file that knows about threads.
#include "parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>

namespace voxref {

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
      size_t{0}, chunks, [&](size_t chunk) { body(chunk * grain, std::min(count, (chunk + 1) * grain)); },
      tbb::simple_partitioner());
}

}  // namespace voxref
