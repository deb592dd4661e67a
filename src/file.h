#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace voxref {

/// Lets `write` fill a file beside `file`, then renames it there: `file` appears whole or not at all, and what was
/// there stays when `write` throws. @throws Error with the path when it cannot be created or renamed
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path& temporary)>& write);
void write_atomically(const std::filesystem::path& file, std::span<const std::byte> content);
void write_text(const std::filesystem::path& file, const std::string& text);

/// Removes what killed processes of this machine left of their attempts to write `file`.
void remove_leftovers(const std::filesystem::path& file);

/// Checks, before work begins, that `file` could be written: its folder exists and takes files, and it is no folder
/// itself. Leaves nothing behind. @throws Error with the path
void require_writable(const std::filesystem::path& file);

/// A fresh folder for files that nobody needs later; goes away with its object.
class ScratchFolder {
 public:
  /// @throws Error when the system's folder for temporary files takes none
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// @throws Error with the path when it is missing or cannot be read
std::string read_file(const std::filesystem::path& file);

/// Lower-case hexadecimal SHA-256 (FIPS 180-4) of `content`; of a scene, `Scene::sha256` covers all its files.
std::string sha256(std::span<const std::byte> content);

/// The same of a file's first `size` bytes, read piece by piece. @throws Error with the path when there are fewer
std::string sha256_of_file(const std::filesystem::path& file, uintmax_t size);

}  // namespace voxref
