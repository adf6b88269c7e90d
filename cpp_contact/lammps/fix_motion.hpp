// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID group-ID nve/sphere/ep and gravity/ep: LAMMPS's nve/sphere and gravity, whose bits they have, over rows of
// spheres; travel/ep: the travel of a wall whose speed a variable gives.
#pragma once

#include <string>

#include "atom.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "input.h"
#include "kernels/spheres.hpp"
#include "update.h"
#include "utils.h"
#include "variable.h"
#include "words.hpp"

namespace epdem::lammps {

/// Calls `of_row(first, count)` for each row of spheres of a group side by side in memory.
template <class OfRow>
void each_row(const LAMMPS_NS::Atom& atom, int igroup, int groupbit, OfRow of_row) {
  const int n = igroup == atom.firstgroup ? atom.nfirst : atom.nlocal;
  const auto is_ours = [&](int i) { return (atom.mask[i] & groupbit) != 0; };
  constexpr int all = 0;  // number of the group
  if (igroup == all && n > 0) return of_row(0, n);
  for (int i = 0; i < n; ++i) {
    const int first = i;
    while (i < n && is_ours(i)) ++i;
    if (i > first) of_row(first, i - first);
  }
}

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
  /// Half a step of the velocities, and with `moves` a step of the positions.
  void step(bool moves) {
    each_row(*atom, igroup, groupbit, [&](int first, int count) {
      kernels::HalfStep s{count,
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
    });
  }

  static constexpr double inertia = 0.4;  // of a sphere, over m R^2
  const kernels::SphereKernels* spheres_ = nullptr;
  double dt_ = 0.0, half_ = 0.0;
};

/// fix ID group-ID gravity/ep gx gy gz: three accelerations.
class FixGravity final : public LAMMPS_NS::Fix {
 public:
  static constexpr const char* style_name = "gravity/ep";

  FixGravity(LAMMPS_NS::LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
    if (count != 6) error->all(FLERR, "fix gravity/ep: the words are ID group gravity/ep gx gy gz");
    if (!atom->rmass_flag) error->all(FLERR, "fix gravity/ep needs atom_style sphere");
    for (int axis = 0; axis < 3; ++axis) g_[axis] = LAMMPS_NS::utils::numeric(FLERR, word[3 + axis], false, lmp);
    dynamic_group_allow = 1;
  }

  int setmask() override { return LAMMPS_NS::FixConst::POST_FORCE; }
  void setup(int vflag) override { post_force(vflag); }
  void post_force(int) override {
    each_row(*atom, igroup, groupbit, [this](int first, int count) {
      const double* const __restrict mass = atom->rmass + first;
      double* const __restrict f = atom->f[first];
      for (int i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis) f[3 * i + axis] += mass[i] * g_[axis];
    });
  }

 private:
  double g_[3];
};

/// fix ID group-ID travel/ep SPEED TRAVEL: adds variable SPEED times the time step to the internal variable TRAVEL at
/// the begin of each step, by the forces of the step before. LAMMPS's `controller` does so at the end of a step, so
/// that the first evaluation of the next run finds the wall ahead of the spheres, and its first step finds the wall at
/// rest.
class FixTravel final : public LAMMPS_NS::Fix {
 public:
  static constexpr const char* style_name = "travel/ep";

  FixTravel(LAMMPS_NS::LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
    if (count != 5) error->all(FLERR, "fix travel/ep: the words are ID group travel/ep SPEED TRAVEL");
    speed_ = word[3];
    travel_ = word[4];
  }

  int setmask() override { return LAMMPS_NS::FixConst::INITIAL_INTEGRATE; }
  void init() override {
    const int speed = number_of(speed_), travel = number_of(travel_);
    if (speed < 0 || !input->variable->equalstyle(speed) || travel < 0 || !input->variable->internalstyle(travel))
      error->all(FLERR, "fix travel/ep: {} must be a variable of style equal, and {} of style internal", speed_,
                 travel_);
  }
  void initial_integrate(int) override {
    LAMMPS_NS::Variable& variables = *input->variable;
    const int travel = number_of(travel_);
    variables.internal_set(travel,
                           variables.compute_equal(travel) + update->dt * variables.compute_equal(number_of(speed_)));
  }

 private:
  int number_of(const std::string& name) const { return input->variable->find(name.c_str()); }

  std::string speed_, travel_;
};

}  // namespace epdem::lammps
