#pragma once
#include <filesystem>
#include <fstream>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <type_traits>

namespace voxref {

/// Where a render keeps what it needs to go on after it was killed.
struct CheckpointOptions {
  std::filesystem::path file;  ///< empty: none
  double interval = 60.0;      ///< seconds between two; also what is lost at most
  bool resume = false;         ///< go on from `file` where there is one
  std::string render;          ///< what the result depends on, as one JSON object; a checkpoint of another is refused
};

// A checkpoint is the sums of a render and the pass under way, as they lie in memory: a resumed render continues with
// the very bits. It is read again on the machine, or a like one, that wrote it.

/// Values as they lie in memory.
class StateWriter {
 public:
  explicit StateWriter(std::ostream& stream) : stream_(stream) {}
  template <class T>
  void value(const T& value) {
    values(std::span<const T>(&value, 1));
  }
  template <class T>
  void values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    stream_.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
  }

 private:
  std::ostream& stream_;
};

/// Reads what StateWriter wrote, in the same order. @throws Error with the path where the file ends early
class StateReader {
 public:
  StateReader(std::istream& stream, const std::filesystem::path& file) : stream_(stream), file_(file) {}
  template <class T>
  void value(T& value) {
    values(std::span<T>(&value, 1));
  }
  template <class T>
  void values(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(reinterpret_cast<char*>(values.data()), values.size_bytes());
  }

 private:
  void bytes(char* to, size_t count);
  std::istream& stream_;
  const std::filesystem::path& file_;
};

/// Writes a checkpoint; the file appears whole or not at all. @param write takes the state
void write_checkpoint(const CheckpointOptions& options, const std::function<void(StateWriter&)>& write);

/// Reads one into `read`. @returns false when there is no file
/// @throws Error with the path: not a checkpoint, damaged (its last bytes are the SHA-256 of the others), or of another
/// render, naming what differs
bool read_checkpoint(const CheckpointOptions& options, const std::function<void(StateReader&)>& read);

}  // namespace voxref
