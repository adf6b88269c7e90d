// SPDX-License-Identifier: GPL-2.0-or-later
// Two commands of LIGGGHTS-PUBLIC that LIGGGHTS-PFM lacks, so that decks of the one run in the other.
#ifdef COMMAND_CLASS

// clang-format off
CommandStyle(hard_particles, HardParticles)
CommandStyle(soft_particles, SoftParticles)
// clang-format on

#else

#ifndef EPDEM_COMMANDS_H
#define EPDEM_COMMANDS_H

#include "error.h"
#include "pointers.h"

namespace LAMMPS_NS {

/// LIGGGHTS-PFM has no upper limit of youngsModulus: there is nothing to allow.
class HardParticles : protected Pointers {
 public:
  explicit HardParticles(LAMMPS* lmp) : Pointers(lmp) {}
  void command(int, char**) {}
};

class SoftParticles : protected Pointers {
 public:
  explicit SoftParticles(LAMMPS* lmp) : Pointers(lmp) {}
  void command(int, char**) {
    error->all(FLERR, "soft_particles is not available in LIGGGHTS-PFM, which refuses youngsModulus below 5e6 Pa");
  }
};

}  // namespace LAMMPS_NS

#endif
#endif
