#include "parallel.h"

#include <xmmintrin.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "catch.h"

using namespace voxref;

TEST_CASE("every index is visited once, in ranges that the thread count does not change", "[parallel]") {
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    CHECK(thread_count() == threads);
    std::vector<std::atomic<int>> visits(1003);
    std::vector<size_t> ends(11);
    parallel_for(visits.size(), 100, [&](size_t begin, size_t end) {
      ends[begin / 100] = end;
      for (size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const std::atomic<int>& n : visits) REQUIRE(n == 1);
    for (size_t i = 0; i < 10; ++i) CHECK(ends[i] == 100 * (i + 1));
    CHECK(ends[10] == 1003);
  }
}

TEST_CASE("a body's exception reaches the caller", "[parallel]") {
  CHECK_THROWS_AS(parallel_for(100, 1,
                               [](size_t begin, size_t) {
                                 if (begin == 42) throw std::runtime_error("42");
                               }),
                  std::runtime_error);
  int calls = 0;
  parallel_for(0, 10, [&](size_t, size_t) { ++calls; });
  CHECK(calls == 0);
}

TEST_CASE("denormal numbers count on every thread, whatever mode a library left it in", "[parallel]") {
  constexpr unsigned flush_and_zero = 0x8040;  // FTZ and DAZ of the SSE control register
  const unsigned found = _mm_getcsr();
  _mm_setcsr(found | flush_and_zero);
  std::vector<int> kept(64);
  parallel_for(kept.size(), 1, [&](size_t begin, size_t) {
    volatile float denormal = 1e-40f;
    kept[begin] = denormal * 0x1p100f > 0.0f;
  });
  const unsigned after = _mm_getcsr();
  _mm_setcsr(found);
  CHECK(std::accumulate(kept.begin(), kept.end(), 0) == 64);
  constexpr unsigned mode = ~0x3fu;  // but for the exceptions seen so far
  CHECK((after & mode) == ((found | flush_and_zero) & mode));
}
