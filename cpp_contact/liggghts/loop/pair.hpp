// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's pair style of one contact model: our loop where it can, LIGGGHTS's own with the same model elsewhere.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <set>
#include <string>

#include "compute.h"
#include "loop.hpp"
#include "model.hpp"
#include "modify.h"

namespace epdem::liggghts::loop {

/// `Granular` keeps its model to itself; the model built last is its own.
template <class Model>
class Pair : public LIGGGHTS::PairStyles::Granular<Model> {
  using Base = LIGGGHTS::PairStyles::Granular<Model>;
  using Law = typename Model::law_type;

 public:
  Pair(LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::PairGran* parent, int64_t hash)
      : Base(lmp, parent, hash),
        lmp_(lmp),
        model_(*Model::latest),
        ids_(Ids::of(hash)),
        missing_(what_is_missing(ids_)) {
    if (missing_) return;
    plan_.tangential = ids_.tangential == TANGENTIAL_HISTORY          ? Tangential::history
                       : ids_.tangential == TANGENTIAL_NO_HISTORY     ? Tangential::no_history
                       : ids_.tangential == TANGENTIAL_PARTIAL_SLIP   ? Tangential::partial_slip
                       : ids_.tangential == TANGENTIAL_PARTIAL_SLIP_2 ? Tangential::partial_slip_2
                                                                      : Tangential::off;
    plan_.rolling = ids_.rolling == ROLLING_CDT     ? Rolling::cdt
                    : ids_.rolling == ROLLING_EPSD2 ? Rolling::epsd2
                                                    : Rolling::off;
    plan_.cohesion = ids_.cohesion == COHESION_SJKR    ? Cohesion::sjkr
                     : ids_.cohesion == COHESION_SJKR2 ? Cohesion::sjkr2
                                                       : Cohesion::off;
    if constexpr (adheres<Law>) {
      plan_.root = offsetof(State<Law>, root) / sizeof(double);
      plan_.last_step = memory<Law>;
    }
    const Kernel kernel =
        kernels(lmp).of[detail::place<Law>()][static_cast<int>(plan_.tangential)][plan_.rolling == Rolling::epsd2];
    loop_ = std::make_unique<PairLoop>(lmp, kernel);
  }

  void init_granular() override {
    Base::init_granular();
    if (!loop_) return;
    auto& normal = model_.normal();
    const auto& asked = model_.asked();
    plan_.damped = plan_.viscous = false;
    plan_.torsion = asked.torsion;
    plan_.cohesion_slides = asked.cohesion_slides;
    plan_.ledger = normal.ledger();
    plan_.width = normal.width();
    double** const mu =
        plan_.tangential == Tangential::off ? nullptr : property("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
    double** const rolling =
        plan_.rolling == Rolling::off ? nullptr : property("coeffRollFrict", &MODEL_PARAMS::createCoeffRollFrict);
    double** const density = plan_.cohesion == Cohesion::off
                                 ? nullptr
                                 : property("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity);
    plan_.constants.assign(plan_.width * plan_.width * most_constants, 0.0);
    for (int i = 1; i < plan_.width; ++i)
      for (int j = 1; j < plan_.width; ++j) {
        const auto& entry = normal.entry(i, j);
        double* const c = plan_.constants.data() + most_constants * (i * plan_.width + j);
        c[shear_modulus] = entry.G_star;
        c[damping] = entry.damping_number;
        c[dashpot] = entry.viscous_number;
        c[friction] = mu ? mu[i][j] : 0.0;
        c[rolling_friction] = rolling ? rolling[i][j] : 0.0;
        c[cohesion_density] = density ? density[i][j] : 0.0;
        std::memcpy(c + law_data, &entry.law, sizeof(Law));
        plan_.damped |= entry.damping_number > 0.0;
        plan_.viscous |= entry.viscous_number > 0.0;
      }
  }

#if __has_include("iloopcallbackcallable.h")  // LIGGGHTS-INL: a compute asks for its steps in place of a flag
  void compute_force(LAMMPS_NS::PairGran* pair, int eflag, int vflag) override {
    const LAMMPS_NS::Modify& m = *lmp_->modify;
    const auto asks = [&](LAMMPS_NS::Compute* c) {
      return std::strcmp(c->style, "pair/gran/local") == 0 && c->callRequired(lmp_->update->ntimestep);
    };
    forces(pair, eflag, vflag, std::any_of(m.compute, m.compute + m.ncompute, asks));
  }
#else
  void compute_force(LAMMPS_NS::PairGran* pair, int eflag, int vflag, int addflag) override {
    forces(pair, eflag, vflag, addflag, addflag);
  }
#endif

 private:
  /// `listed`: compute pair/gran/local lists each contact; `addflag` says so to a LIGGGHTS that has it.
  template <class... Flag>
  void forces(LAMMPS_NS::PairGran* pair, int eflag, int vflag, int listed, Flag... addflag) {
    const char* why = missing_ ? missing_ : model_.asked().missing();
    if (!why) why = loop_->obstacle(pair, plan_, vflag, listed);
    if (why) {
      say(why);
      return Base::compute_force(pair, eflag, vflag, addflag...);
    }
    if (eflag)
      pair->ev_setup(eflag, vflag);  // the energy of granular pairs is nil, but its sums are to be cleared
    else
      pair->evflag = pair->vflag_fdotr = 0;
    SurfacesIntersectData s{};
    ForceData none;
    s.computeflag = s.shearupdate = 1;
    model_.beginPass(s, none, none);
    loop_->run(pair, plan_, model_.normal().now());
    model_.endPass(s, none, none);
  }

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

  /// Once for each reason, on the first rank.
  void say(const char* why) {
    if (!*why || lmp_->comm->me != 0 || !said_.insert(why).second) return;
    const std::string line = std::string("epdem: pair loop of LIGGGHTS for ") + why + "\n";
    if (lmp_->screen) std::fputs(line.c_str(), lmp_->screen);
    if (lmp_->logfile) std::fputs(line.c_str(), lmp_->logfile);
  }

  LAMMPS_NS::LAMMPS* const lmp_;
  Model& model_;
  const Ids ids_;
  const char* const missing_;
  std::unique_ptr<PairLoop> loop_;
  Plan plan_;
  std::set<std::string> said_;
};

}  // namespace epdem::liggghts::loop
