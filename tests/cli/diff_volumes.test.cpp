// `voxref diff` on volumes: what it says and what it leaves behind, as a script would run it.
#include <cstring>

#include "cli/workplace.h"
#include "compare/picture.h"
#include "compare/volume_folder.h"
#include "voxel/npy.h"

namespace {

const std::string published = " --profile villegas2016 --set grid.resolution=16";

/// Volumes of the Cornell box in folder `a`.
void write_volumes(const Workplace& place) {
  const Outcome made = place.run("cone point.glb --size 4x4 -o c.exr --volumes a --quiet" + published);
  INFO(made.err);
  REQUIRE(made.status == 0);
}

json run_to_json(const Workplace& place, const std::string& arguments, int status) {
  const Outcome outcome = place.run(arguments + " --json");
  INFO(arguments << "\n" << outcome.out << outcome.err);
  CHECK(outcome.status == status);
  return json::parse(outcome.out);
}

std::string page(const Workplace& place, const std::string& folder) {
  return voxref::read_file(place.path(folder) / "report.html");
}

/// Changes the folder's volumes.json.
template <class Change>
void edit_index(const fs::path& folder, Change&& change) {
  json index = json::parse(voxref::read_file(folder / "volumes.json"));
  change(index);
  voxref::write_text(folder / "volumes.json", index.dump());
}

/// A volume of 2x2x2 texels of one byte, and its further level of one, as RenderDoc saves it.
std::string mipped_dds(char base, char level, uint32_t levels) {
  std::array<uint32_t, 37> header{};
  header = {0x20534444, 124, 0x80100f, 2, 2, 0, 2, levels};
  header[19] = 32, header[20] = 4, header[21] = 0x30315844;
  header[27] = 0x1000, header[28] = 0x200000;
  header[32] = 61, header[33] = 4, header[35] = 1;  // R8_UNORM, a volume, one of them
  std::string bytes(reinterpret_cast<const char*>(header.data()), sizeof header);
  return bytes + std::string(8, base) + (levels > 1 ? std::string(1, level) : "");
}

}  // namespace

TEST_CASE("A recomputation without a reference reports what it found, with slices of both", "[cli][diff]") {
  const Workplace place;
  write_volumes(place);
  voxref::testing::tamper(place.path("a"), "radiance", 40);
  const json result = run_to_json(place, "diff a/ -o out --recompute point.glb" + published, 1);
  CHECK(result["verdict"] == "different");
  CHECK(result["first_divergence"]["volume"] == "radiance");
  const json written = json::parse(voxref::read_file(place.path("out") / "result.json"));
  CHECK(written == result);
  CHECK(fs::exists(place.path("out") / "radiance.png"));
  CHECK(contains(page(place, "out"), "a against voxref"));
  CHECK(contains(page(place, "out"), "verdict bad\">different"));
  CHECK(contains(page(place, "out"), "On its own input A first differs in radiance"));
}

TEST_CASE("With a reference and a recomputation the verdict is that of both", "[cli][diff]") {
  const Workplace place;
  write_volumes(place);
  voxref::testing::tamper(place.path("a"), "radiance", 40);
  fs::copy(place.path("a"), place.path("b"));
  // Both made the same mistake: equal, and wrong.
  const json both = run_to_json(place, "diff a b -o out --recompute point.glb" + published, 1);
  CHECK(both["verdict"] == "different");
  CHECK(both["first_divergence"]["volume"] == "radiance");
  CHECK(both["max_abs"] == 0.0);
  CHECK(both["recomputed"]["verdict"] == "different");
  CHECK(fs::exists(place.path("out") / "radiance.recomputed.png"));
}

TEST_CASE("A NaN keeps a folder from being recomputed, which is said with its place", "[cli][diff]") {
  const Workplace place;
  REQUIRE(place.run("cone point.glb --size 4x4 -o c.exr --volumes a --quiet --set grid.resolution=16").status == 0);
  std::string bytes = voxref::read_file(place.path("a") / "radiance.npy");
  const float nan_value = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + bytes.size() - sizeof nan_value, &nan_value, sizeof nan_value);
  voxref::write_text(place.path("a") / "radiance.npy", bytes);
  const json result = run_to_json(place, "diff a --recompute point.glb -o out", 1);
  CHECK(result["verdict"] == "different");
  CHECK(result["nonfinite_a"] == 1);
  CHECK(result["nonfinite_b"] == 0);
  CHECK(contains(result["not_recomputed"], "radiance: 1 values are NaN"));
  CHECK(contains(result["first_divergence"]["problem"], "NaN"));
  CHECK(contains(page(place, "out"), "Not recomputed"));
  CHECK(contains(place.run("diff a --recompute point.glb").out, "not recomputed"));
}

