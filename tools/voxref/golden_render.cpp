#include "compare/select_layer.h"
#include "golden_command.h"
#include "provenance.h"

namespace voxref {

namespace {

/// The part of a rendered image that the set keeps.
Image kept(const Image& image, const GoldenCase& golden) {
  Image result = select_layer(image, "");
  if (golden.kind == GoldenKind::cone)
    for (const char* layer : {"direct", "diffuse", "specular"}) {
      result.add_layer(layer);
      for (size_t c = 0; c < 3; ++c) std::ranges::copy(image.layer(layer)[c], result.layer(layer)[c].begin());
    }
  return result;
}

}  // namespace

Image render_golden(const GoldenCase& golden, const Scene& scene, uint64_t seed, int spp, const Progress& progress) {
  const Caster caster(scene);
  const View view = golden.view(scene);
  nlohmann::json origin = provenance(scene, view);
  origin["instruction_set"] = instruction_set();
  if (golden.kind == GoldenKind::path) {
    const PathOptions options = golden.path(seed, spp);
    PathResult result = path_trace(scene, caster, view, options, progress);
    if (result.interrupted) throw Interrupted();
    add_path_provenance(origin, options, result.spp);
    Image image = kept(result.image, golden);
    attach(image, origin);
    return image;
  }
  ConeTraceResult result = cone_trace(scene, caster, view, golden.settings(), {}, progress);
  origin["settings"] = to_json(golden.settings());
  Image image = kept(result.image.image, golden);
  attach(image, origin);
  return image;
}

void write_golden_volumes(const GoldenCase& golden, const Scene& scene, const std::filesystem::path& folder,
                          const Progress& progress) {
  View view = golden.view(scene);
  view.width = view.height = 1;  // the image is not kept
  cone_trace(scene, Caster(scene), view, golden.settings(), {folder}, progress);
}

}  // namespace voxref
