#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace voxref {

/// Caps the threads of everything below it while it lives, Embree's builds included. One thread and N threads give the
/// same bits everywhere in voxref, so this only changes the time taken.
class ThreadLimit {
 public:
  /// @param threads at least 1; 0 means all cores
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Threads that parallel_for may use now.
int thread_count();

/// Calls body(begin, end) for consecutive ranges of at most `grain` indices that together cover [0, count). The cut
/// depends on `count` and `grain` alone, never on the number of threads: partial results indexed by begin / grain merge
/// to the same bits. Bodies compute with denormal numbers, whatever mode their thread was left in. An exception from a
/// body ends the loop and is rethrown.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body);

}  // namespace voxref
