// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's pair style of one contact model: our loop where it can, LIGGGHTS's own with the same model elsewhere.
#pragma once

#include <algorithm>
#include <cstring>

#include "compute.h"
#include "modify.h"
#include "planned.hpp"

namespace epdem::liggghts::loop {

class Pair : public LIGGGHTS::PairStyles::Granular<Model>, private Planned {
  using Base = LIGGGHTS::PairStyles::Granular<Model>;
  using Planned::lmp_;

 public:
  Pair(LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::PairGran* parent, int64_t hash)
      : Base(lmp, parent, hash), Planned(lmp, model_of(static_cast<Base&>(*this)), hash, false), loop_(lmp) {}

  void init_granular() override {
    Base::init_granular();
    if (!missing()) prepare();
    loop_.forget_lists();
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
    const char* why = missing();
    if (!why) why = loop_.obstacle(pair, plan_, vflag, listed);
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
    loop_.run(pair, plan_, model_.normal().now());
    model_.endPass(s, none, none);
  }

  PairLoop loop_;
};

}  // namespace epdem::liggghts::loop
