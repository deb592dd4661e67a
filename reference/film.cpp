#include "reference/film.h"
