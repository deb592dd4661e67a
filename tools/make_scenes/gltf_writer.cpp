#include "make_scenes/gltf_writer.h"
