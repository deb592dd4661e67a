#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace voxref {

/// NumPy's array files (NEP 1, format versions 1 to 3), little-endian, in C order: the last index is fastest. Arrays
/// are read and written in slices of the first index, so that a large one is never in memory as a whole.
enum class NpyType : uint8_t { float32, float16, uint8 };
/// "float32", "float16" or "uint8", as volumes.json and NumPy call them.
std::string_view dtype_name(NpyType type);
std::optional<NpyType> dtype_called(std::string_view name);  ///< none: there is no such type

/// Calls fill(i, slice) for each index of the first dimension in turn, `slice` zeroed and of the product of the other
/// dimensions. As uint8, values are clamped to [0,1] and stored times 255, as float16 clamped to 65504; both are
/// rounded to the nearest, ties to even. The file appears whole or not at all. @throws Error with the path when it
/// cannot be written
void write_npy(const std::filesystem::path& file, NpyType type, std::span<const size_t> shape,
               const std::function<void(size_t i, std::span<float> slice)>& fill);

class NpyReader {
 public:
  /// @throws Error with the path: no such file, not an array file, Fortran order, another type than these,
  /// or a length that is not what shape and type ask for
  explicit NpyReader(std::filesystem::path file);

  NpyType type() const { return type_; }
  const std::vector<size_t>& shape() const { return shape_; }
  size_t slice_size() const { return slice_size_; }  ///< values
  /// Values of slice `i` of the first dimension; bytes as byte x (1/255), in [0,1].
  /// @throws Error with the path and the index where a value is not finite
  void read_slice(size_t i, std::span<float> slice);

 private:
  size_t read_header();
  void check_length(size_t offset);

  std::filesystem::path file_;
  std::ifstream stream_;
  NpyType type_ = NpyType::float32;
  std::vector<size_t> shape_;
  size_t offset_ = 0;  ///< of the first value in the file, bytes
  size_t slice_size_ = 0;
};

}  // namespace voxref
