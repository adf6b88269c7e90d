// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace epdem {

/// What all contacts of a step have in common.
struct ContactSettings {
  double dt;              // time step [s]
  int rolling, cohesion;  // places in Rollings and Cohesions
  bool damped;            // whether any pair has a dashpot beside friction
  bool viscous;           // whether any pair has a normal dashpot
  bool torsion;           // rolling friction also resists torsion
  bool cohesion_slides;   // cohesion lowers the normal force that friction sees
};

}  // namespace epdem
