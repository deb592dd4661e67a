#include "fuzz/targets.h"

#include <filesystem>
#include <vector>

#include "error.h"
#include "image/linear_image.h"
#include "json_members.h"
#include "scene/gltf.h"
#include "settings.h"
#include "temporary_folder.h"
#include "voxel/array_file.h"
#include "voxel/volume_index.h"

using namespace voxref;

namespace {

/// Where all inputs of the process lie, each in the place of the one before.
const std::filesystem::path& input_folder() {
  static const TemporaryFolder folder;
  return folder.path;
}

std::filesystem::path write_input(const std::string& name, std::string_view content) {
  const std::filesystem::path file = input_folder() / name;
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

template <class Read>
std::string must_read_or_refuse(const std::string& file, Read&& read) {
  try {
    read();
    return "";
  } catch (const Error& error) {
    const std::string what = error.what();
    if (!what.starts_with(file)) return "does not begin with the file: " + what;
    return what.find('\n') == what.npos ? "" : "is not one line: " + what;
  }
}

void read_all(const std::filesystem::path& file, int mip, ArrayMeaning meaning) {
  ArrayFile array(file, mip, meaning);
  std::vector<float> slice(array.slice_size());
  for (size_t z = 0; z < array.shape()[0]; ++z) array.read_slice(z, slice);
}

}  // namespace

std::string fuzz_npy(std::string_view input) {
  const std::filesystem::path file = write_input("a.npy", input);
  return must_read_or_refuse(file, [&] { read_all(file, 0, ArrayMeaning::by_shape); }) +
         must_read_or_refuse(file, [&] { read_all(file, 0, ArrayMeaning::volume); });
}

std::string fuzz_dds(std::string_view input) {
  const std::filesystem::path file = write_input("a.dds", input);
  return must_read_or_refuse(file, [&] {
    const int levels = ArrayFile(file).mip_count();
    for (int mip = 0; mip < levels; ++mip) read_all(file, mip, ArrayMeaning::by_shape);
  });
}

std::string fuzz_raw(std::string_view input) {
  const std::filesystem::path file = write_input("a.raw", std::string(96, '\x40'));
  write_input("a.raw.json", input);
  return must_read_or_refuse(file, [&] { read_all(file, 0, ArrayMeaning::by_shape); });
}

std::string fuzz_volumes(std::string_view input) {
  const std::filesystem::path file = write_input("volumes.json", input);
  return must_read_or_refuse(file, [&] {
    const VolumeIndex index = read_volume_index(input_folder());
    for (const VolumeEntry& entry : index.volumes) index.find(entry.name);
  });
}

std::string fuzz_settings(std::string_view input) {
  const std::filesystem::path file = write_input("settings.json", input);
  // The program puts the file before the parameter's name.
  return must_read_or_refuse("", [&] {
    Settings settings;
    apply_json(settings, read_json(file));
    validate(settings);
  });
}

std::string fuzz_gltf(std::string_view input) {
  const std::filesystem::path file = write_input("a.gltf", input);
  return must_read_or_refuse(file, [&] {
    for (const std::optional<double> time : {std::optional<double>(), std::optional<double>(0.5)})
      validate(load_gltf(file, {time, {}, 1.0f}));
  });
}

std::string fuzz_image(std::string_view input) {
  const char* ending = input.starts_with("\x89PNG")                          ? ".png"
                       : input.starts_with("II*") || input.starts_with("MM") ? ".tif"
                       : input.starts_with("#?")                             ? ".hdr"
                                                                             : ".exr";
  const std::filesystem::path file = write_input(std::string("a") + ending, input);
  return must_read_or_refuse(file, [&] { read_linear_image(file); });
}
