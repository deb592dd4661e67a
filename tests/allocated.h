#pragma once
#include <cstddef>

namespace voxref {

/// Whether this program can tell what it allocates: not where a sanitizer brings an allocator of its own.
bool counts_allocations();

/// Bytes that `new` handed out and did not get back, as the C library counts them.
size_t allocated_bytes();

/// The most of them at any time since the last call.
size_t take_peak_of_allocated_bytes();

}  // namespace voxref
