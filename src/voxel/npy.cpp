#include "voxel/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>

#include "error.h"
#include "file.h"
#include "voxel/texel.h"

namespace voxref {

static_assert(std::endian::native == std::endian::little, "array files are read and written as they lie in memory");

namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr size_t alignment = 64;            // of the first value, as NumPy writes it
constexpr size_t longest_header = 1 << 16;  // of a plain array's header; beyond it the length itself is damaged
constexpr size_t most_dimensions = 8;

/// How a type is called in volumes.json, in a header's dictionary, and how large a value is.
struct TypeNames {
  NpyType type;
  std::string_view name, descr;
  size_t bytes;
};
constexpr std::array<TypeNames, 3> types = {{{NpyType::float32, "float32", "'<f4'", 4},
                                             {NpyType::float16, "float16", "'<f2'", 2},
                                             {NpyType::uint8, "uint8", "'|u1'", 1}}};
const TypeNames& names_of(NpyType type) { return types[size_t(type)]; }
size_t bytes_of(NpyType type) { return names_of(type).bytes; }

size_t product(std::span<const size_t> sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), size_t{1}, std::multiplies<>());
}

/// Values go to files and come back four at a time, as a texel's channels do; the last ones are padded with zero.
template <class Texel>
std::string encoded(std::span<const float> values) {
  constexpr size_t size = sizeof(Texel) / 4;
  std::string bytes(values.size() * size, '\0');
  for (size_t i = 0; i < values.size(); i += 4) {
    Float4 four{};
    const size_t count = std::min<size_t>(4, values.size() - i);
    std::memcpy(&four, &values[i], count * sizeof(float));
    const Texel texel = encode<Texel>(four);
    std::memcpy(&bytes[i * size], &texel, count * size);
  }
  return bytes;
}
template <class Texel>
void decode_all(std::string_view bytes, std::span<float> values) {
  constexpr size_t size = sizeof(Texel) / 4;
  for (size_t i = 0; i < values.size(); i += 4) {
    Texel texel{};
    const size_t count = std::min<size_t>(4, values.size() - i);
    std::memcpy(&texel, &bytes[i * size], count * size);
    const Float4 four = decode(texel);
    std::memcpy(&values[i], &four, count * sizeof(float));
  }
}
/// Calls visit(std::type_identity<Texel>{}) with the texel whose channels have the type.
template <class Visit>
decltype(auto) with_channels(NpyType type, Visit&& visit) {
  constexpr std::array<Storage, 3> storage = {Storage::float32, Storage::float16, Storage::unorm8};
  return with_texel(storage[size_t(type)], visit);
}

std::string header_of(NpyType type, std::span<const size_t> shape) {
  std::string dictionary = "{'descr': " + std::string(names_of(type).descr) + ", 'fortran_order': False, 'shape': (";
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
    if (digits.empty() || digits.size() > 9 || digits.find_first_not_of("0123456789") != digits.npos)
      throw Error(file, "header", "shape has a side '" + digits + "'");
    shape.push_back(std::stoul(digits));
  }
  if (shape.empty() || shape.size() > most_dimensions)
    throw Error(file, "header", "has " + std::to_string(shape.size()) + " dimensions");
  return shape;
}

/// "[2,0,5]" of the value at `offset` in slice `i`.
std::string place_of(std::span<const size_t> shape, size_t i, size_t offset) {
  std::string inner;
  for (size_t d = shape.size(); d-- > 1;) {
    inner = "," + std::to_string(offset % shape[d]) + inner;
    offset /= shape[d];
  }
  return "[" + std::to_string(i) + inner + "]";
}

}  // namespace

std::string_view dtype_name(NpyType type) { return names_of(type).name; }

std::optional<NpyType> dtype_called(std::string_view name) {
  for (const TypeNames& type : types)
    if (type.name == name) return type.type;
  return std::nullopt;
}

