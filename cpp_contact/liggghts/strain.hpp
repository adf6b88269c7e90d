// SPDX-License-Identifier: GPL-2.0-or-later
// Setting computeContactStrain: how far contacts leave small strain, the largest of all steps.
#pragma once

#include <algorithm>
#include <string>

#include "host.hpp"

namespace epdem::liggghts {

/// Per-atom property contactStrain of two values, contact radius over R* and overlap over R*. Only their maxima over
/// all atoms have a meaning: the largest of all contacts and steps so far. The maximum is written to a body of the
/// newest contacts, so that it stays when the body that reached it leaves the simulation.
class LargestStrain {
 public:
  /// For the pair style, whose settings come first: creates the property.
  static void create(LAMMPS_NS::LAMMPS* lmp) {
    const char* words[] = {name, "all", "property/atom", name, "vector", "yes", "no", "no", "0.0", "0.0"};
    if (!find(lmp, name)) lmp->modify->add_fix_property_atom(10, const_cast<char**>(words), name);
  }

  /// Before each run, for pairs and walls.
  void connect(LAMMPS_NS::LAMMPS* lmp, const std::string& model) {
    held_ = find(lmp, model.c_str());
    if (held_) return;
    const std::string text =
        "model " + model + ": computeContactStrain on of a wall needs it for the pair style as well";
    lmp->error->all(FLERR, text.c_str());
  }

  /// Contact radius and overlap over R* of one contact or of several, of which `body` is one that this rank owns.
  void note(int body, double radius, double overlap) {
    radius_ = std::max(radius_, radius);
    overlap_ = std::max(overlap_, overlap);
    double* const held = held_->array_atom[body];
    held[0] = std::max(held[0], radius_);
    held[1] = std::max(held[1], overlap_);
  }

 private:
  static constexpr const char* name = "contactStrain";

  static LAMMPS_NS::FixPropertyAtom* find(LAMMPS_NS::LAMMPS* lmp, const char* caller) {
    return static_cast<LAMMPS_NS::FixPropertyAtom*>(
        lmp->modify->find_fix_property(name, "property/atom", "vector", 2, 0, caller, false));
  }

  LAMMPS_NS::FixPropertyAtom* held_ = nullptr;
  double radius_ = 0.0, overlap_ = 0.0;
};

}  // namespace epdem::liggghts
