// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's headers include this list several times; Debian's package has no copy, because LIGGGHTS's build makes it.
#include "tangential_model_history.h"
#include "tangential_model_luding_tn.h"
#include "tangential_model_no_history.h"
