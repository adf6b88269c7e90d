// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's headers include this list several times; Debian's package has no copy, because LIGGGHTS's build makes it.
#include "rolling_model_cdt.h"
#include "rolling_model_epsd.h"
#include "rolling_model_epsd2.h"
#include "rolling_model_epsd3.h"
#include "rolling_model_luding.h"
