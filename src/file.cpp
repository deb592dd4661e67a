#include "file.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <vector>

#include "error.h"

namespace voxref {

namespace fs = std::filesystem;

namespace {

/// Beside the target, so that renaming stays within one file system; the extension stays last, because writers choose
/// the format by it.
fs::path temporary_beside(const fs::path& file) {
  return file.parent_path() /
         ("." + file.stem().string() + "." + std::to_string(::getpid()) + file.extension().string());
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// SHA-256 of what is added piece by piece.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(std::span<const std::byte> content) {
    require(EVP_DigestUpdate(context_.get(), content.data(), content.size()) == 1);
  }
  /// Lower-case hexadecimal; nothing may be added afterwards.
  std::string finish() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &length) == 1);
    constexpr char digits[] = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < length; ++i) {
      text += digits[digest[i] >> 4];
      text += digits[digest[i] & 15];
    }
    return text;
  }

 private:
  static void require(bool done) {
    if (!done) throw Error("sha256", "the cryptographic library refused");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  require_writable(file);
  const fs::path temporary = temporary_beside(file);
  std::error_code error;
  try {
    write(temporary);
    fs::rename(temporary, file, error);
    if (error) throw Error(file.string(), "cannot be written: " + error.message());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

void write_atomically(const fs::path& file, std::span<const std::byte> content) {
  write_atomically(file, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) throw Error(file.string(), "cannot be written: " + std::string(std::strerror(errno)));
  });
}

void write_text(const fs::path& file, const std::string& text) {
  write_atomically(file, std::as_bytes(std::span(text.data(), text.size())));
}

void remove_leftovers(const fs::path& file) {
  const std::string begin = "." + file.stem().string() + ".", end = file.extension().string();
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(file), error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= begin.size() + end.size() || !name.starts_with(begin) || !name.ends_with(end)) continue;
    const char* number_end = name.data() + name.size() - end.size();
    pid_t process = 0;
    const auto [rest, status] = std::from_chars(name.data() + begin.size(), number_end, process);
    if (status != std::errc() || rest != number_end || process <= 0) continue;
    if (::kill(process, 0) != 0 && errno == ESRCH) leftovers.push_back(entry.path());
  }
  for (const fs::path& leftover : leftovers) fs::remove(leftover, error);
}

void require_writable(const fs::path& file) {
  std::error_code error;
  if (file.empty() || !file.has_filename()) throw Error(file.string(), "is not the name of a file");
  if (fs::is_directory(file, error)) throw Error(file.string(), "is a folder");
  if (!fs::is_directory(folder_of(file), error))
    throw Error(file.string(), "cannot be written: there is no folder " + folder_of(file).string());
  // The only reliable question is the attempt: permission bits say nothing about root or read-only file systems.
  const fs::path temporary = temporary_beside(file);
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) throw Error(file.string(), "cannot be written: " + std::string(std::strerror(errno)));
  ::close(descriptor);
  fs::remove(temporary, error);
}

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "voxref-XXXXXX").string();
  if (!::mkdtemp(name.data())) throw Error(name, std::string("cannot be made: ") + std::strerror(errno));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string read_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw Error(file.string(), "there is no such file");
  if (fs::is_directory(file, error)) throw Error(file.string(), "is a folder");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  if (!stream) {
    // An empty file sets failbit because nothing could be inserted; it is still a file that was read.
    if (fs::file_size(file, error) == 0 && !error) return {};
    throw Error(file.string(), "cannot be read: " + std::string(std::strerror(errno)));
  }
  return std::move(content).str();
}

std::string sha256(std::span<const std::byte> content) {
  Sha256 hash;
  hash.add(content);
  return hash.finish();
}

std::string sha256_of_file(const std::filesystem::path& file, uintmax_t size) {
  std::ifstream stream(file, std::ios::binary);
  Sha256 hash;
  std::vector<std::byte> piece(size_t{1} << 20);
  for (uintmax_t left = size; left > 0;) {
    const std::span<std::byte> part = std::span(piece).first(std::min<uintmax_t>(left, piece.size()));
    if (!stream.read(reinterpret_cast<char*>(part.data()), static_cast<std::streamsize>(part.size())))
      throw Error(file.string(), "cannot be read: " + std::string(std::strerror(errno)));
    hash.add(part);
    left -= part.size();
  }
  return hash.finish();
}

}  // namespace voxref
