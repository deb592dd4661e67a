#include "allocated.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__)
#define VOXREF_COUNTS_ALLOCATIONS 0
#elif defined(__has_feature)
#define VOXREF_COUNTS_ALLOCATIONS (!__has_feature(address_sanitizer))
#else
#define VOXREF_COUNTS_ALLOCATIONS 1
#endif

namespace {

std::atomic<size_t> held{0}, peak{0};

}  // namespace

#if VOXREF_COUNTS_ALLOCATIONS
// All other forms of `new` and `delete` come down to these, but those for types that are aligned to more than 16 bytes,
// of which no volume is made.
void* operator new(size_t size) {
  void* memory = std::malloc(size);
  if (!memory) throw std::bad_alloc();
  const size_t now = held += malloc_usable_size(memory);
  size_t most = peak;
  while (now > most && !peak.compare_exchange_weak(most, now)) {
  }
  return memory;
}

void operator delete(void* memory) noexcept {
  held -= malloc_usable_size(memory);
  std::free(memory);
}
void operator delete(void* memory, size_t) noexcept { operator delete(memory); }
#endif

namespace voxref {

bool counts_allocations() { return VOXREF_COUNTS_ALLOCATIONS; }
size_t allocated_bytes() { return held; }
size_t take_peak_of_allocated_bytes() { return peak.exchange(held); }

}  // namespace voxref
