#include "voxel/binary_file.h"

#include <cerrno>
#include <cstring>

#include "error.h"

namespace voxref {

BinaryFile::BinaryFile(const std::filesystem::path& path) : name_(path.string()) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw Error(name_, "there is no such file");
  stream_.open(path, std::ios::binary);
  size_ = std::filesystem::file_size(path, error);
  if (!stream_ || error) throw Error(name_, std::string("cannot be read: ") + std::strerror(errno));
}

void BinaryFile::read(uint64_t offset, std::span<std::byte> bytes) {
  if (offset > size_ || bytes.size() > size_ - offset) throw Error(name_, "ends too early");
  stream_.clear();
  stream_.seekg(std::streamoff(offset));
  if (!stream_.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
    throw Error(name_, std::string("cannot be read: ") + std::strerror(errno));
}

}  // namespace voxref
