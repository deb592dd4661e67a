#include "voxel/npy.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <optional>
#include <string>

#include "error.h"
#include "file.h"
#include "printable.h"

namespace voxref {

namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr size_t alignment = 64;            // of the first value, as NumPy writes it
constexpr size_t longest_header = 1 << 16;  // of a plain array's header; beyond it the length itself is damaged
constexpr size_t least_sides = 2, most_sides = 4;
constexpr size_t most_image_channels = 4;  // of an array of three sides: see ArrayMeaning

size_t product(std::span<const size_t> sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), size_t{1}, std::multiplies<>());
}

/// As a header's dictionary has it.
std::string_view descr_of(ElementType type) {
  return type == ElementType::float32 ? "'<f4'" : type == ElementType::float16 ? "'<f2'" : "'|u1'";
}

std::string header_of(ElementType type, std::span<const size_t> shape) {
  std::string dictionary = "{'descr': " + std::string(descr_of(type)) + ", 'fortran_order': False, 'shape': (";
  for (const size_t side : shape) dictionary += std::to_string(side) + ",";
  dictionary += "), }";
  const size_t prefix = magic.size() + 2 + 2;  // version and length
  const size_t padded = (prefix + dictionary.size() + 1 + alignment - 1) / alignment * alignment - prefix;
  dictionary.resize(padded - 1, ' ');
  dictionary += '\n';
  std::string header(magic);
  header += {'\x01', '\x00', char(padded & 0xff), char(padded >> 8)};
  return header + dictionary;
}

/// What follows `'key':` in the header's dictionary. @throws Error
std::string_view value_of(std::string_view dictionary, std::string_view key, const std::string& file) {
  const std::string quoted = "'" + std::string(key) + "'";
  size_t at = dictionary.find(quoted);
  if (at != dictionary.npos) at = dictionary.find_first_not_of(" :", at + quoted.size());
  if (at == dictionary.npos) throw Error(file, "header", "has no '" + std::string(key) + "'");
  return dictionary.substr(at);
}

ElementType parse_type(std::string_view text, const std::string& file) {
  const std::string descr(text.substr(0, text.find(',')));
  for (const ElementType type : {ElementType::float32, ElementType::float16, ElementType::uint8})
    if (descr == descr_of(type)) return type;
  if (descr == "'<u1'") return ElementType::uint8;
  throw Error(file, "header",
              "type " + printable(descr) + " is none of float32 ('<f4'), float16 ('<f2') and uint8 ('|u1')");
}

std::vector<size_t> parse_shape(std::string_view text, const std::string& file) {
  const size_t close = text.find(')');
  if (text.empty() || text[0] != '(' || close == text.npos) throw Error(file, "header", "has no shape");
  std::vector<size_t> shape;
  for (size_t at = 1; at < close;) {
    const size_t end = std::min(text.find(',', at), close);
    std::string digits(text.substr(at, end - at));
    std::erase(digits, ' ');
    at = end + 1;
    if (digits.empty() && at > close) break;  // the comma after the last side
    const bool number = !digits.empty() && digits.size() <= 9 && digits.find_first_not_of("0123456789") == digits.npos;
    if (!number || std::stoul(digits) == 0) throw Error(file, "header", "shape has a side '" + printable(digits) + "'");
    shape.push_back(std::stoul(digits));
  }
  if (shape.size() < least_sides || shape.size() > most_sides)
    throw Error(file, "header", "has " + std::to_string(shape.size()) + " dimensions");
  return shape;
}

/// Z, Y, X, C of an array of two to four sides.
std::array<size_t, 4> volume_shape(std::span<const size_t> sides, ArrayMeaning meaning) {
  if (sides.size() == 4) return {sides[0], sides[1], sides[2], sides[3]};
  if (sides.size() == 2) return {1, sides[0], sides[1], 1};
  const bool volume = meaning == ArrayMeaning::volume || sides[2] > most_image_channels;
  return volume ? std::array{sides[0], sides[1], sides[2], size_t{1}}
                : std::array{size_t{1}, sides[0], sides[1], sides[2]};
}

}  // namespace

void write_npy(const std::filesystem::path& file, ElementType type, std::span<const size_t> shape,
               const std::function<void(size_t, std::span<float>)>& fill) {
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    const std::string header = header_of(type, shape);
    stream.write(header.data(), std::streamsize(header.size()));
    std::vector<float> slice(product(shape.subspan(1)));
    for (size_t i = 0; i < shape[0] && stream; ++i) {
      std::fill(slice.begin(), slice.end(), 0.0f);
      fill(i, slice);
      const std::string bytes = encode_elements(type, slice);
      stream.write(bytes.data(), std::streamsize(bytes.size()));
    }
    stream.close();
    if (!stream) throw Error(file.string(), std::string("cannot be written: ") + std::strerror(errno));
  });
}

ArrayLayout npy_layout(BinaryFile& file, ArrayMeaning meaning) {
  const std::string& name = file.name();
  std::array<char, magic.size() + 2> prefix{};
  if (file.size() >= prefix.size()) file.read(0, std::as_writable_bytes(std::span(prefix)));
  if (!std::string_view(prefix.data(), prefix.size()).starts_with(magic))
    throw Error(name, "header", "is not that of a NumPy array");
  const auto version = static_cast<unsigned char>(prefix[magic.size()]);
  if (version < 1 || version > 3) throw Error(name, "header", "has version " + std::to_string(version));
  uint32_t length = 0;
  const size_t length_bytes = version == 1 ? 2 : 4;
  file.read(prefix.size(), std::as_writable_bytes(std::span(&length, 1)).first(length_bytes));
  if (length > longest_header) throw Error(name, "header", "is damaged: its length is wrong");
  std::string dictionary(length, '\0');
  file.read(prefix.size() + length_bytes, std::as_writable_bytes(std::span(dictionary)));

  const ElementType type = parse_type(value_of(dictionary, "descr", name), name);
  if (!value_of(dictionary, "fortran_order", name).starts_with("False"))
    throw Error(name, "header", "is in Fortran order; save it in C order");
  const std::vector<size_t> sides = parse_shape(value_of(dictionary, "shape", name), name);
  const std::array<size_t, 4> shape = volume_shape(sides, meaning);
  const std::optional<uint64_t> wanted = packed_bytes(type, shape);
  if (!wanted) throw Error(name, "header", "asks for more values than can be counted");
  const uint64_t offset = prefix.size() + length_bytes + length, there = file.size() - offset;
  if (there != *wanted)
    throw Error(name, "holds " + std::to_string(there) + " bytes of values instead of " + std::to_string(*wanted) +
                          (there < *wanted ? ": truncated" : ""));
  return packed_layout(type, shape, offset);
}

}  // namespace voxref
