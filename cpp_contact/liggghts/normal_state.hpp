// SPDX-License-Identifier: GPL-2.0-or-later
// State that the normal model passes to epdem's tangential model.
#pragma once

#include "energy_tally.hpp"
#include "epdem/friction/sliding.hpp"

namespace epdem::liggghts {

/// Results of the normal model for the present contact that LIGGGHTS's data have no room for.
struct NormalContactState {
  Pressed<double> pressed{};  // but for the load: that is LIGGGHTS's Fn, which cohesion may change
  double stiffness = 0.0;     // 8 G* [Pa]
  double radius = 0.0;        // of the contact
  bool is_new = false;        // the pair parted since it was last stored: its history is void
  bool flattens = false;
  EnergyTally* tally = nullptr;  // where work is added, if computePlasticWork is on
};

}  // namespace epdem::liggghts
