// SPDX-License-Identifier: GPL-2.0-or-later
// State of one simulation between calls of LIGGGHTS.
#pragma once

#include <cstring>
#include <memory>
#include <set>
#include <string>

#include "fix.h"
#include "host.hpp"
#include "memory.h"
#include "modify.h"

namespace epdem::liggghts {

namespace loop {
struct LoopState;
}

/// A fix that does nothing: it begins and ends with its simulation.
class Simulation : public LAMMPS_NS::Fix {
 public:
  /// nullptr: no call of `of` came before.
  static Simulation* find(const LAMMPS_NS::LAMMPS* lmp) {
    const LAMMPS_NS::Modify& m = *lmp->modify;
    for (int k = 0; k < m.nfix; ++k)
      if (m.fix[k] && std::strcmp(m.fix[k]->id, name) == 0) return static_cast<Simulation*>(m.fix[k]);
    return nullptr;
  }

  /// Not while LIGGGHTS constructs a fix, whose place in the list would be taken.
  static Simulation& of(LAMMPS_NS::LAMMPS* lmp) {
    if (Simulation* const known = find(lmp)) return *known;
    LAMMPS_NS::Modify& m = *lmp->modify;
    if (m.nfix == m.maxfix) {
      m.maxfix += 4;
      m.fix = static_cast<Fix**>(lmp->memory->srealloc(m.fix, m.maxfix * sizeof(Fix*), "modify:fix"));
      lmp->memory->grow(m.fmask, m.maxfix, "modify:fmask");
    }
    auto* const made = new Simulation(lmp);  // LIGGGHTS deletes its fixes; add_fix would want a box
    m.fix[m.nfix] = made;
    m.fmask[m.nfix++] = 0;
    return *made;
  }

  int setmask() override { return 0; }

  /// Whether this text is new: pair styles, walls and runs say the same.
  bool is_new(const std::string& text) { return said_.insert(text).second; }

  std::shared_ptr<loop::LoopState> loops;

 private:
  static constexpr const char* name = "epdem_simulation";
  static constexpr const char* words[] = {name, "all", "epdem"};

  explicit Simulation(LAMMPS_NS::LAMMPS* lmp) : Fix(lmp, 3, const_cast<char**>(words)) {}

  std::set<std::string> said_;
};

/// Prints a line once in a simulation.
inline void say_once(LAMMPS_NS::LAMMPS* lmp, const std::string& line) {
  if (Simulation::of(lmp).is_new(line)) say(lmp, line);
}

}  // namespace epdem::liggghts
