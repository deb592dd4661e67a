#pragma once
#include "scene/scene.h"
