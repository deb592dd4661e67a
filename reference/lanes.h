#pragma once
#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

// What is done to many paths alike is done side by side: values of one kind lie in one array, and plain loops over them
// call inline functions without branches, of which the compiler makes instructions that work on several at once. The
// results are those of one after the other, to the bit, whatever the instruction set.
//
// The loops marked VOXREF_WIDEST are compiled once per instruction set, and the program picks the widest that the
// processor has when it starts. Sanitizers are not ready yet when it does.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define VOXREF_WIDEST __attribute__((flatten, target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define VOXREF_WIDEST
#endif
/// Before a loop whose turns do not depend on one another, which the compiler cannot know of arrays behind pointers.
#if defined(__GNUC__) && !defined(__clang__)
#define VOXREF_INDEPENDENT _Pragma("GCC ivdep")
#else
#define VOXREF_INDEPENDENT
#endif

namespace voxref {

constexpr size_t most_lanes = 1024;

/// One value per path. A little longer than a power of two: arrays side by side then start in different cache sets.
template <class T>
using Lanes = std::array<T, most_lanes + 16>;

/// One vector per path.
struct Lanes3 {
  Lanes<float> x, y, z;

  glm::vec3 operator[](size_t i) const { return {x[i], y[i], z[i]}; }
  void set(size_t i, const glm::vec3& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};

/// Per component, because a whole vector chosen by address keeps a loop from being done side by side.
inline glm::vec3 select(bool condition, const glm::vec3& yes, const glm::vec3& no) {
  return {condition ? yes.x : no.x, condition ? yes.y : no.y, condition ? yes.z : no.z};
}

}  // namespace voxref
