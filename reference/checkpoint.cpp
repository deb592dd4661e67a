#include "reference/checkpoint.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "error.h"
#include "file.h"
#include "reference/identity.h"

namespace voxref {

namespace {
// The number counts changes of the format.
constexpr std::array<char, 20> signature = {"voxref checkpoint 2"};
constexpr uintmax_t digest_size = 64;  // characters of the SHA-256 at the end

void require_undamaged(const std::filesystem::path& file) {
  const uintmax_t size = std::filesystem::file_size(file);
  std::string expected(digest_size, ' ');
  std::ifstream stream(file, std::ios::binary);
  if (size > digest_size && stream.seekg(static_cast<std::streamoff>(size - digest_size)) &&
      stream.read(expected.data(), static_cast<std::streamsize>(digest_size)) &&
      sha256_of_file(file, size - digest_size) == expected)
    return;
  throw Error(file.string(), "checkpoint", "is damaged; without --resume the render starts anew");
}

}  // namespace

void StateReader::bytes(char* to, size_t count) {
  if (!stream_.read(to, static_cast<std::streamsize>(count)))
    throw Error(file_.string(), "checkpoint", "is damaged: it ends early");
}

void write_checkpoint(const CheckpointOptions& options, const std::function<void(StateWriter&)>& write) {
  write_atomically(options.file, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    StateWriter writer(stream);
    writer.value(signature);
    writer.value(static_cast<uint64_t>(options.render.size()));
    writer.values(std::span<const char>(options.render));
    write(writer);
    const auto size = static_cast<uintmax_t>(stream.tellp());
    stream.flush();
    if (stream) stream << sha256_of_file(temporary, size);
    stream.close();
    if (!stream) throw Error(options.file.string(), "cannot be written: " + std::string(std::strerror(errno)));
  });
}

bool read_checkpoint(const CheckpointOptions& options, const std::function<void(StateReader&)>& read) {
  if (!std::filesystem::exists(options.file)) return false;
  std::ifstream stream(options.file, std::ios::binary);
  if (!stream) throw Error(options.file.string(), "cannot be read: " + std::string(std::strerror(errno)));
  StateReader reader(stream, options.file);
  std::array<char, signature.size()> begin{};
  reader.value(begin);
  if (begin != signature) throw Error(options.file.string(), "is no checkpoint of this version of voxref");
  require_undamaged(options.file);
  uint64_t size = 0;
  reader.value(size);
  std::string render(size, ' ');
  reader.values(std::span<char>(render));
  if (const std::optional<std::string> difference = difference_of(options.render, render))
    throw Error(options.file.string(), *difference + " here: it is a checkpoint of another render");
  read(reader);
  return true;
}

}  // namespace voxref
