#include "compare/volume_diff.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "catch.h"
#include "compare/volume_causes.h"
#include "compare/volume_folder.h"
#include "voxel/npy.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;
using testing::tamper;

constexpr glm::ivec3 size{6, 5, 4};

/// A volume of four channels in which all voxels differ, opacity included.
fs::path write_volume(const fs::path& file, const std::function<glm::vec4(const glm::ivec3&)>& texel,
                      const glm::ivec3& dims = size, ElementType type = ElementType::float32) {
  const std::array<size_t, 4> shape = {size_t(dims.z), size_t(dims.y), size_t(dims.x), 4};
  write_npy(file, type, shape, [&](size_t z, std::span<float> slice) {
    float* to = slice.data();
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x, to += 4) {
        const glm::vec4 t = texel({x, y, int(z)});
        std::copy_n(&t.x, 4, to);
      }
  });
  return file;
}

glm::vec4 varied(const glm::ivec3& v) {
  const auto x = float(v.x), y = float(v.y), z = float(v.z);
  return {0.1f + 0.1f * x, 0.2f + 0.15f * y, 0.05f + 0.2f * z, 0.3f + 0.02f * x + 0.05f * y + 0.1f * z};
}

VolumeDifference diff_files(const fs::path& a, const fs::path& b, const TexelEnvelope& envelope = {}) {
  return diff_volumes(VolumeEntry{}, VolumeSource{a}, VolumeSource{b}, {}, envelope);
}

std::string cause_of(const fs::path& a, const fs::path& b) {
  ArrayFile file_a(a, 0, ArrayMeaning::volume), file_b(b, 0, ArrayMeaning::volume);
  const std::vector<Cause> causes = volume_causes(file_a, file_b, {});
  return causes.empty() ? "" : causes.front().mistake;
}

}  // namespace

TEST_CASE("A volume's difference has its place, its size in steps of the storage, and occupancy apart", "[diff]") {
  const TemporaryFolder folder;
  const fs::path b = write_volume(folder.path / "b.npy", varied, size, ElementType::uint8);
  const fs::path a = write_volume(
      folder.path / "a.npy",
      [](const glm::ivec3& v) {
        glm::vec4 t = varied(v);
        if (v == glm::ivec3(4, 2, 1)) t.g += 3.0f / 255.0f;
        if (v == glm::ivec3(1, 3, 3)) t = glm::vec4(0.0f);
        return t;
      },
      size, ElementType::uint8);
  const VolumeDifference diff = diff_files(a, b);
  CHECK(diff.values.differing == 1 + 4);
  REQUIRE(diff.values.first);
  CHECK(diff.values.first->at == glm::ivec3(4, 2, 1));
  CHECK(diff.values.first->channel == 1);
  CHECK(diff.occupied_b == 6 * 5 * 4);
  CHECK(diff.occupied_a == 6 * 5 * 4 - 1);
  CHECK(diff.occupied_only_b == 1);
  CHECK(diff.occupied_only_a == 0);
  CHECK(diff.steps == Approx(std::round(255.0f * varied({1, 3, 3}).a)));  // the largest value that was cleared
  CHECK(diff.differs({}));
  CHECK(!diff_files(b, b).differs({}));
}

TEST_CASE("Steps of half precision grow with the value", "[diff]") {
  const TemporaryFolder folder;
  // Between 1 and 2 halves are 2^-10 apart, between 0.25 and 0.5 2^-12.
  const auto constant = [](float v) { return [v](const glm::ivec3&) { return glm::vec4(v); }; };
  const auto steps = [&](float a, float b) {
    return diff_files(write_volume(folder.path / "a.npy", constant(a), size, ElementType::float16),
                      write_volume(folder.path / "b.npy", constant(b), size, ElementType::float16))
        .steps;
  };
  CHECK(steps(1.5f + 3.0f / 1024.0f, 1.5f) == 3.0);
  CHECK(steps(0.3125f + 3.0f / 1024.0f, 0.3125f) == 12.0);
}

TEST_CASE("Each planted mistake of a volume is named", "[diff]") {
  struct Planted {
    const char* cause;
    std::function<glm::vec4(const glm::ivec3&)> texel;
    glm::ivec3 dims = size;
  };
  const auto at = [](int x, int y, int z) { return varied({x, y, z}); };
  const std::vector<Planted> all = {
      {"y flipped", [&](const glm::ivec3& v) { return at(v.x, size.y - 1 - v.y, v.z); }},
      {"z flipped", [&](const glm::ivec3& v) { return at(v.x, v.y, size.z - 1 - v.z); }},
      {"axes swapped: zyx stored as xyz",
       [&](const glm::ivec3& v) { return at(v.z, v.y, v.x); },
       {size.z, size.y, size.x}},
      {"BGR stored as RGB",
       [&](const glm::ivec3& v) {
         const glm::vec4 t = varied(v);
         return glm::vec4(t.b, t.g, t.r, t.a);
       }},
      {"premultiplied by alpha",
       [&](const glm::ivec3& v) {
         const glm::vec4 t = varied(v);
         return glm::vec4(glm::vec3(t) * t.a, t.a);
       }},
      {"not premultiplied by alpha",
       [&](const glm::ivec3& v) {
         const glm::vec4 t = varied(v);
         return glm::vec4(glm::vec3(t) / t.a, t.a);
       }},
      {"missing 1/pi",
       [&](const glm::ivec3& v) {
         const glm::vec4 t = varied(v);
         return glm::vec4(3.14159265f * glm::vec3(t), t.a);
       }},
      {"stored as 0.5 v + 0.5",
       [&](const glm::ivec3& v) {
         const glm::vec4 t = varied(v);
         return glm::vec4(0.5f * glm::vec3(t) + 0.5f, t.a);
       }},
      {"shifted by (0, 1, 0) voxel", [&](const glm::ivec3& v) { return at(v.x, v.y - 1, v.z); }},
      {"shifted by half a voxel towards (1, 0, 0)",
       [&](const glm::ivec3& v) { return 0.5f * (at(v.x, v.y, v.z) + at(v.x - 1, v.y, v.z)); }},
  };
  const TemporaryFolder folder;
  const fs::path b = write_volume(folder.path / "b.npy", varied);
  for (const Planted& planted : all) {
    INFO(planted.cause);
    const std::string named = cause_of(write_volume(folder.path / "a.npy", planted.texel, planted.dims), b);
    INFO("said: " << named);
    CHECK(named == planted.cause);
  }
  const fs::path noise = write_volume(folder.path / "a.npy", [](const glm::ivec3& v) {
    return varied(v) * (1.0f + 0.3f * std::sin(float(7 * v.x + 3 * v.y + 5 * v.z)));
  });
  CHECK(cause_of(noise, b).empty());
}

