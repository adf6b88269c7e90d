// SPDX-License-Identifier: GPL-2.0-or-later
// Setting compaction: what the contacts of each sphere do to it, from step to step.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "epdem/compaction.hpp"
#include "host.hpp"

namespace epdem::liggghts {

/// Per-atom properties: BodySums and BodyMemory of the step before, and sums, to which the contacts of this step add
/// their Dent. Walls come after the pairs, so that the sums close at the begin of the next pass over the pairs.
class Growth {
 public:
  /// For the pair style, whose settings come first: creates the properties.
  static void create(LAMMPS_NS::LAMMPS* lmp) {
    create(lmp, bodies_name, body_values, "yes");
    create(lmp, memory_name, memory_values, "no");
    create(lmp, sums_name, dent_sums, "no");
  }

  /// Whether the pair style has compaction.
  static bool exists(LAMMPS_NS::LAMMPS* lmp) { return find(lmp, bodies_name, body_values, bodies_name) != nullptr; }

  /// Before each run, for pairs and walls.
  void connect(LAMMPS_NS::LAMMPS* lmp, const std::string& model) {
    bodies_ = find(lmp, bodies_name, body_values, model.c_str());
    memory_ = find(lmp, memory_name, memory_values, model.c_str());
    sums_ = find(lmp, sums_name, dent_sums, model.c_str());
    kernels_ = sphere_kernels(lmp);
    if (bodies_ && memory_ && sums_) return;
    const std::string text = "model " + model + ": compaction on of a wall needs it for the pair style as well";
    lmp->error->all(FLERR, text.c_str());
  }

  /// At the start of a kept pass over all pairs: the sums of the step before give the growth. Collective.
  void close(const LAMMPS_NS::Atom& atom) {
    const int nlocal = atom.nlocal;
    if (nlocal == 0 && atom.nghost == 0) return static_cast<void>(bodies_->do_forward_comm());
    double *const bodies = bodies_->array_atom[0], *const memory = memory_->array_atom[0];
    largest_ = kernels_->close_sums({nlocal, sums(), bodies, memory, memory_values});
    bodies_->do_forward_comm();
    for (long i = nlocal; i < nlocal + atom.nghost; ++i) largest_ = std::max(largest_, bodies[body_values * i]);
  }

  BodySums<double> of(int body) const { return sums_of(of_all(), body); }
  const double* of_all() const { return bodies_->array_atom[0]; }

  /// No grown spheres touch whose squared distance is above this factor times the squared sum of their radii.
  double factor() const { return touch_factor(largest_); }
  /// The same with room for growth until the next neighbor lists.
  double factor_until_lists() const { return touch_factor(largest_ + 0.02); }

  /// dent_sums numbers per sphere, to which the contacts of this step add.
  double* sums() { return sums_->array_atom[0]; }

 private:
  static constexpr const char* bodies_name = "compactionGrowth";
  static constexpr const char* memory_name = "compactionMemory";
  static constexpr const char* sums_name = "compactionSums";

  static void create(LAMMPS_NS::LAMMPS* lmp, const char* name, int values, const char* to_ghosts) {
    if (find(lmp, name, values, name)) return;
    std::vector<const char*> words = {name, "all", "property/atom", name, "vector", "yes", to_ghosts, "no"};
    words.resize(words.size() + values, "0.0");
    lmp->modify->add_fix_property_atom(int(words.size()), const_cast<char**>(words.data()), name);
  }

  static LAMMPS_NS::FixPropertyAtom* find(LAMMPS_NS::LAMMPS* lmp, const char* name, int values, const char* caller) {
    return static_cast<LAMMPS_NS::FixPropertyAtom*>(
        lmp->modify->find_fix_property(name, "property/atom", "vector", values, 0, caller, false));
  }

  LAMMPS_NS::FixPropertyAtom* bodies_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* memory_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* sums_ = nullptr;
  const kernels::SphereKernels* kernels_ = nullptr;
  double largest_ = 0.0;
};

}  // namespace epdem::liggghts
