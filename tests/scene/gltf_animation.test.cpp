#include "scene/gltf_animation.h"

#include <cmath>

#include "catch.h"
#include "error.h"
#include "scene/gltf.h"
#include "scene/gltf_builder.h"

namespace {

/// The unit square moved by one curve.
GltfBuilder animated(const std::string& path, const std::string& interpolation, const std::vector<float>& times,
                     const std::vector<float>& values) {
  GltfBuilder builder = unit_square();
  const size_t input = builder.accessor(times, 1);
  const size_t output = builder.accessor(values, path == "rotation" ? 4 : 3);
  builder.json["animations"] = {
      {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
  return builder;
}

voxref::Scene load(const GltfBuilder& builder, std::optional<double> time) {
  const TemporaryFolder folder;
  voxref::LoadOptions options;
  options.time = time;
  return voxref::load_gltf(folder.write("scene.gltf", builder.text()), options);
}

/// Where the square's corner (0, 0, 0) is.
glm::vec3 origin(const GltfBuilder& builder, std::optional<double> time) { return load(builder, time).positions.at(0); }

}  // namespace

TEST_CASE("Without a time the animated node stands at rest, and is dynamic", "[gltf]") {
  const GltfBuilder builder = animated("translation", "LINEAR", {0, 1}, {5, 0, 0, 6, 0, 0});
  CHECK(origin(builder, std::nullopt) == glm::vec3(0));
  CHECK(origin(builder, 0.0) == glm::vec3(5, 0, 0));
  CHECK(load(builder, std::nullopt).objects.at(0).dynamic);
}

TEST_CASE("Linear translation passes through its keys and holds at the ends", "[gltf]") {
  const GltfBuilder builder = animated("translation", "LINEAR", {1, 2, 4}, {0, 0, 0, 8, 0, 0, 8, 4, 0});
  CHECK(origin(builder, -1.0) == glm::vec3(0));
  CHECK(origin(builder, 1.25) == glm::vec3(2, 0, 0));
  CHECK(origin(builder, 2.0) == glm::vec3(8, 0, 0));
  CHECK(origin(builder, 3.0) == glm::vec3(8, 2, 0));
  CHECK(origin(builder, 99.0) == glm::vec3(8, 4, 0));
}

TEST_CASE("Steps hold the value until the next key", "[gltf]") {
  const GltfBuilder builder = animated("translation", "STEP", {0, 1}, {1, 0, 0, 2, 0, 0});
  CHECK(origin(builder, 0.999) == glm::vec3(1, 0, 0));
  CHECK(origin(builder, 1.0) == glm::vec3(2, 0, 0));
}

TEST_CASE("Rotations turn at constant speed the short way round", "[gltf]") {
  // From 0 to 120 degrees about Z, the second quaternion with the opposite sign, which means the same rotation.
  const double half = std::acos(-1.0) / 3.0;
  const GltfBuilder builder =
      animated("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, -float(std::sin(half)), -float(std::cos(half))});
  for (double t : {0.25, 0.5, 1.0}) {
    const glm::vec3 x = load(builder, t).positions.at(1);         // was (1, 0, 0)
    CHECK(x.x == Approx(std::cos(2.0 * half * t)).margin(1e-6));  // a float quaternion has 7 digits
    CHECK(x.y == Approx(std::sin(2.0 * half * t)).margin(1e-6));
  }
}

TEST_CASE("A cubic spline with the tangents of a parabola is that parabola", "[gltf]") {
  // y = t^2 over [0, 2]: slope 0 at the start, 4 at the end. Per key: in-tangent, value, out-tangent.
  const GltfBuilder builder =
      animated("translation", "CUBICSPLINE", {0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 4, 0, 0, 0, 0});
  for (double t : {0.0, 0.3, 1.0, 1.7, 2.0}) CHECK(origin(builder, t).y == Approx(t * t).margin(1e-6));
}

TEST_CASE("Scale is animated too", "[gltf]") {
  const GltfBuilder builder = animated("scale", "LINEAR", {0, 1}, {1, 1, 1, 3, 1, 1});
  CHECK(load(builder, 0.5).positions.at(1) == glm::vec3(2, 0, 0));
}

TEST_CASE("What hangs on an animated node moves with it and is dynamic", "[gltf]") {
  GltfBuilder builder = animated("translation", "LINEAR", {0, 1}, {0, 0, 0, 2, 0, 0});
  builder.json["nodes"] = R"([{"children": [1]}, {"mesh": 0}, {"mesh": 0}])"_json;
  builder.json["scenes"] = R"([{"nodes": [0, 2]}])"_json;
  const voxref::Scene scene = load(builder, 1.0);
  CHECK(scene.positions.at(0) == glm::vec3(2, 0, 0));
  CHECK(scene.objects.at(0).dynamic);
  CHECK_FALSE(scene.objects.at(1).dynamic);
}

TEST_CASE("Animations that make no sense are refused", "[gltf]") {
  SECTION("times that do not increase") {
    CHECK_THROWS_AS(origin(animated("scale", "LINEAR", {1, 1}, {1, 1, 1, 1, 1, 1}), {}), voxref::Error);
  }
  SECTION("too few values") {
    CHECK_THROWS_AS(origin(animated("scale", "CUBICSPLINE", {0, 1}, {1, 1, 1, 1, 1, 1}), {}), voxref::Error);
  }
  SECTION("an unknown interpolation") {
    CHECK_THROWS_AS(origin(animated("scale", "CUBIC", {0, 1}, {1, 1, 1, 1, 1, 1}), {}), voxref::Error);
  }
  SECTION("an unknown property") {
    CHECK_THROWS_AS(origin(animated("colour", "LINEAR", {0, 1}, {1, 1, 1, 1, 1, 1}), {}), voxref::Error);
  }
  SECTION("a zero quaternion") {
    CHECK_THROWS_AS(origin(animated("rotation", "LINEAR", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1}), {}), voxref::Error);
  }
  SECTION("a node with a matrix") {
    GltfBuilder builder = animated("scale", "LINEAR", {0, 1}, {1, 1, 1, 1, 1, 1});
    builder.json["nodes"][0]["matrix"] = R"([1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])"_json;
    CHECK_THROWS_AS(origin(builder, {}), voxref::Error);
  }
}
