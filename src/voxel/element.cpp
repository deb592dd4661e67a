#include "voxel/element.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "voxel/texel.h"

namespace voxref {

static_assert(std::endian::native == std::endian::little, "files are read and written as they lie in memory");

namespace {

struct TypeFacts {
  std::string_view name;
  size_t bytes;
  Storage storage;  ///< whose texels have channels of this type
};
/// In ElementType's order.
constexpr std::array<TypeFacts, 3> types = {
    {{"float32", 4, Storage::float32}, {"float16", 2, Storage::float16}, {"uint8", 1, Storage::unorm8}}};

/// Values are converted four at a time, as a texel's channels are; the last ones are padded with zero.
template <class Texel>
std::string encode_all(std::span<const float> values) {
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
void decode_all(const std::byte* bytes, std::span<float> values) {
  constexpr size_t size = sizeof(Texel) / 4;
  for (size_t i = 0; i < values.size(); i += 4) {
    Texel texel{};
    const size_t count = std::min<size_t>(4, values.size() - i);
    std::memcpy(&texel, bytes + i * size, count * size);
    const Float4 four = decode(texel);
    std::memcpy(&values[i], &four, count * sizeof(float));
  }
}

}  // namespace

std::string_view dtype_name(ElementType type) { return types[size_t(type)].name; }

std::optional<ElementType> dtype_called(std::string_view name) {
  const auto found = std::ranges::find(types, name, &TypeFacts::name);
  if (found == types.end()) return std::nullopt;
  return ElementType(found - types.begin());
}

size_t bytes_of(ElementType type) { return types[size_t(type)].bytes; }

std::string encode_elements(ElementType type, std::span<const float> values) {
  return with_texel(types[size_t(type)].storage,
                    [&]<class Texel>(std::type_identity<Texel>) { return encode_all<Texel>(values); });
}

void decode_elements(ElementType type, const std::byte* bytes, std::span<float> values) {
  with_texel(types[size_t(type)].storage,
             [&]<class Texel>(std::type_identity<Texel>) { decode_all<Texel>(bytes, values); });
}

}  // namespace voxref
