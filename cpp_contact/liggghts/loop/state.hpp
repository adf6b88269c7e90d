// SPDX-License-Identifier: GPL-2.0-or-later
// State of our loops between calls of LIGGGHTS.
#pragma once

#include <vector>

#include "kernels/block.hpp"
#include "simulation.hpp"

namespace epdem::liggghts::loop {

using namespace epdem::kernels;

/// The spheres of LIGGGHTS's bins side by side in memory, in the order of its linked lists.
struct Bins {
  std::vector<int> start;    // of each bin in `members`, and the end
  std::vector<int> members;  // eight more can be read
  std::vector<int> bin_of;   // of each sphere

  void fill(const int* head, const int* next, int count, int spheres);
};

/// Of one simulation, which holds it.
struct LoopState {
  const bool generic;  // the user chose LIGGGHTS's loops by EPDEM_LOOP=generic
  /// Of the widest instruction set of this processor, or of EPDEM_SIMD=sse2|avx2|avx512.
  const Kernels& kernels;
  Bins bins{};                    // as LIGGGHTS filled its bins last
  std::vector<double> spheres{};  // rows of position and radius at the last search, owned and ghosts
  std::vector<int> candidates{};  // room for a search
  long mesh_searches = 0;         // how many times this rank has searched the neighbours of a mesh
  bool deletes_atoms = false;     // whether delete_atoms runs
};

/// The state of a simulation, new at the first call.
LoopState& state_of(LAMMPS_NS::LAMMPS* lmp);

/// The same where our functions may take the place of LIGGGHTS's; nullptr: LIGGGHTS's run.
LoopState* active_loops(LAMMPS_NS::LAMMPS* lmp);

/// Whether the user chose LIGGGHTS's loops by EPDEM_LOOP=generic; ends the run if it is set to anything else.
bool generic_loop(LAMMPS_NS::LAMMPS* lmp);

}  // namespace epdem::liggghts::loop
