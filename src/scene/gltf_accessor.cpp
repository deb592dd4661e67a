#include "scene/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <string_view>

#include "error.h"

namespace voxref {
namespace {

/// A document of a few bytes must not ask for gigabytes: an accessor without bytes of its own stays below this.
constexpr size_t most_zero_elements = size_t{1} << 26;

size_t byte_size(Component component) {
  switch (component) {
    case Component::int8:
    case Component::uint8:
      return 1;
    case Component::int16:
    case Component::uint16:
      return 2;
    case Component::uint32:
    case Component::float32:
      return 4;
  }
  return 0;
}

Component read_component(const GltfValue& value) {
  const uint64_t code = value.integer();
  if (code < 5120 || code > 5126 || code == 5124) value.fail(fmt::format("unknown component type {}", code));
  return static_cast<Component>(code);
}

int read_type(const GltfValue& value) {
  static const std::map<std::string, int> types = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                   {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  const auto type = types.find(value.text());
  if (type == types.end()) value.fail(fmt::format("unknown type {}", value.quoted()));
  return type->second;
}

/// Bytes of one element. Columns of a matrix start at multiples of four bytes (glTF 2.0, 3.6.2.4).
size_t element_size(const GltfAccessor& accessor) {
  const size_t number = byte_size(accessor.component);
  if (!accessor.matrix) return number * accessor.components;
  const size_t rows = accessor.components == 4 ? 2 : accessor.components == 9 ? 3 : 4;
  return rows * ((rows * number + 3) / 4 * 4);
}

/// Checks that `count` elements lie inside the view and that numbers lie at multiples of their size.
GltfAccessor::Range read_range(const GltfDocument& document, const GltfValue& value, size_t count, size_t size,
                               size_t stride, size_t alignment) {
  GltfAccessor::Range range;
  range.view = static_cast<int>(value.at("bufferView").index(document.views.size(), "bufferViews"));
  range.offset = value.integer("byteOffset", 0);
  const GltfBufferView& view = document.views[range.view];
  const size_t end = count == 0 ? 0 : range.offset + (count - 1) * stride + size;  // count < 2^32: no overflow
  if (end > view.length)
    value.fail(fmt::format("needs {} bytes of bufferViews[{}], which has {}", end, range.view, view.length));
  if ((view.offset + range.offset) % alignment != 0 || stride % alignment != 0)
    value.fail(fmt::format("its numbers do not lie at multiples of their {} bytes", alignment));
  return range;
}

GltfAccessor::Sparse read_sparse(const GltfDocument& document, const GltfValue& value, const GltfAccessor& accessor) {
  GltfAccessor::Sparse sparse;
  sparse.count = value.at("count").integer(1, accessor.count);
  const GltfValue indices = value.at("indices");
  sparse.index_component = read_component(indices.at("componentType"));
  if (sparse.index_component != Component::uint8 && sparse.index_component != Component::uint16 &&
      sparse.index_component != Component::uint32)
    indices.at("componentType").fail("indices must be unsigned integers");
  const size_t index_size = byte_size(sparse.index_component), size = element_size(accessor);
  sparse.indices = read_range(document, indices, sparse.count, index_size, index_size, index_size);
  sparse.values = read_range(document, value.at("values"), sparse.count, size, size, byte_size(accessor.component));
  return sparse;
}

GltfAccessor read_accessor(const GltfDocument& document, const GltfValue& value) {
  GltfAccessor accessor;
  accessor.place = value.place();
  accessor.component = read_component(value.at("componentType"));
  accessor.components = read_type(value.at("type"));
  accessor.matrix = value.at("type").text().starts_with("MAT");
  accessor.count = value.at("count").integer(1);
  accessor.normalized = value.boolean("normalized", false);
  if (accessor.normalized && (accessor.component == Component::float32 || accessor.component == Component::uint32))
    value.at("normalized").fail("only integers of 8 and 16 bits can be normalized");
  const size_t size = element_size(accessor);
  accessor.stride = size;
  if (const auto view = value.index("bufferView", document.views.size(), "bufferViews")) {
    if (document.views[*view].stride != 0) accessor.stride = document.views[*view].stride;
    if (accessor.stride < size)
      value.fail(fmt::format("elements of {} bytes overlap at the view's byteStride of {}", size, accessor.stride));
    accessor.range = read_range(document, value, accessor.count, size, accessor.stride, byte_size(accessor.component));
  } else if (accessor.count > most_zero_elements) {
    value.at("count").fail(fmt::format("{} elements without a bufferView", accessor.count));
  }
  if (const auto sparse = value.find("sparse")) accessor.sparse = read_sparse(document, *sparse, accessor);
  return accessor;
}

const unsigned char* bytes_of(const GltfDocument& document, const GltfAccessor::Range& range) {
  const GltfBufferView& view = document.views[range.view];
  return document.buffers[view.buffer].data() + view.offset + range.offset;
}

template <typename T>
T number_at(const unsigned char* bytes) {
  T number;
  std::memcpy(&number, bytes, sizeof(T));
  return number;
}

uint32_t unsigned_at(const unsigned char* bytes, Component component) {
  if (component == Component::uint8) return *bytes;
  if (component == Component::uint16) return number_at<uint16_t>(bytes);
  return number_at<uint32_t>(bytes);
}

/// The elements side by side, sparse ones replaced.
std::vector<unsigned char> gather(const GltfDocument& document, const GltfAccessor& accessor) {
  const size_t size = element_size(accessor);
  std::vector<unsigned char> packed(accessor.count * size);
  if (accessor.range.view >= 0) {
    const unsigned char* bytes = bytes_of(document, accessor.range);
    for (size_t i = 0; i < accessor.count; ++i) std::memcpy(&packed[i * size], bytes + i * accessor.stride, size);
  }
  if (accessor.sparse.count == 0) return packed;
  const unsigned char* indices = bytes_of(document, accessor.sparse.indices);
  const unsigned char* values = bytes_of(document, accessor.sparse.values);
  int64_t previous = -1;
  for (size_t i = 0; i < accessor.sparse.count; ++i) {
    const uint32_t index =
        unsigned_at(indices + i * byte_size(accessor.sparse.index_component), accessor.sparse.index_component);
    if (index >= accessor.count || index <= previous)
      throw Error(
          document.file, accessor.place + ".sparse.indices",
          fmt::format("index {} after {}: they must increase and stay below {}", index, previous, accessor.count));
    std::memcpy(&packed[index * size], values + i * size, size);
    previous = index;
  }
  return packed;
}

template <typename T>
void convert(std::span<const unsigned char> packed, bool normalized, std::vector<float>& out) {
  // glTF 2.0, 3.11: c / 255, max(c / 127, -1) and alike for 16 bits.
  const float divisor = normalized ? static_cast<float>(std::numeric_limits<T>::max()) : 1.0f;
  const float low = normalized ? -1.0f : -std::numeric_limits<float>::max();
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = std::max(static_cast<float>(number_at<T>(&packed[i * sizeof(T)])) / divisor, low);
}

}  // namespace

std::vector<GltfAccessor> read_accessors(const GltfDocument& document) {
  std::vector<GltfAccessor> accessors;
  for (const GltfValue& value : document.list("accessors")) accessors.push_back(read_accessor(document, value));
  return accessors;
}

std::vector<float> read_floats(const GltfDocument& document, const GltfAccessor& accessor) {
  assert(!accessor.matrix);
  const std::vector<unsigned char> packed = gather(document, accessor);
  std::vector<float> numbers(accessor.count * accessor.components);
  switch (accessor.component) {
    case Component::int8:
      convert<int8_t>(packed, accessor.normalized, numbers);
      break;
    case Component::uint8:
      convert<uint8_t>(packed, accessor.normalized, numbers);
      break;
    case Component::int16:
      convert<int16_t>(packed, accessor.normalized, numbers);
      break;
    case Component::uint16:
      convert<uint16_t>(packed, accessor.normalized, numbers);
      break;
    case Component::uint32:
      convert<uint32_t>(packed, false, numbers);
      break;
    case Component::float32:
      std::memcpy(numbers.data(), packed.data(), packed.size());
      break;
  }
  for (size_t i = 0; i < numbers.size(); ++i)
    if (!std::isfinite(numbers[i]))
      throw Error(document.file, accessor.place, fmt::format("element {} is not finite", i / accessor.components));
  return numbers;
}

std::vector<uint32_t> read_unsigned(const GltfDocument& document, const GltfAccessor& accessor) {
  const std::vector<unsigned char> packed = gather(document, accessor);
  const size_t size = byte_size(accessor.component);
  std::vector<uint32_t> numbers(accessor.count);
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = unsigned_at(&packed[i * size], accessor.component);
  return numbers;
}

}  // namespace voxref
