// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS-PFM's contact data under the names of LIGGGHTS-PUBLIC, by which the adapter of a law knows them.
#pragma once

#include "../host.hpp"

// these include less than they use
#include "atom.h"
#include "comm.h"
#include "global_properties.h"
#include "rolling_model_cdt.h"
#include "rolling_model_epsd.h"
#include "rolling_model_epsd2.h"
#include "surface_model_default.h"
#include "tangential_model_history.h"
#include "tangential_model_no_history.h"

namespace LIGGGHTS::ContactModels {

using SurfacesIntersectData = CollisionData;
using SurfacesCloseData = ContactData;
inline constexpr int CONTACT_NORMAL_MODEL = TOUCH_NORMAL_MODEL;

}  // namespace LIGGGHTS::ContactModels

#define contact_flags touch  // the one member with another name; every header of LIGGGHTS-PFM is above this line