void write_npy(const std::filesystem::path& file, NpyType type, std::span<const size_t> shape,
               const std::function<void(size_t, std::span<float>)>& fill) {
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    const std::string header = header_of(type, shape);
    stream.write(header.data(), std::streamsize(header.size()));
    std::vector<float> slice(product(shape.subspan(1)));
    for (size_t i = 0; i < shape[0] && stream; ++i) {
      std::fill(slice.begin(), slice.end(), 0.0f);
      fill(i, slice);
      const std::string bytes =
          with_channels(type, [&]<class Texel>(std::type_identity<Texel>) { return encoded<Texel>(slice); });
      stream.write(bytes.data(), std::streamsize(bytes.size()));
    }
    stream.close();
    if (!stream) throw Error(file.string(), std::string("cannot be written: ") + std::strerror(errno));
  });
}

NpyReader::NpyReader(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file_, error)) throw Error(file_.string(), "there is no such file");
  stream_.open(file_, std::ios::binary);
  if (!stream_) throw Error(file_.string(), std::string("cannot be read: ") + std::strerror(errno));
  check_length(read_header());
}

size_t NpyReader::read_header() {
  const std::string name = file_.string();
  std::string prefix(magic.size() + 2, '\0');
  if (!stream_.read(prefix.data(), std::streamsize(prefix.size())) || !prefix.starts_with(magic))
    throw Error(name, "header", "is not that of a NumPy array");
  const int version = prefix[magic.size()];
  if (version < 1 || version > 3) throw Error(name, "header", "has version " + std::to_string(version));
  uint32_t length = 0;
  const size_t length_bytes = version == 1 ? 2 : 4;
  stream_.read(reinterpret_cast<char*>(&length), std::streamsize(length_bytes));
  if (!stream_ || length > longest_header) throw Error(name, "header", "is damaged: its length is wrong");
  std::string dictionary(length, '\0');
  if (!stream_.read(dictionary.data(), std::streamsize(length))) throw Error(name, "header", "ends too early");

  const std::string_view type = value_of(dictionary, "descr", name);
  const std::string descr(type.substr(0, type.find(',')));
  const auto known = std::ranges::find_if(
      types, [&](const TypeNames& t) { return t.descr == descr || (t.type == NpyType::uint8 && descr == "'<u1'"); });
  if (known == types.end())
    throw Error(name, "header", "type " + descr + " is not float32 ('<f4'), float16 ('<f2') or uint8 ('|u1')");
  type_ = known->type;
  if (!value_of(dictionary, "fortran_order", name).starts_with("False"))
    throw Error(name, "header", "is in Fortran order; save it in C order");
  shape_ = parse_shape(value_of(dictionary, "shape", name), name);
  return prefix.size() + length_bytes + length;
}

void NpyReader::check_length(size_t offset) {
  const size_t there = std::filesystem::file_size(file_);
  size_t wanted = bytes_of(type_);
  for (const size_t side : shape_) {
    if (side != 0 && wanted > std::numeric_limits<size_t>::max() / side)
      throw Error(file_.string(), "header", "asks for more values than can be counted");
    wanted *= side;
  }
  if (there < offset || there - offset != wanted)
    throw Error(file_.string(), "holds " + std::to_string(there - std::min(there, offset)) +
                                    " bytes of values instead of " + std::to_string(wanted) +
                                    (there - offset < wanted ? ": truncated" : ""));
  offset_ = offset;
  slice_size_ = product(std::span(shape_).subspan(1));
}

void NpyReader::read_slice(size_t i, std::span<float> slice) {
  const size_t bytes = slice_size_ * bytes_of(type_);
  stream_.seekg(std::streamoff(offset_ + i * bytes));
  std::string encoded(bytes, '\0');
  stream_.read(encoded.data(), std::streamsize(bytes));
  if (!stream_) throw Error(file_.string(), std::string("cannot be read: ") + std::strerror(errno));
  with_channels(type_, [&]<class Texel>(std::type_identity<Texel>) { decode_all<Texel>(encoded, slice); });
  const auto bad = std::find_if_not(slice.begin(), slice.end(), [](float v) { return std::isfinite(v); });
  if (bad != slice.end())
    throw Error(file_.string(), place_of(shape_, i, size_t(bad - slice.begin())), "is not finite");
}

}  // namespace voxref
