#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace voxref {

/// A set of bricks of a volume, by their brick coordinates.
class BrickSet {
 public:
  /// @param size bricks per side
  explicit BrickSet(const glm::ivec3& size) : size_(size), members_(size_t(size.x) * size_t(size.y) * size_t(size.z)) {}

  void add(const glm::ivec3& b) {
    members_[size_t(b.x) + size_t(size_.x) * (size_t(b.y) + size_t(size_.y) * size_t(b.z))] = true;
  }
  /// Its members, sorted z, y, x.
  std::vector<glm::ivec3> sorted() const {
    std::vector<glm::ivec3> bricks;
    size_t index = 0;
    for (int z = 0; z < size_.z; ++z)
      for (int y = 0; y < size_.y; ++y)
        for (int x = 0; x < size_.x; ++x)
          if (members_[index++]) bricks.emplace_back(x, y, z);
    return bricks;
  }

 private:
  glm::ivec3 size_;
  std::vector<bool> members_;
};

/// A volume of texels that is stored in bricks of 8^3; a brick without content takes no memory but its table entry, and
/// reads as Texel{}. Inside a brick texels lie x fastest, then y, then z.
template <class Texel>
class BrickVolume {
 public:
  static constexpr int side = 8;
  static constexpr size_t texels_per_brick = size_t(side) * side * side;
  static constexpr uint32_t absent = ~0u;

  BrickVolume() = default;
  explicit BrickVolume(const glm::ivec3& size)
      : size_(size),
        bricks_((size + side - 1) / side),
        slots_(size_t(bricks_.x) * size_t(bricks_.y) * size_t(bricks_.z), absent) {}

  const glm::ivec3& size() const { return size_; }          ///< texels per side
  const glm::ivec3& brick_grid() const { return bricks_; }  ///< bricks per side
  size_t brick_count() const { return texels_.size() / texels_per_brick; }
  size_t bytes() const { return texels_.capacity() * sizeof(Texel) + slots_.capacity() * sizeof(uint32_t); }

  bool contains(const glm::ivec3& v) const {
    return uint32_t(v.x) < uint32_t(size_.x) && uint32_t(v.y) < uint32_t(size_.y) && uint32_t(v.z) < uint32_t(size_.z);
  }
  /// Slot of the brick at brick coordinates `b`, or `absent`.
  uint32_t slot(const glm::ivec3& b) const { return slots_[brick_index(b)]; }
  /// Slots of all bricks, x fastest, then y, then z.
  const uint32_t* slots() const { return slots_.data(); }
  const Texel* data() const { return texels_.data(); }  ///< slot after slot
  /// The brick's texels. @param slot not `absent`
  std::span<const Texel, texels_per_brick> brick(uint32_t slot) const {
    return std::span<const Texel, texels_per_brick>(texels_.data() + slot * texels_per_brick, texels_per_brick);
  }
  std::span<Texel, texels_per_brick> brick(uint32_t slot) {
    return std::span<Texel, texels_per_brick>(texels_.data() + slot * texels_per_brick, texels_per_brick);
  }

  /// Allocates bricks, in the order given, which must hold no brick twice; existing content is dropped.
  void allocate(std::span<const glm::ivec3> bricks) {
    std::fill(slots_.begin(), slots_.end(), absent);
    uint32_t next = 0;
    for (const glm::ivec3& b : bricks) slots_[brick_index(b)] = next++;
    texels_.assign(bricks.size() * texels_per_brick, Texel{});
  }

  /// Coordinates of the allocated bricks, by slot.
  std::vector<glm::ivec3> bricks() const {
    std::vector<glm::ivec3> result(brick_count());
    size_t index = 0;
    for (int z = 0; z < bricks_.z; ++z)
      for (int y = 0; y < bricks_.y; ++y)
        for (int x = 0; x < bricks_.x; ++x, ++index)
          if (slots_[index] != absent) result[slots_[index]] = {x, y, z};
    return result;
  }

  /// Texel at v, Texel{} outside the volume and in absent bricks.
  const Texel& operator()(const glm::ivec3& v) const {
    static const Texel empty{};
    if (!contains(v)) return empty;
    const uint32_t s = slot(v / side);
    return s == absent ? empty : texels_[s * texels_per_brick + offset(v)];
  }
  /// @param v in a brick that is allocated
  Texel& operator()(const glm::ivec3& v) { return texels_[slot(v / side) * texels_per_brick + offset(v)]; }

  std::span<const Texel> texels() const { return texels_; }
  std::span<Texel> texels() { return texels_; }

  static size_t offset(const glm::ivec3& v) {
    return size_t(v.x & (side - 1)) +
           size_t(side) * (size_t(v.y & (side - 1)) + size_t(side) * size_t(v.z & (side - 1)));
  }

 private:
  size_t brick_index(const glm::ivec3& b) const {
    return size_t(b.x) + size_t(bricks_.x) * (size_t(b.y) + size_t(bricks_.y) * size_t(b.z));
  }

  glm::ivec3 size_{0}, bricks_{0};
  std::vector<uint32_t> slots_;
  std::vector<Texel> texels_;
};

}  // namespace voxref
