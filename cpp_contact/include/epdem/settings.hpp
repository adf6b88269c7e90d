// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace epdem {

/// A time step [s] of no motion, for evaluations beside the steps.
inline constexpr double no_time = 1e-200;

/// Settings of a step, the same for all contacts.
struct ContactSettings {
  double dt;              // time step [s]; no_time if the last step is repeated
  int rolling, cohesion;  // places in Rollings and Cohesions
  bool damped;            // whether any pair has a dashpot beside friction
  bool viscous;           // whether any pair has a normal dashpot
  bool torsion;           // rolling friction also resists torsion
  bool cohesion_slides;   // cohesion lowers the normal force that friction sees
  bool repeats = false;   // the histories are those after the last step, which is evaluated once more
};

}  // namespace epdem
