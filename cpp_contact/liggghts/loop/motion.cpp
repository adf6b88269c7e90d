// SPDX-License-Identifier: GPL-2.0-or-later
// In place of LIGGGHTS's integration of spheres and its gravity: the same operations over rows of numbers, so that not
// one bit differs. Groups of some spheres, dipoles and forces of gravity that vary remain with LIGGGHTS's own.
#include "fix_gravity.h"
#include "fix_nve_sphere.h"
#include "loop.hpp"
#include "replaced.hpp"

#ifdef EPDEM_BUILT_FOR

#include "domain.h"

namespace epdem::liggghts::loop {
namespace {

/// Whether ours take over: all of the first n spheres are in the group of a fix.
bool has_all(LAMMPS_NS::LAMMPS* lmp, int group, int n) {
  if (generic_loop() || !library_matches(lmp)) return false;
  const LAMMPS_NS::Atom& atom = *lmp->atom;
  int common = group;
  for (int i = 0; i < n; ++i) common &= atom.mask[i];
  return n > 0 && common == group;
}

/// Half a step of the first n spheres, whose positions stay.
HalfStep half_step(LAMMPS_NS::Atom& atom, int n, int dimension, double dt, double mass_factor) {
  const double inertia = dimension == 2 ? 0.5 : 0.4;
  return {n,           nullptr, atom.v[0], atom.omega[0], atom.f[0],  atom.torque[0], atom.rmass,
          atom.radius, 0.0,     dt,        dt / inertia,  mass_factor};
}

}  // namespace
}  // namespace epdem::liggghts::loop

namespace LAMMPS_NS {

namespace loop = epdem::liggghts::loop;

[[gnu::visibility("default")]] void FixNVESphere::initial_integrate(int vflag) {
  static const auto original = loop::next<FixNVESphere*, int>("_ZN9LAMMPS_NS12FixNVESphere17initial_integrateEi");
  const int n = igroup == atom->firstgroup ? atom->nfirst : atom->nlocal;
  if (extra || !loop::has_all(lmp, groupbit, n)) return original(this, vflag);
  loop::HalfStep step = loop::half_step(*atom, n, domain->dimension, dtf, onePlusCAddRhoFluid_);
  step.x = atom->x[0];
  step.dt = dtv;
  loop::sphere_kernels(lmp).half_step(step);
}

[[gnu::visibility("default")]] void FixNVESphere::final_integrate() {
  static const auto original = loop::next<FixNVESphere*>("_ZN9LAMMPS_NS12FixNVESphere15final_integrateEv");
  const int n = igroup == atom->firstgroup ? atom->nfirst : atom->nlocal;
  if (extra || !loop::has_all(lmp, groupbit, n)) return original(this);
  loop::sphere_kernels(lmp).half_step(loop::half_step(*atom, n, domain->dimension, dtf, onePlusCAddRhoFluid_));
}

[[gnu::visibility("default")]] void FixGravity::post_force(int vflag) {
  static const auto original = loop::next<FixGravity*, int>("_ZN9LAMMPS_NS10FixGravity10post_forceEi");
  const int n = atom->nlocal;
  constexpr int constant = 0;  // in LIGGGHTS's source alone
  if (varflag != constant || fm || fix_relax || !atom->rmass || !loop::has_all(lmp, groupbit, n))
    return original(this, vflag);
  const double *const x = atom->x[0], *const mass = atom->rmass, g[3] = {xacc, yacc, zacc};
  double *const f = atom->f[0], energy = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) f[3 * i + c] += mass[i] * g[c];
    energy -= mass[i] * (g[0] * x[3 * i] + g[1] * x[3 * i + 1] + g[2] * x[3 * i + 2]);
  }
  eflag = 0;
  egrav = energy;
}

}  // namespace LAMMPS_NS
#endif