TEST_CASE("Folders are compared in the order of the pipeline, and the first volume that differs is told", "[diff]") {
  const TemporaryFolder folder;
  const fs::path a = folder.path / "a", b = folder.path / "b";
  testing::write_published_volumes(b);
  fs::copy(b, a);
  const FolderDifference same = diff_folders(a, b, {});
  CHECK(same.verdict == Verdict::same);
  CHECK(!same.first_divergence());
  CHECK(to_json(same)["first_divergence"].is_null());

  tamper(a, "radiance_bounce", 1);
  tamper(a, "aniso_pos_y_1", 2);
  const testing::Tampered place = tamper(a, "aniso_neg_z_0", 3);
  const nlohmann::json json = to_json(diff_folders(a, b, {}));
  CHECK(json["verdict"] == "different");
  // Of one stage in the order of the folder's index: faces come in their own order, z after y.
  CHECK(json["first_divergence"]["volume"] == "aniso_pos_y_1");
  CHECK(json["first_divergence"]["stage"] == "mipmap");
  CHECK(json["first_divergence"]["face"] == "pos_y");
  CHECK(json["first_divergence"]["level"] == 1);
  CHECK(json["worst"]["volume"] == "aniso_neg_z_0");
  CHECK(json["worst"]["place"] == nlohmann::json({place.voxel.x, place.voxel.y, place.voxel.z, place.channel}));

  fs::remove(a / "visibility.npy");
  std::string index = read_file(a / "volumes.json");
  auto document = nlohmann::json::parse(index);
  auto& volumes = document["volumes"];
  volumes.erase(std::ranges::find_if(volumes, [](const auto& v) { return v["name"] == "visibility"; }));
  write_text(a / "volumes.json", document.dump());
  CHECK(to_json(diff_folders(a, b, {}))["missing"] == nlohmann::json({"visibility"}));
  CHECK(diff_folders(a, b, {.fraction = 1.0}).verdict == Verdict::same);
  CHECK(diff_folders(a, b, {.fraction = 1.0, .strict = true}).verdict == Verdict::different);
}

TEST_CASE("Faces in another order and levels named one off are told as such", "[diff]") {
  const TemporaryFolder folder;
  const fs::path a = folder.path / "a", b = folder.path / "b";
  testing::write_published_volumes(b);
  const auto copy = [&] {
    fs::remove_all(a);
    fs::copy(b, a);
  };
  const auto causes = [&] {
    const FolderDifference difference = diff_folders(a, b, {});
    CHECK(difference.verdict == Verdict::different);
    return volume_causes(a, b, difference);
  };
  copy();
  for (int level = 0; level < 4; ++level)
    for (const char* bounced : {"aniso_", "aniso_bounce_"}) {
      const auto file = [&](const char* face) {
        return bounced + std::string(face) + "_" + std::to_string(level) + ".npy";
      };
      fs::copy(b / file("pos_y"), a / file("neg_y"), fs::copy_options::overwrite_existing);
      fs::copy(b / file("neg_y"), a / file("pos_y"), fs::copy_options::overwrite_existing);
    }
  REQUIRE(causes().size() == 1);
  CHECK(causes()[0].mistake == "faces in another order: neg_y holds pos_y, pos_y holds neg_y");

  copy();
  auto document = nlohmann::json::parse(read_file(a / "volumes.json"));
  for (auto& volume : document["volumes"]) {
    if (!volume.contains("level")) continue;
    const std::string name = volume["name"];
    const int level = volume["level"];
    if (level == 3) continue;
    const std::string next = name.substr(0, name.size() - 1) + std::to_string(level + 1);
    volume["file"] = next + ".npy";
    for (int d = 0; d < 3; ++d) volume["shape"][d] = 8 >> (level + 1);
  }
  write_text(a / "volumes.json", document.dump());
  REQUIRE(causes().size() == 1);
  CHECK(causes()[0].mistake.starts_with("mip levels one off: level k holds what level k + 1 should"));
}

TEST_CASE("NaN in a volume makes it different, and is located", "[diff]") {
  const TemporaryFolder folder;
  const fs::path b = write_volume(folder.path / "b.npy", varied);
  const fs::path a = write_volume(folder.path / "a.npy", [](const glm::ivec3& v) {
    glm::vec4 t = varied(v);
    if (v == glm::ivec3(5, 4, 3)) t.b = std::numeric_limits<float>::quiet_NaN();
    return t;
  });
  const VolumeDifference diff = diff_files(a, b);
  CHECK(diff.differs({.fraction = 1.0}));
  CHECK(diff.values.nonfinite_a == 1);
  REQUIRE(diff.values.first_nonfinite);
  CHECK(diff.values.first_nonfinite->at == glm::ivec3(5, 4, 3));
}

}  // namespace voxref
