// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's headers include this list several times; Debian's package has no copy, because LIGGGHTS's build makes it.
#include "surface_model_default.h"
#include "surface_model_multicontact.h"
#include "surface_model_superquadric.h"
