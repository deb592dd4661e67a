#include "scene/gltf_document.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <array>
#include <cstring>
#include <string_view>

#include "error.h"
#include "file.h"
#include "parallel.h"

namespace voxref {
namespace {

constexpr std::array understood = {"KHR_lights_punctual",    "KHR_materials_emissive_strength",
                                   "KHR_materials_specular", "KHR_materials_pbrSpecularGlossiness",
                                   "KHR_texture_transform",  "KHR_mesh_quantization"};

constexpr std::string_view glb_magic = "glTF";
constexpr uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;  // glTF 2.0, 4.4.3: "JSON" and "BIN\0"

uint32_t word(std::string_view bytes, size_t offset) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

/// The JSON chunk of a GLB file whose chunks are checked to lie inside it (glTF 2.0, 4.4).
std::string_view glb_json(std::string_view bytes, const std::string& file) {
  const auto refuse = [&](const std::string& what) { throw Error(file, "GLB header", what); };
  if (bytes.size() < 20) refuse(fmt::format("the file ends after {} bytes", bytes.size()));
  if (word(bytes, 4) != 2) refuse(fmt::format("version {}, only 2 is supported", word(bytes, 4)));
  const size_t length = word(bytes, 8), json_length = word(bytes, 12);
  if (length > bytes.size()) refuse(fmt::format("truncated: {} of {} bytes are there", bytes.size(), length));
  if (word(bytes, 16) != json_chunk) refuse("the first chunk is not JSON");
  if (20 + json_length > length) refuse("the JSON chunk reaches beyond the file");
  const size_t next = 20 + json_length;
  if (next + 8 <= length && word(bytes, next + 4) == binary_chunk && next + 8 + word(bytes, next) > length)
    refuse("the BIN chunk reaches beyond the file");
  return bytes.substr(20, json_length);
}

nlohmann::json parse(std::string_view text, const std::string& file) {
  // tinygltf walks through "extras" recursively; no sensible document nests this deep, and the stack bears it.
  constexpr int deepest = 256;
  const auto guard = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    if (depth > deepest) throw Error(file, "JSON", fmt::format("nested deeper than {} levels", deepest));
    return true;
  };
  try {
    return nlohmann::json::parse(text, guard);
  } catch (const nlohmann::json::exception& error) {
    const std::string_view what = error.what();  // "[json.exception...] parse error at line 1, column 1: ..."
    throw Error(file, "JSON", std::string(what.substr(std::min(what.size(), what.find("] ") + 2))));
  }
}

void check_extensions(GltfDocument& document) {
  const auto known = [](const std::string& name) {
    return std::find(understood.begin(), understood.end(), name) != understood.end();
  };
  for (const GltfValue& name : document.list("extensionsRequired"))
    if (!known(name.text())) name.fail(fmt::format("requires {}, which is not supported", name.quoted()));
  for (const GltfValue& name : document.list("extensionsUsed"))
    if (!known(name.text())) warn_once(document.warnings, fmt::format("extension {} is ignored", name.quoted()));
}

void check_buffers(GltfDocument& document, bool is_glb) {
  size_t i = 0;
  std::vector<size_t> lengths;
  for (const GltfValue& buffer : document.list("buffers")) {
    lengths.push_back(buffer.at("byteLength").integer(1));
    const std::optional<GltfValue> uri = buffer.find("uri");
    if (uri && uri->text().empty()) uri->fail("empty");
    // Only the first buffer of a GLB file may be its BIN chunk.
    if (!uri && !(is_glb && i == 0)) buffer.at("uri");
    ++i;
  }
  for (const GltfValue& value : document.list("bufferViews")) {
    GltfBufferView view;
    view.buffer = value.at("buffer").index(lengths.size(), "buffers");
    view.offset = value.integer("byteOffset", 0);
    view.length = value.at("byteLength").integer(1);
    if (const std::optional<GltfValue> stride = value.find("byteStride")) {
      view.stride = stride->integer(4, 252);
      if (view.stride % 4 != 0) stride->fail("must be a multiple of 4");
    }
    if (view.offset + view.length > lengths[view.buffer])
      value.fail(fmt::format("bytes {} to {} of buffers[{}], which has {}", view.offset, view.offset + view.length,
                             view.buffer, lengths[view.buffer]));
    document.views.push_back(view);
  }
  for (const GltfValue& image : document.list("images")) {
    const bool has_view = image.index("bufferView", document.views.size(), "bufferViews").has_value();
    if (has_view == image.find("uri").has_value()) image.fail("needs either uri or bufferView");
    if (!has_view) image.at("uri").text();
  }
}

// ---- tinygltf's callbacks. It looks for external files beside the glTF file and then in the working folder, where a
// file of the same name has no business; base_dir is absolute, which tells the two apart. Its own path expansion starts
// a shell.

bool file_exists(const std::string& path, void*) {
  std::error_code ignored;
  return std::filesystem::path(path).is_absolute() && std::filesystem::is_regular_file(path, ignored);
}

std::string same_path(const std::string& path, void*) { return path; }

/// What lies beside the glTF file, in the order in which tinygltf reads it: buffers first, then images.
struct ExternalFiles {
  std::string content;
  std::vector<size_t> buffer_lengths;  // as the document states them
  size_t read = 0;
};

bool read_external(std::vector<unsigned char>* out, std::string*, const std::string& path, void* context) {
  ExternalFiles& files = *static_cast<ExternalFiles*>(context);
  const std::string bytes = read_file(path);
  out->assign(bytes.begin(), bytes.end());
  // A file may be longer than the buffer in it (glTF 2.0, 3.6.1.1), which tinygltf takes for an error.
  if (files.read < files.buffer_lengths.size() && out->size() > files.buffer_lengths[files.read])
    out->resize(files.buffer_lengths[files.read]);
  ++files.read;
  files.content += bytes;
  return true;
}

/// Keeps the encoded bytes: decoding is done later and in parallel.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  image->image.assign(bytes, bytes + size);
  return true;
}

