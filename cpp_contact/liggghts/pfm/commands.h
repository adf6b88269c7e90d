// SPDX-License-Identifier: GPL-2.0-or-later
// Two commands of LIGGGHTS-PUBLIC that LIGGGHTS-PFM lacks, so that decks of the one run in the other.
#ifdef COMMAND_CLASS

// clang-format off
CommandStyle(hard_particles, ModulusLimits)
CommandStyle(soft_particles, ModulusLimits)
// clang-format on

#else

#ifndef EPDEM_COMMANDS_H
#define EPDEM_COMMANDS_H

#include "pointers.h"

namespace LAMMPS_NS {

/// LIGGGHTS-PFM has no upper limit of youngsModulus; its lower one, 5e6 Pa, cannot be lifted, and it says so itself.
class ModulusLimits : protected Pointers {
 public:
  explicit ModulusLimits(LAMMPS* lmp) : Pointers(lmp) {}
  void command(int, char**) {}
};

}  // namespace LAMMPS_NS

#endif
#endif
