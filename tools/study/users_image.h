#pragma once
#include <filesystem>

#include "image/image.h"

namespace voxref {

/// Somebody else's rendering, before tone mapping, for the ladder to end at: R,G,B of any picture that
/// read_linear_image reads. @throws Error naming the file: without R,G,B, and for pixels that are not finite, with
/// their number and the first place
Image read_users_image(const std::filesystem::path& file);

}  // namespace voxref
