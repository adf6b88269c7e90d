// SPDX-License-Identifier: GPL-2.0-or-later
// Setting compaction: the growth of each sphere by the dents of all its contacts, from step to step.
#pragma once

#include <algorithm>
#include <string>

#include "epdem/compaction.hpp"
#include "host.hpp"

namespace epdem::liggghts {

/// Per-atom properties: the growth over the radius from the dents of the step before, and sums, to which the contacts
/// of this step add the depths of their dents over the radius and the squares of these. Walls come after the pairs, so
/// that the sums close at the begin of the next pass over the pairs.
class Growth {
 public:
  /// For the pair style, whose settings come first: creates the properties.
  static void create(LAMMPS_NS::LAMMPS* lmp) {
    const char* growth[] = {growth_name, "all", "property/atom", growth_name, "scalar", "yes", "yes", "no", "0.0"};
    const char* sums[] = {sums_name, "all", "property/atom", sums_name, "vector", "yes", "no", "no", "0.0", "0.0"};
    if (!find(lmp, growth_name, "scalar", 0, growth_name))
      lmp->modify->add_fix_property_atom(9, const_cast<char**>(growth), growth_name);
    if (!find(lmp, sums_name, "vector", 2, sums_name))
      lmp->modify->add_fix_property_atom(10, const_cast<char**>(sums), sums_name);
  }

  /// Whether the pair style has compaction.
  static bool exists(LAMMPS_NS::LAMMPS* lmp) { return find(lmp, growth_name, "scalar", 0, growth_name) != nullptr; }

  /// Before each run, for pairs and walls.
  void connect(LAMMPS_NS::LAMMPS* lmp, const std::string& model) {
    growth_ = find(lmp, growth_name, "scalar", 0, model.c_str());
    sums_ = find(lmp, sums_name, "vector", 2, model.c_str());
    if (growth_ && sums_) return;
    const std::string text = "model " + model + ": compaction on of a wall needs it for the pair style as well";
    lmp->error->all(FLERR, text.c_str());
  }

  /// At the start of a kept pass over all pairs: the sums of the step before give the growth. Collective.
  void close(const LAMMPS_NS::Atom& atom) {
    const int nlocal = atom.nlocal;
    for (int i = 0; i < nlocal; ++i) {
      double* const sums = sums_->array_atom[i];
      growth_->vector_atom[i] = growth(sums[0], sums[1]);
      sums[0] = sums[1] = 0.0;
    }
    growth_->do_forward_comm();
    largest_ = 0.0;
    for (int i = 0; i < nlocal + atom.nghost; ++i) largest_ = std::max(largest_, growth_->vector_atom[i]);
  }

  double of(int body) const { return growth_->vector_atom[body]; }
  const double* of_all() const { return growth_->vector_atom; }

  /// No grown spheres touch whose squared distance is above this factor times the squared sum of their radii.
  double factor() const { return touch_factor(largest_); }

  /// Two numbers per sphere, for a loop that books by itself as `add` does.
  double* sums() { return sums_->array_atom[0]; }

  /// The depth of a dent over the radius, of a contact of this step.
  void add(int body, double depth) {
    sums_->array_atom[body][0] += depth;
    sums_->array_atom[body][1] += depth * depth;
  }

 private:
  static constexpr const char* growth_name = "compactionGrowth";
  static constexpr const char* sums_name = "compactionSums";

  static LAMMPS_NS::FixPropertyAtom* find(LAMMPS_NS::LAMMPS* lmp, const char* name, const char* style, int values,
                                          const char* caller) {
    return static_cast<LAMMPS_NS::FixPropertyAtom*>(
        lmp->modify->find_fix_property(name, "property/atom", style, values, 0, caller, false));
  }

  LAMMPS_NS::FixPropertyAtom* growth_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* sums_ = nullptr;
  double largest_ = 0.0;
};

}  // namespace epdem::liggghts
