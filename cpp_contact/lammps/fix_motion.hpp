// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID group-ID nve/sphere/ep: LAMMPS's nve/sphere, whose bits it has, as lanes.
#pragma once

#include "atom.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "kernels/spheres.hpp"
#include "update.h"
#include "words.hpp"

namespace epdem::lammps {

class FixMotion final : public LAMMPS_NS::Fix {
 public:
  static constexpr const char* style_name = "nve/sphere/ep";

  FixMotion(LAMMPS_NS::LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
    if (count > 3) error->all(FLERR, "fix nve/sphere/ep: {} is not known; it has no words", word[3]);
    if (!atom->omega_flag || !atom->radius_flag) error->all(FLERR, "fix nve/sphere/ep needs atom_style sphere");
    time_integrate = 1;
    dynamic_group_allow = 1;
  }

  int setmask() override { return LAMMPS_NS::FixConst::INITIAL_INTEGRATE | LAMMPS_NS::FixConst::FINAL_INTEGRATE; }
  void init() override {
    spheres_ = &kernels_of(lmp).spheres;
    reset_dt();
  }
  void reset_dt() override {
    dt_ = update->dt;
    half_ = 0.5 * update->dt * force->ftm2v;
  }
  void initial_integrate(int) override { step(true); }
  void final_integrate() override { step(false); }

 private:
  /// Half a step of the velocities, and with `moves` a step of the positions, of each row of spheres of the group.
  void step(bool moves) {
    const int n = igroup == atom->firstgroup ? atom->nfirst : atom->nlocal;
    const auto is_ours = [this](int i) { return (atom->mask[i] & groupbit) != 0; };
    for (int i = 0; i < n; ++i) {
      const int first = i;
      while (i < n && is_ours(i)) ++i;
      if (i == first) continue;
      kernels::HalfStep s{i - first,
                          atom->x[first],
                          atom->v[first],
                          atom->omega[first],
                          atom->f[first],
                          atom->torque[first],
                          atom->rmass + first,
                          atom->radius + first,
                          dt_,
                          half_,
                          half_ / inertia,
                          1.0};
      if (!moves) s.x = nullptr;
      spheres_->half_step(s);
    }
  }

  static constexpr double inertia = 0.4;  // of a sphere, over m R^2
  const kernels::SphereKernels* spheres_ = nullptr;
  double dt_ = 0.0, half_ = 0.0;
};

}  // namespace epdem::lammps
