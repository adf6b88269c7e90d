// SPDX-License-Identifier: GPL-2.0-or-later
// In place of LIGGGHTS's integration of spheres and its gravity: the same operations over rows of numbers, so that not
// one bit differs. Groups of some spheres, dipoles and forces of gravity that vary remain with LIGGGHTS's own. Ghosts
// take their motion from their owners in the same way.
#include "atom_vec_sphere.h"
#include "fix_gravity.h"
#include "fix_nve_sphere.h"
#include "replaced.hpp"
#include "state.hpp"

#ifdef EPDEM_BUILT_FOR

#include <cmath>
#include <limits>

#include "domain.h"

namespace epdem::liggghts::loop {
namespace {

/// The state if the plugin moves the spheres: all of the first n spheres are in the group of a fix; else nullptr.
const LoopState* loops_of_all(LAMMPS_NS::LAMMPS* lmp, int group, int n) {
  const LAMMPS_NS::Atom& atom = *lmp->atom;
  int common = group;
  for (int i = 0; i < n; ++i) common &= atom.mask[i];
  return n > 0 && common == group ? active_loops(lmp) : nullptr;
}

/// Half a step of the first n spheres, whose positions stay.
HalfStep half_step(LAMMPS_NS::Atom& atom, int n, int dimension, double dt, double mass_factor) {
  const double inertia = dimension == 2 ? 0.5 : 0.4;
  return {n,           nullptr, atom.v[0], atom.omega[0], atom.f[0],  atom.torque[0], atom.rmass,
          atom.radius, 0.0,     dt,        dt / inertia,  mass_factor};
}

/// Whether ghosts take positions and velocities alone from their owners, moved by whole edges of the room.
bool sends_motion_alone(LAMMPS_NS::LAMMPS* lmp) {
  const LAMMPS_NS::Domain& d = *lmp->domain;
  return active_loops(lmp) && !lmp->atom->radvary_flag && !d.triclinic && !d.deform_vremap && !d.is_wedge;
}

}  // namespace
}  // namespace epdem::liggghts::loop

namespace LAMMPS_NS {

namespace loop = epdem::liggghts::loop;

[[gnu::visibility("default")]] void FixNVESphere::initial_integrate(int vflag) {
  static const auto original = loop::next<FixNVESphere*, int>("_ZN9LAMMPS_NS12FixNVESphere17initial_integrateEi");
  const int n = igroup == atom->firstgroup ? atom->nfirst : atom->nlocal;
  const loop::LoopState* const loops = extra ? nullptr : loop::loops_of_all(lmp, groupbit, n);
  if (!loops) return original(this, vflag);
  loop::HalfStep step = loop::half_step(*atom, n, domain->dimension, dtf, onePlusCAddRhoFluid_);
  step.x = atom->x[0];
  step.dt = dtv;
  loops->kernels.spheres.half_step(step);
}

[[gnu::visibility("default")]] void FixNVESphere::final_integrate() {
  static const auto original = loop::next<FixNVESphere*>("_ZN9LAMMPS_NS12FixNVESphere15final_integrateEv");
  const int n = igroup == atom->firstgroup ? atom->nfirst : atom->nlocal;
  const loop::LoopState* const loops = extra ? nullptr : loop::loops_of_all(lmp, groupbit, n);
  if (!loops) return original(this);
  loops->kernels.spheres.half_step(loop::half_step(*atom, n, domain->dimension, dtf, onePlusCAddRhoFluid_));
}

[[gnu::visibility("default")]] void FixGravity::post_force(int vflag) {
  static const auto original = loop::next<FixGravity*, int>("_ZN9LAMMPS_NS10FixGravity10post_forceEi");
  const int n = atom->nlocal;
  constexpr int constant = 0;  // in LIGGGHTS's source alone
  if (varflag != constant || fm || fix_relax || domain->deform_flag || !atom->rmass ||
      !loop::loops_of_all(lmp, groupbit, n))
    return original(this, vflag);
  const double *const mass = atom->rmass, g[3] = {xacc, yacc, zacc};
  double* const f = atom->f[0];
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) f[3 * i + c] += mass[i] * g[c];
  eflag = 0;
  egrav =
      std::numeric_limits<double>::quiet_NaN();  // compute_scalar sums it where a command reads it: none moved since
}

[[gnu::visibility("default")]] double FixGravity::compute_scalar() {
  static const auto original =
      reinterpret_cast<double (*)(FixGravity*)>(dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS10FixGravity14compute_scalarEv"));
  if (eflag == 0 && std::isnan(egrav)) {
    const double *const x = atom->x[0], *const mass = atom->rmass;
    egrav = 0.0;
    for (int i = 0; i < atom->nlocal; ++i)
      egrav -= mass[i] * (xacc * x[3 * i] + yacc * x[3 * i + 1] + zacc * x[3 * i + 2]);
  }
  return original(this);
}

[[gnu::visibility("default")]] int AtomVecSphere::pack_comm_vel(int n, int* list, double* buf, int shifted, int* pbc) {
  static const auto original = reinterpret_cast<int (*)(AtomVecSphere*, int, int*, double*, int, int*)>(
      dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS13AtomVecSphere13pack_comm_velEiPiPdiS1_"));
  if (n == 0 || !loop::sends_motion_alone(lmp)) return original(this, n, list, buf, shifted, pbc);
  const double shift[3] = {pbc[0] * domain->xprd, pbc[1] * domain->yprd, pbc[2] * domain->zprd};
  const double *const x = atom->x[0], *const v = atom->v[0], *const w = atom->omega[0];
  double* __restrict row = buf;
  for (int k = 0; k < n; ++k, row += 9) {
    const long i = 3L * list[k];
    for (int c = 0; c < 3; ++c) {
      row[c] = shifted ? x[i + c] + shift[c] : x[i + c];
      row[3 + c] = v[i + c];
      row[6 + c] = w[i + c];
    }
  }
  return 9 * n;
}

[[gnu::visibility("default")]] void AtomVecSphere::unpack_comm_vel(int n, int first, double* buf) {
  static const auto original =
      loop::next<AtomVecSphere*, int, int, double*>("_ZN9LAMMPS_NS13AtomVecSphere15unpack_comm_velEiiPd");
  if (n == 0 || !loop::sends_motion_alone(lmp)) return original(this, n, first, buf);
  double *const x = atom->x[0], *const v = atom->v[0], *const w = atom->omega[0];
  const double* __restrict row = buf;
  for (long i = 3L * first; i < 3L * (first + n); i += 3, row += 9)
    for (int c = 0; c < 3; ++c) {
      x[i + c] = row[c];
      v[i + c] = row[3 + c];
      w[i + c] = row[6 + c];
    }
}

}  // namespace LAMMPS_NS
#endif
