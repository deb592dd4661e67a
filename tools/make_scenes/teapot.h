#pragma once
#include "make_scenes/mesh.h"

namespace voxref {

/// The Utah teapot (M. Newell, University of Utah, 1975; its bottom by F. Crow, "The Origins of the Teapot", IEEE
/// Computer Graphics and Applications 7(1), 1987): 32 bicubic Bezier patches, +Y up, standing on y = 0, spout along +X,
/// in its own units (6.43 x 3.15 x 4). Each patch is cut into divisions x divisions cells of two triangles, less those
/// that vanish at the lid's and the bottom's poles: 64 n^2 - 8 n. Patches meet without gaps and their normals, the
/// surface's own, agree along their seams. Open where the original is: the ends of handle and spout, and the slit under
/// the lid.
/// @throws Error unless divisions is in [2, 64]: uncut, the two halves of handle and spout would coincide
Mesh teapot(int divisions);

}  // namespace voxref
