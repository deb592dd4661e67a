#pragma once
#include <cstring>
#include <glm/vec3.hpp>
#include <vector>

#include "cone/occupancy.h"
#include "scene/scene.h"
#include "voxel/mipmap.h"

namespace voxref {

/// A sample of a cone whose texels grow with it.
struct ConeStep {
  float distance = 0.0f;  ///< from the march's start, world units
  int level = 0;          ///< finer of the two levels that are mixed; 0 is the base, k is Pyramid::levels[k - 1]
  float fraction = 0.0f;  ///< share of the coarser one, in [0,1)
  /// Coarsest level that is read.
  int coarsest() const { return level + (fraction > 0.0f); }
  /// What it counts beside the level below.
  float coarser_share() const { return fraction > 0.0f ? fraction : 1.0f; }
  float occlusion = 1.0f;  ///< what opacity here counts towards ambient occlusion, in (0,1]
};

/// What decides where a cone is sampled; lengths in world units.
struct ConeStepping {
  float unit = 1.0f;  ///< first distance; a diameter of 1 unit reads the base, of 2^k units level k
  float step = 0.5f;  ///< in diameters
  float end = 0.0f;   ///< no sample lies beyond
  int top = 0;        ///< coarsest level
  float falloff = 0;  ///< opacity in a cone of radius r counts 1 / (1 + falloff r)
};

/// The samples of all cones of one aperture: they do not depend on where a cone starts. Diameter d = 2 s tan, level
/// log2(d / unit), s grows by step x d (spec section 5, villegas2016). @param tan_half_angle above 0
std::vector<ConeStep> cone_steps(float tan_half_angle, const ConeStepping& stepping);

/// Such samples as marches read them, some side by side.
class ConeSteps {
 public:
  static constexpr size_t lanes = 8;
  struct Lanes {
    Float8 distance;
    Int8 coarsest;
    Float8 coarser_share;
  };

  ConeSteps() = default;
  /// @param voxel length of the base's, in the unit of the steps' distances
  ConeSteps(std::vector<ConeStep> steps, float voxel);

  size_t size() const { return steps_.size(); }
  const ConeStep& operator[](size_t i) const { return steps_[i]; }
  /// Of the samples from i on, i a multiple of `lanes`; what lies beyond the last repeats it.
  Lanes load(size_t i) const {
    Lanes group;
    std::memcpy(&group.distance, distances_.data() + i, sizeof group.distance);
    std::memcpy(&group.coarsest, coarsest_.data() + i, sizeof group.coarsest);
    std::memcpy(&group.coarser_share, coarser_shares_.data() + i, sizeof group.coarser_share);
    return group;
  }

  /// Whether so many samples lie so closely that it pays to ask for eight at once whether they find anything.
  bool narrow() const { return steps_.size() > lanes * lanes; }
  /// Where to ask for the samples from 8 i on, for those from 8 (i + 1) on, ..., i a multiple of `lanes`: when a
  /// look-up at this distance finds nothing in this level, nor does any of the eight in theirs. Of narrow() steps.
  void load_groups(size_t i, Float8& distance, Int8& level) const {
    std::memcpy(&distance, group_distances_.data() + i, sizeof distance);
    std::memcpy(&level, group_levels_.data() + i, sizeof level);
  }

 private:
  void add_group(size_t begin, size_t end, float voxel);

  std::vector<ConeStep> steps_;
  std::vector<float> distances_, coarser_shares_, group_distances_;
  std::vector<int32_t> coarsest_, group_levels_;
};

/// Where a cone runs: at distance s from its start it is at origin + s way.
struct ConeAxis {
  Float4 origin, way;   ///< voxels of the base
  glm::vec3 direction;  ///< unit

  /// Distances are in world units. @param start world
  ConeAxis(const Grid& grid, const glm::vec3& start, const glm::vec3& unit)
      : origin(to_float4(grid.to_voxels(start))), way(to_float4(unit / grid.voxel)), direction(unit) {}
  /// Distances are in voxels, as `start` is.
  ConeAxis(const glm::vec3& start, const glm::vec3& unit)
      : origin(to_float4(start)), way(to_float4(unit)), direction(unit) {}
};

struct RawCone {
  glm::vec3 radiance{0.0f};  ///< premultiplied sum, as stored
  float opacity = 0.0f;
  float occlusion = 0.0f;  ///< opacity weighted by ConeStep::occlusion
};

/// Marches volumes as the published shaders do: opacity is interpolated as it is stored, a sample's opacity does not
/// depend on the step's length, and what lies outside the volumes is their edge. At each sample C += (1 - a) c and
/// a += (1 - a) alpha until a >= 1. Faces count with the direction's squared components.
/// @param occupied of the pyramid
template <class Texel>
RawCone march_raw(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const ConeAxis& axis,
                  const ConeSteps& steps);

/// What a raw shadow cone lets through, in [0,1]: v += (1 - v) gain alpha until v >= 1, then 1 - v.
/// @param end samples beyond this distance are not taken
/// @param gain infinity: any alpha above 1e-30 is black
template <class Texel>
float march_raw_shadow(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const ConeAxis& axis,
                       const ConeSteps& steps, float end, float gain);

/// Whether a ray meets a box: the slab test of the published shaders, by which a ray that only grazes it does not.
bool meets(const Bounds& box, const glm::vec3& origin, const glm::vec3& direction);

}  // namespace voxref
