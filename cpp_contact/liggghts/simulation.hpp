// SPDX-License-Identifier: GPL-2.0-or-later
// State of one simulation between calls of LIGGGHTS.
#pragma once

#include <cstring>
#include <memory>
#include <set>
#include <string>

#include "compute.h"
#include "host.hpp"
#include "memory.h"
#include "modify.h"

namespace epdem::liggghts {

namespace loop {
struct LoopState;
}

/// A compute that does nothing: it begins and ends with its simulation. Not a fix: a fix that LIGGGHTS constructs takes
/// the next place of the list of fixes, whatever its constructor adds there.
class Simulation : public LAMMPS_NS::Compute {
 public:
  /// nullptr: no call of `of` came before.
  static Simulation* find(const LAMMPS_NS::LAMMPS* lmp) {
    const LAMMPS_NS::Modify& m = *lmp->modify;
    for (int k = 0; k < m.ncompute; ++k)
      if (std::strcmp(m.compute[k]->id, name) == 0) return static_cast<Simulation*>(m.compute[k]);
    return nullptr;
  }

  static Simulation& of(LAMMPS_NS::LAMMPS* lmp) {
    if (Simulation* const known = find(lmp)) return *known;
    LAMMPS_NS::Modify& m = *lmp->modify;
    if (m.ncompute == m.maxcompute) {
      m.maxcompute += 4;
      m.compute =
          static_cast<Compute**>(lmp->memory->srealloc(m.compute, m.maxcompute * sizeof(Compute*), "modify:compute"));
    }
    auto* const made = new Simulation(lmp, 0);  // LIGGGHTS deletes its computes; add_compute takes a registered style
    m.compute[m.ncompute++] = made;
    return *made;
  }

  void init() override {}

  /// Whether this text is new: pair styles, walls and runs say the same.
  bool is_new(const std::string& text) { return said_.insert(text).second; }

  std::shared_ptr<loop::LoopState> loops;
  std::set<std::string> stored_walls;  // fixes of a restart file that hold contacts no wall has claimed

 private:
  static constexpr const char* name = "epdem_simulation";
  static constexpr const char* words[] = {name, "all", "epdem"};

  Simulation(LAMMPS_NS::LAMMPS* lmp, int first) : Compute(lmp, first, 3, const_cast<char**>(words)) {}

  std::set<std::string> said_;
};

/// Prints a line once in a simulation.
inline void say_once(LAMMPS_NS::LAMMPS* lmp, const std::string& line) {
  if (Simulation::of(lmp).is_new(line)) say(lmp, line);
}

}  // namespace epdem::liggghts
