#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace voxref {

/// How a file holds each value, little-endian; uint8 is unorm8, byte x (1/255).
enum class ElementType : uint8_t { float32, float16, uint8 };
/// As NumPy and volumes.json call it: "float32", "float16" or "uint8".
std::string_view dtype_name(ElementType type);
std::optional<ElementType> dtype_called(std::string_view name);  ///< none: there is no such type
size_t bytes_of(ElementType type);

/// The bytes of values in a file. As uint8 they are clamped to [0,1] and stored times 255, as float16 clamped to 65504;
/// both are rounded to the nearest, ties to even.
std::string encode_elements(ElementType type, std::span<const float> values);
/// Exact; NaN and infinity come as they are. @param bytes of values.size() elements
void decode_elements(ElementType type, const std::byte* bytes, std::span<float> values);

}  // namespace voxref
