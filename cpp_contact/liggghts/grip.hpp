// SPDX-License-Identifier: GPL-2.0-or-later
// What passes from a law's adapter to a tangential model of ours beside it.
#pragma once

#include "epdem/partial_slip.hpp"
#include "ledger.hpp"

namespace epdem::liggghts {

/// What a law's adapter knows of the contact at hand and LIGGGHTS's data have no room for.
struct Grip {
  Pressed<double> pressed{};  // but for the load: that is LIGGGHTS's Fn, which cohesion may change
  double stiffness = 0.0;     // 8 G* [Pa]
  bool fresh = false;         // the pair parted since it was last stored: what it remembers is void
  bool flattens = false;
  Ledger* ledger = nullptr;  // where work is booked, if it is asked for
};

}  // namespace epdem::liggghts
