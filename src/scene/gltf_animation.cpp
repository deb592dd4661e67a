#include "scene/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace voxref {
namespace {

enum class Interpolation { step, linear, cubic_spline };

/// A curve through values of `components` numbers. CUBICSPLINE stores in-tangent, value and out-tangent for each key.
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  int components = 3;
  std::vector<float> times;  ///< seconds, increasing
  std::vector<float> values;

  glm::dvec4 stored(size_t key, size_t slot) const {
    const size_t slots = interpolation == Interpolation::cubic_spline ? 3 : 1;
    glm::dvec4 value(0.0);
    for (int i = 0; i < components; ++i) value[i] = values[(key * slots + slot) * components + i];
    return value;
  }
  glm::dvec4 value(size_t key) const { return stored(key, interpolation == Interpolation::cubic_spline ? 1 : 0); }
};

glm::dquat quaternion(const glm::dvec4& xyzw) { return {xyzw.w, xyzw.x, xyzw.y, xyzw.z}; }
glm::dvec4 components_of(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

/// glTF 2.0, appendix C.
glm::dvec4 evaluate(const Curve& curve, double time) {
  const size_t count = curve.times.size();
  if (time <= curve.times.front()) return curve.value(0);
  if (time >= curve.times.back()) return curve.value(count - 1);
  const size_t next = std::upper_bound(curve.times.begin(), curve.times.end(), time) - curve.times.begin();
  const size_t key = next - 1;
  const double duration = static_cast<double>(curve.times[next]) - curve.times[key];
  const double t = (time - curve.times[key]) / duration;
  switch (curve.interpolation) {
    case Interpolation::step:
      return curve.value(key);
    case Interpolation::linear:
      if (curve.components == 4)
        return components_of(
            glm::slerp(quaternion(glm::normalize(curve.value(key))), quaternion(glm::normalize(curve.value(next))), t));
      return glm::mix(curve.value(key), curve.value(next), t);
    case Interpolation::cubic_spline: {
      const double t2 = t * t, t3 = t2 * t;
      return (2.0 * t3 - 3.0 * t2 + 1.0) * curve.value(key) + duration * (t3 - 2.0 * t2 + t) * curve.stored(key, 2) +
             (-2.0 * t3 + 3.0 * t2) * curve.value(next) + duration * (t3 - t2) * curve.stored(next, 0);
    }
  }
  return curve.value(key);
}

Curve read_curve(const GltfDocument& document, std::span<const GltfAccessor> accessors, const GltfValue& sampler,
                 int components) {
  Curve curve;
  curve.components = components;
  const std::string interpolation = sampler.text("interpolation", "LINEAR");
  if (interpolation == "STEP")
    curve.interpolation = Interpolation::step;
  else if (interpolation == "CUBICSPLINE")
    curve.interpolation = Interpolation::cubic_spline;
  else if (interpolation != "LINEAR")
    sampler.at("interpolation").fail("must be STEP, LINEAR or CUBICSPLINE");

  const GltfValue input = sampler.at("input"), output = sampler.at("output");
  const GltfAccessor& times = accessors[input.index(accessors.size(), "accessors")];
  const GltfAccessor& values = accessors[output.index(accessors.size(), "accessors")];
  if (times.components != 1 || times.component != Component::float32) input.fail("times must be float SCALAR");
  const bool real = values.component == Component::float32 || values.normalized;
  if (values.components != components || values.matrix || !real)
    output.fail(fmt::format("values must be VEC{}, float or normalized", components));
  const size_t per_key = curve.interpolation == Interpolation::cubic_spline ? 3 : 1;
  if (values.count != times.count * per_key)
    output.fail(fmt::format("{} values for {} keys", values.count, times.count));
  curve.times = read_floats(document, times);
  curve.values = read_floats(document, values);
  for (size_t i = 1; i < curve.times.size(); ++i)
    if (!(curve.times[i] > curve.times[i - 1])) input.fail(fmt::format("time {} is not after the one before", i));
  if (components == 4)
    for (size_t i = 0; i < curve.times.size(); ++i)
      if (curve.value(i) == glm::dvec4(0.0)) output.fail(fmt::format("the quaternion of key {} is zero", i));
  return curve;
}

void pose(GltfNode& node, const std::string& path, const glm::dvec4& value, const GltfValue& place) {
  if (path == "translation") node.translation = value;
  if (path == "scale") node.scale = value;
  if (path == "rotation") {
    const double length = glm::length(value);
    if (!(length > 0.0)) place.fail("the quaternion between two keys is zero");
    node.rotation = quaternion(value / length);
  }
}

}  // namespace

void animate(GltfDocument& document, std::span<const GltfAccessor> accessors, std::vector<GltfNode>& nodes,
             std::optional<double> time) {
  std::set<std::pair<uint32_t, std::string>> moved;
  for (const GltfValue& animation : document.list("animations")) {
    const std::vector<GltfValue> samplers = animation.at("samplers").items();
    for (const GltfValue& channel : animation.at("channels").items()) {
      const GltfValue& sampler = samplers.at(channel.at("sampler").index(samplers.size(), "samplers"));
      const GltfValue target = channel.at("target"), path = target.at("path");
      const auto index = target.index("node", nodes.size(), "nodes");
      if (path.text() == "weights") {
        warn_once(document.warnings, "morph targets are ignored");
        continue;
      }
      if (path.text() == "pointer") continue;  // KHR_animation_pointer, whose being ignored has been said
      if (path.text() != "translation" && path.text() != "rotation" && path.text() != "scale")
        path.fail("must be translation, rotation, scale or weights");
      if (!index) continue;  // aimed at something that only an extension knows
      GltfNode& node = nodes[*index];
      if (node.matrix) target.fail(fmt::format("nodes[{}] has a matrix and cannot be animated", *index));
      if (!moved.emplace(*index, path.text()).second)
        warn_once(document.warnings, "several animations move the same node; the last one counts");
      node.dynamic = true;
      const Curve curve = read_curve(document, accessors, sampler, path.text() == "rotation" ? 4 : 3);
      if (time) pose(node, path.text(), evaluate(curve, *time), channel);
    }
  }
}

}  // namespace voxref
