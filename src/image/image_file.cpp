#include "image/image_file.h"
