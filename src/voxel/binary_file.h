#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace voxref {

/// A file that is read in pieces, so that a large one is never in memory as a whole.
class BinaryFile {
 public:
  /// @throws Error with the path when there is no such file or it cannot be read
  explicit BinaryFile(const std::filesystem::path& path);
  const std::string& name() const { return name_; }  ///< the path, for messages
  uint64_t size() const { return size_; }            ///< bytes
  /// @throws Error with the path when the piece reaches beyond the end, or cannot be read
  void read(uint64_t offset, std::span<std::byte> bytes);

 private:
  std::string name_;
  std::ifstream stream_;
  uint64_t size_ = 0;
};

}  // namespace voxref