tinygltf::Model read_model(GltfDocument& document) {
  tinygltf::TinyGLTF reader;
  ExternalFiles external;
  for (const GltfValue& buffer : document.list("buffers"))
    if (const std::optional<GltfValue> uri = buffer.find("uri"); uri && !uri->text().starts_with("data:"))
      external.buffer_lengths.push_back(buffer.at("byteLength").integer(1));
  reader.SetFsCallbacks({file_exists, same_path, read_external, nullptr, &external});
  reader.SetImageLoader(keep_encoded, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const std::string folder = std::filesystem::absolute(document.file).parent_path().string();
  const std::string& bytes = document.content;
  const auto size = static_cast<unsigned int>(bytes.size());
  const bool loaded =
      bytes.starts_with(glb_magic)
          ? reader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                        size, folder)
          : reader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  document.content += external.content;
  if (loaded) return model;
  // It stops at the first thing that it cannot read, so the number of things it has read tells which.
  std::string place = "document";
  if (model.buffers.size() < document.count("buffers"))
    place = fmt::format("buffers[{}]", model.buffers.size());
  else if (model.images.size() < document.count("images"))
    place = fmt::format("images[{}]", model.images.size());
  // Its messages quote whole data URIs and come on several lines.
  error = error.substr(0, std::min<size_t>(error.find('\n'), 100));
  throw Error(document.file, place, error.empty() ? "cannot be read" : error);
}

TextureImage decode(tinygltf::Image& encoded, int index) {
  tinygltf::Image decoded;
  std::string error, warning;
  const std::vector<unsigned char>& bytes = encoded.image;
  if (bytes.empty() || !tinygltf::LoadImageData(&decoded, index, &error, &warning, 0, 0, bytes.data(),
                                                static_cast<int>(bytes.size()), nullptr))
    return {};
  TextureImage image;
  image.name = encoded.name.empty() ? encoded.uri : encoded.name;
  image.width = decoded.width;
  image.height = decoded.height;
  if (decoded.bits == 16) {
    image.texels16.resize(decoded.image.size() / sizeof(uint16_t));
    std::memcpy(image.texels16.data(), decoded.image.data(), decoded.image.size());
  } else {
    image.texels8 = std::move(decoded.image);
  }
  encoded.image = {};
  return image;
}

}  // namespace

bool GltfDocument::uses(const std::string& extension) const {
  const std::vector<GltfValue> names = list("extensionsUsed");
  return std::any_of(names.begin(), names.end(), [&](const GltfValue& name) { return name.text() == extension; });
}

GltfDocument open_gltf(const std::filesystem::path& file) {
  GltfDocument document;
  document.file = file.string();
  if (std::filesystem::is_directory(file)) throw Error(document.file, "file", "is a folder");
  document.content = read_file(file);
  const std::string_view bytes = document.content;
  if (bytes.size() > std::numeric_limits<uint32_t>::max()) throw Error(document.file, "file", "larger than 4 GiB");
  const bool is_glb = bytes.starts_with(glb_magic);
  if (!is_glb && file.extension() == ".glb") throw Error(document.file, "GLB header", "not a GLB file");
  document.json = parse(is_glb ? glb_json(bytes, document.file) : bytes, document.file);

  const GltfValue version = document.root().at("asset").at("version");
  if (!version.text().starts_with("2.")) version.fail(fmt::format("{}, only 2.0 is supported", version.quoted()));
  check_extensions(document);
  check_buffers(document, is_glb);
  return document;
}

void load_bytes(GltfDocument& document) {
  tinygltf::Model model;
  try {
    model = read_model(document);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // nlohmann's, and the standard library's
    throw Error(document.file, "document", error.what());
  }
  for (tinygltf::Buffer& buffer : model.buffers) document.buffers.push_back(std::move(buffer.data));
  document.images.resize(model.images.size());
  parallel_for(model.images.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) document.images[i] = decode(model.images[i], static_cast<int>(i));
  });
  for (size_t i = 0; i < document.images.size(); ++i)
    if (document.images[i].width == 0)
      throw Error(document.file, fmt::format("images[{}]", i),
                  model.images[i].image.empty() ? fmt::format("cannot read {}", model.images[i].uri)
                                                : "cannot be decoded; glTF 2.0 knows PNG and JPEG");
}

}  // namespace voxref
