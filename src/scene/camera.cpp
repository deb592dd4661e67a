#include "scene/camera.h"
