// SPDX-License-Identifier: GPL-2.0-or-later
// Setting computeContactStrain: how far contacts leave small strain, the largest of all steps.
#pragma once

#include <algorithm>
#include <string>

#include "fix_property_global.h"
#include "host.hpp"

namespace epdem::liggghts {

/// Per-atom property contactStrain of two values, w a/R* and w overlap/R*. Only their maxima over
/// all atoms have a meaning: the largest of all contacts and steps so far. A global property keeps the maxima of this
/// rank, of pairs and walls, and a body of the rank holds them for outputs and restart files: the body that reached
/// them may leave the simulation.
class LargestStrain {
 public:
  /// For the pair style, whose settings come first: creates the properties.
  static void create(LAMMPS_NS::LAMMPS* lmp) {
    const char* bodies[] = {name, "all", "property/atom", name, "vector", "yes", "no", "no", "0.0", "0.0"};
    const char* rank[] = {of_rank, "all", "property/global", of_rank, "vector", "0.0", "0.0"};
    if (!find(lmp, name)) lmp->modify->add_fix_property_atom(10, const_cast<char**>(bodies), name);
    if (find_of_rank(lmp, name)) return;
    lmp->modify->add_fix(7, const_cast<char**>(rank));
    for (int k = 0; k < 2; ++k) find_of_rank(lmp, name)->vector_modify(k, 0.0);  // LIGGGHTS leaves it unset
  }

  /// Before each run, for pairs and walls. Bodies of a restart file hold the maxima.
  void connect(LAMMPS_NS::LAMMPS* lmp, const std::string& model) {
    held_ = find(lmp, model.c_str());
    most_ = find_of_rank(lmp, model.c_str());
    if (!held_ || !most_) {
      const std::string text =
          "model " + model + ": computeContactStrain on of a wall needs it for the pair style as well";
      lmp->error->all(FLERR, text.c_str());
    }
    for (int i = 0; i < lmp->atom->nlocal; ++i) note(held_->array_atom[i][0], held_->array_atom[i][1]);
  }

  /// w a/R* and w overlap/R* of one contact or of several, of which `body` is one that this rank owns.
  void note(int body, double radius, double overlap) {
    note(radius, overlap);
    hold(body);
  }

  /// At the start of a pass over all pairs; lists_are_new: bodies may have left. Collective.
  void keep(const LAMMPS_NS::LAMMPS& lmp, bool lists_are_new) {
    if (lists_are_new) {
      double all[2];
      MPI_Allreduce(most_->get_values_modified(), all, 2, MPI_DOUBLE, MPI_MAX, lmp.world);
      note(all[0], all[1]);
    }
    if (lmp.atom->nlocal > 0) hold(0);
  }

 private:
  static constexpr const char *name = "contactStrain", *of_rank = "contactStrainOfRank";

  static LAMMPS_NS::FixPropertyAtom* find(LAMMPS_NS::LAMMPS* lmp, const char* caller) {
    return static_cast<LAMMPS_NS::FixPropertyAtom*>(
        lmp->modify->find_fix_property(name, "property/atom", "vector", 2, 0, caller, false));
  }
  static LAMMPS_NS::FixPropertyGlobal* find_of_rank(LAMMPS_NS::LAMMPS* lmp, const char* caller) {
    return static_cast<LAMMPS_NS::FixPropertyGlobal*>(
        lmp->modify->find_fix_property(of_rank, "property/global", "vector", 2, 0, caller, false));
  }

  void note(double radius, double overlap) {
    const double now[] = {radius, overlap};
    for (int k = 0; k < 2; ++k)
      if (now[k] > most_->get_values_modified()[k]) most_->vector_modify(k, now[k]);
  }
  void hold(int body) { std::copy_n(most_->get_values_modified(), 2, held_->array_atom[body]); }

  LAMMPS_NS::FixPropertyAtom* held_ = nullptr;
  LAMMPS_NS::FixPropertyGlobal* most_ = nullptr;
};

}  // namespace epdem::liggghts
