#include "scene/caster.h"
