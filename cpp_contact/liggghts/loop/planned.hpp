// SPDX-License-Identifier: GPL-2.0-or-later
// Plan of our loops over pairs and walls from a contact model: its parts, settings and properties.
#pragma once

#include <algorithm>
#include <set>
#include <string>

#include "loop.hpp"
#include "model.hpp"

namespace epdem::liggghts::loop {

class Planned {
 protected:
  Planned(LAMMPS_NS::LAMMPS* lmp, Model& model, int64_t hash, bool wall)
      : lmp_(lmp),
        model_(model),
        ids_(Ids::of(hash)),
        generic_(generic_loop(lmp)),
        missing_(what_is_missing(ids_)),
        wall_(wall) {
    plan_.friction = std::max(0, Frictions::place(ids_.tangential));
    plan_.settings.rolling = std::max(0, Rollings::place(ids_.rolling));
    plan_.settings.cohesion = std::max(0, Cohesions::place(ids_.cohesion));
    plan_.adds_friction = adds_friction(ids_);
    plan_.rolls = has_history(Rollings{}, plan_.settings.rolling);
    plan_.last_step = model_.normal().history_size();
    if (wall && model_.normal().gap().root >= 0 && !missing_) missing_ = "contacts with adhesion";
  }

  /// Whether the model has rolling friction, ours or LIGGGHTS's.
  bool rolls() const { return ids_.rolling != ROLLING_OFF; }
  const LAMMPS_NS::Atom& atoms() const { return *lmp_->atom; }

  /// Model or setting that our loop does not include; nullptr: none.
  const char* missing() const {
    const char* const found = missing_ ? missing_ : model_.loop_settings().missing();
    return !found && generic_ ? "EPDEM_LOOP = generic" : found;
  }

  /// At the start of each run: settings and properties may have changed.
  void prepare() {
    NormalModel& normal = model_.normal();
    plan_.settings.damped = plan_.settings.viscous = false;
    plan_.settings.torsion = model_.loop_settings().torsion;
    plan_.settings.cohesion_slides = model_.loop_settings().cohesion_slides;
    plan_.tally = normal.tally();
    plan_.strain = normal.strain();
    plan_.heat = model_.heat();
    plan_.growth = normal.growth();
    plan_.judge = normal.judges() ? &normal : nullptr;
    plan_.gap = normal.gap();
    const Kernels& kernels = state_of(lmp_).kernels;
    plan_.spheres = &kernels.spheres;
    plan_.kernel = plan_.growth ? kernels.grown[normal.place()][plan_.friction][wall_][plan_.tally != nullptr]
                                : kernels.of[normal.place()][plan_.friction][wall_];
    plan_.width = normal.width();
    double** const mu = plan_.friction ? property("coeffFrict", &MODEL_PARAMS::createCoeffFrict) : nullptr;
    double** const rolling =
        plan_.settings.rolling ? property("coeffRollFrict", &MODEL_PARAMS::createCoeffRollFrict) : nullptr;
    double** const density =
        plan_.settings.cohesion ? property("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity) : nullptr;
    plan_.constants.assign(plan_.width * plan_.width * most_constants, 0.0);
    for (int i = 1; i < plan_.width; ++i)
      for (int j = 1; j < plan_.width; ++j) {
        double* const c = plan_.constants.data() + most_constants * (i * plan_.width + j);
        normal.put_constants(i, j, c);
        c[friction] = mu ? mu[i][j] : 0.0;
        c[rolling_friction] = rolling ? rolling[i][j] : 0.0;
        c[cohesion_density] = density ? density[i][j] : 0.0;
        plan_.settings.damped |= c[damping] > 0.0;
        plan_.settings.viscous |= c[dashpot] > 0.0;
      }
  }

  /// Prints why LIGGGHTS's loop runs: once for each reason, on the first rank.
  void say(const char* why) {
    if (!*why || !said_.insert(why).second) return;
    liggghts::say(lmp_, std::string("epdem: ") + (wall_ ? "wall" : "pair") + " loop of LIGGGHTS for " + why);
  }

  LAMMPS_NS::LAMMPS* const lmp_;
  Model& model_;
  Plan plan_;

 private:
  static const char* what_is_missing(const Ids& ids) {
    if (ids.surface != SURFACE_DEFAULT) return "surface multicontact";
    if (ids.rolling == ROLLING_EPSD) return "rolling_friction epsd";
    if (ids.rolling == ROLLING_EPSD3) return "rolling_friction epsd3";
    return nullptr;
  }

  double** property(const char* name, MatrixPropertyCreator creator) {
    double** values = nullptr;
    lmp_->force->registry.registerProperty(name, creator);
    lmp_->force->registry.connect(name, values, "epdem");
    return values;
  }

  const Ids ids_;
  const bool generic_;
  const char* missing_;
  const bool wall_;
  std::set<std::string> said_;
};

}  // namespace epdem::liggghts::loop