TEST_CASE("Two single volumes leave pictures and a page, and have the keys of folders", "[cli][diff]") {
  const Workplace place;
  write_volumes(place);
  fs::copy(place.path("a"), place.path("b"));
  voxref::testing::tamper(place.path("a"), "radiance", 40);
  const json result = run_to_json(place, "diff a/radiance.npy b/radiance.npy -o out", 1);
  CHECK(result["per_volume"].size() == 1);
  CHECK(result["psnr"].get<double>() > 0.0);
  CHECK(result["first_divergence"]["a"] != result["first_divergence"]["b"]);
  for (const char* file : {"radiance.png", "result.json", "report.html"}) CHECK(fs::exists(place.path("out") / file));
  CHECK(contains(page(place, "out"), "radiance.npy against radiance.npy"));
  CHECK(run_to_json(place, "diff b/radiance.npy b/radiance.npy", 0)["psnr"].is_null());
}

TEST_CASE("Every mip level of a DDS counts, and files with unequal numbers of them are refused", "[cli][diff]") {
  const Workplace place;
  voxref::write_text(place.path("a.dds"), mipped_dds(100, 100, 2));
  voxref::write_text(place.path("b.dds"), mipped_dds(100, 101, 2));
  voxref::write_text(place.path("c.dds"), mipped_dds(100, 0, 1));
  const json result = run_to_json(place, "diff a.dds b.dds", 1);
  CHECK(result["first_divergence"]["level"] == 1);
  CHECK(result["per_volume"].size() == 2);
  CHECK(run_to_json(place, "diff a.dds b.dds --mip 0", 0)["verdict"] == "same");
  CHECK(run_to_json(place, "diff a.dds c.dds --mip 0", 0)["verdict"] == "same");
  check_refused(place, "diff a.dds c.dds", "mip levels");
}

TEST_CASE("Stages follow from the volumes' names, and folders with nothing in common are refused", "[cli][diff]") {
  const Workplace place;
  write_volumes(place);
  voxref::testing::tamper(place.path("a"), "aniso_pos_x_0", 40);
  edit_index(place.path("a"), [](json& index) {
    for (json& volume : index["volumes"]) {
      for (const char* key : {"stage", "face", "level"}) volume.erase(key);
      if (volume["name"] == "radiance") volume["stage"] = "lighting";
    }
  });
  const json result = run_to_json(place, "diff a --recompute point.glb" + published, 1);
  CHECK(result["first_divergence"]["volume"] == "aniso_pos_x_0");
  CHECK(result["first_divergence"]["stage"] == "mipmap");
  CHECK(result["first_divergence"]["face"] == "pos_x");
  CHECK(result["first_divergence"]["level"] == 0);

  fs::copy(place.path("a"), place.path("b"));
  edit_index(place.path("b"), [](json& index) {
    for (json& volume : index["volumes"]) {
      const std::string name = volume["name"];
      volume["file"] = name + ".npy";
      volume["name"] = "my_" + name;
    }
  });
  check_refused(place, "diff a b", "none that could be compared");
  check_refused(place, "diff b --recompute point.glb" + published, "none that could be compared");
}

TEST_CASE("An array of three sides is a volume where that is said", "[cli][diff]") {
  const Workplace place;
  for (const char* name : {"a.npy", "b.npy"})
    voxref::write_npy(place.path(name), voxref::ElementType::float32, std::array<size_t, 3>{5, 4, 3},
                      [&](size_t z, std::span<float> slice) { slice[1] = z == 2 && *name == 'a' ? 1.0f : 0.5f; });
  CHECK(!run_to_json(place, "diff a.npy b.npy", 1).contains("per_volume"));
  const json result = run_to_json(place, "diff a.npy b.npy --volume", 1);
  CHECK(result["first_divergence"]["voxel"] == json({1, 0, 2}));
}

TEST_CASE("What would not be looked at, or would be overwritten, is refused", "[cli][diff]") {
  const Workplace place;
  write_volumes(place);
  voxref::write_png(place.path("a.png"), {2, 2, std::vector<uint8_t>(12, 100)});
  fs::copy(place.path("a.png"), place.path("b.png"));
  for (const char* flag : {"--max-flip 0.1", "--max-hdr-flip 0.1", "--min-ssim 0.9"})
    check_refused(place, std::string("diff a.png b.png --fast ") + flag, "--fast: leaves out");
  check_refused(place, "diff a a --max-rmse 1", "are for images");
  check_refused(place, "diff a.png b.png -o .", "what is compared");
}
