// SPDX-License-Identifier: GPL-2.0-or-later
// Setting computePlasticWork: what contacts took for good and what they hold, added to the bodies.
#pragma once

#include <algorithm>
#include <string>

#include "epdem/compaction.hpp"
#include "epdem/contact.hpp"
#include "host.hpp"

namespace epdem::liggghts {

/// Per-atom properties: plasticWork [J] sums up every growth of plastic work since the start, elasticEnergy [J] is what
/// the contacts of this step can give back (with adhesion less their surface energy), loadedContacts counts those of
/// them that bear a force: a contact whose bodies overlap by less than the depth of its dent bears none. With adhesion
/// adhesiveWork [J] sums up what the forces lost in their jumps at touch and parting. With partial slip frictionWork
/// [J] sums up what friction took, and frictionEnergy [J] is what its springs can give back. Half of a pair's energy
/// belongs to each body, all of a wall's to the sphere. LIGGGHTS evaluates a pair that spans two ranks on both of them,
/// so each adds to its own body only. Without computeElasticEnergy there are no elasticEnergy and loadedContacts.
class EnergyTally {
 public:
  static constexpr const char *work_name = "plasticWork", *friction_name = "frictionWork";

  /// Indices of the bodies, and from which index on a body belongs to another rank.
  struct Bodies {
    int i, j, nlocal;
  };

  /// For the pair style, whose settings come first: creates the properties; walls follow. holds: also elastic energy.
  void create(LAMMPS_NS::LAMMPS* lmp, bool adds_friction, bool adheres, bool holds) {
    for (const char* name : {work_name, energy_name, loaded_name, friction_name, springs_name, adhesive_name}) {
      if (!adds_friction && (name == friction_name || name == springs_name)) continue;
      if (!adheres && name == adhesive_name) continue;
      if (!holds && (name == energy_name || name == loaded_name)) continue;
      const char* words[] = {name, "all", "property/atom", name, "scalar", "yes", "no", "no", "0.0"};
      if (!find(lmp, name, name)) lmp->modify->add_fix_property_atom(9, const_cast<char**>(words), name);
    }
  }

  /// Before each run, for pairs and walls. gives_back: with compaction the work of one contact can be negative.
  void connect(LAMMPS_NS::LAMMPS* lmp, const std::string& model, bool adds_friction, bool adheres,
               bool gives_back = false) {
    gives_back_ = gives_back;
    work_ = find(lmp, work_name, model.c_str());
    energy_ = find(lmp, energy_name, model.c_str());
    friction_ = find(lmp, friction_name, model.c_str());
    springs_ = find(lmp, springs_name, model.c_str());
    adhesive_ = find(lmp, adhesive_name, model.c_str());
    loaded_ = find(lmp, loaded_name, model.c_str());
    if (work_ && (friction_ || !adds_friction) && (adhesive_ || !adheres)) return;
    const std::string text = "model " + model +
                             ": computePlasticWork on of a wall needs it for the pair style as well" +
                             (adds_friction ? ", with the same tangential model"
                              : adheres     ? ", whose model has adhesion, too"
                                            : "");
    lmp->error->all(FLERR, text.c_str());
  }

  /// At the start of a kept pass over all pairs: what the contacts hold is counted anew.
  void open(int nlocal) {
    for (auto* of_step : {energy_, loaded_})
      if (of_step) std::fill_n(of_step->vector_atom, nlocal, 0.0);
    if (springs_) std::fill_n(springs_->vector_atom, nlocal, 0.0);
  }

  /// bears: whether the contact has a force, with adhesion whether its bodies are attached.
  void add(bool wall, const NormalEnergies<double>& e, bool bears, const Bodies& bodies) {
    const double part = wall ? 1.0 : 0.5;
    const bool both = !wall && bodies.j < bodies.nlocal;
    if (adhesive_) {
      adhesive_->vector_atom[bodies.i] += part * e.adhesion_loss;
      if (both) adhesive_->vector_atom[bodies.j] += part * e.adhesion_loss;
    }
    credit(bodies.i, part * e.plastic_work_step, part * e.stored, bears);
    if (both) credit(bodies.j, part * e.plastic_work_step, part * e.stored, bears);
  }

  /// The same for friction: work that it took in this step, elastic energy of its springs [J].
  void add_friction(bool wall, double lost, double stored, const Bodies& bodies) {
    const double part = wall ? 1.0 : 0.5;
    add_friction_to(bodies.i, part * lost, part * stored);
    if (!wall && bodies.j < bodies.nlocal) add_friction_to(bodies.j, part * lost, part * stored);
  }

  /// Adds the energies of one contact to one body [J].
  void credit(int body, double grown, double stored, bool bears) {
    if (grown > 0.0 || gives_back_) work_->vector_atom[body] += grown;  // few contacts grow
    if (energy_) energy_->vector_atom[body] += stored;
    if (loaded_) loaded_->vector_atom[body] += bears;
  }

  /// One number per body, for a loop that adds by itself as `add` does.
  bool gives_back() const { return gives_back_; }
  double* work() { return work_->vector_atom; }
  double* energy() { return energy_ ? energy_->vector_atom : nullptr; }
  double* loaded() { return loaded_ ? loaded_->vector_atom : nullptr; }
  double* adhesive() { return adhesive_ ? adhesive_->vector_atom : nullptr; }

 private:
  bool gives_back_ = false;
  static constexpr const char* energy_name = "elasticEnergy";
  static constexpr const char* loaded_name = "loadedContacts";
  static constexpr const char* springs_name = "frictionEnergy";
  static constexpr const char* adhesive_name = "adhesiveWork";

  static LAMMPS_NS::FixPropertyAtom* find(LAMMPS_NS::LAMMPS* lmp, const char* name, const char* caller) {
    return static_cast<LAMMPS_NS::FixPropertyAtom*>(
        lmp->modify->find_fix_property(name, "property/atom", "scalar", 0, 0, caller, false));
  }

  void add_friction_to(int body, double lost, double stored) {
    friction_->vector_atom[body] += lost;
    springs_->vector_atom[body] += stored;
  }

  LAMMPS_NS::FixPropertyAtom* work_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* energy_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* loaded_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* friction_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* springs_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* adhesive_ = nullptr;
};

}  // namespace epdem::liggghts
