// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's headers include this list several times; Debian's package has no copy, because LIGGGHTS's build makes it.
#include "cohesion_model_easo_capillary_viscous.h"
#include "cohesion_model_sjkr.h"
#include "cohesion_model_sjkr2.h"
#include "cohesion_model_washino_capillary_viscous.h"
