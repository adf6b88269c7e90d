// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_heat.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "atom.h"
#include "comm.h"
#include "epdem/conduction.hpp"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "pair_ep.hpp"
#include "update.h"
#include "utils.h"

namespace epdem::lammps {

using namespace LAMMPS_NS;

FixHeat::FixHeat(LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
  const auto number = [&](int k) { return utils::numeric(FLERR, word[k], false, lmp); };
  const auto above_zero = [&](int k, const char* what) {
    const double value = number(k);
    if (!(value > 0.0)) error->all(FLERR, "fix heat/ep: {} {} must be above 0", what, word[k]);
    return value;
  };
  const int first = 4, types = atom->ntypes, walls = first + 2 * types;
  if (types == 0) error->all(FLERR, "fix heat/ep: there is no simulation box; create it before");
  if (count < walls || (count - walls) % 4)
    error->all(FLERR,
               "fix heat/ep: the words are ID all heat/ep SHARE, k c of each of the {} types, and wall FIX T k of "
               "each wall with a temperature",
               types);
  share_ = number(3);
  if (!(share_ >= 0.0 && share_ <= 1.0)) error->all(FLERR, "fix heat/ep: share {} must lie in [0, 1]", word[3]);
  conductivity_.assign(types + 1, 0.0);
  capacity_.assign(types + 1, 0.0);
  for (int type = 1; type <= types; ++type) {
    conductivity_[type] = above_zero(first + 2 * type - 2, "conductivity");
    capacity_[type] = above_zero(first + 2 * type - 1, "specific heat");
  }
  for (int k = walls; k < count; k += 4) {
    if (std::strcmp(word[k], "wall") != 0) error->all(FLERR, "fix heat/ep: {} is not known; there is wall", word[k]);
    walls_.push_back({word[k + 1], number(k + 2), above_zero(k + 3, "conductivity"), 0.0});
  }
  create_attribute = 1;
  restart_peratom = 1;
  peratom_flag = 1;
  peratom_freq = 1;
  size_peratom_cols = 0;
  vector_flag = !walls_.empty();
  size_vector = static_cast<int>(walls_.size());
  extvector = 1;
  global_freq = 1;
  nevery = 1;
  comm_forward = 1;
  maxexchange = 1;
  FixHeat::grow_arrays(atom->nmax);
  for (int i = 0; i < atom->nlocal; ++i) FixHeat::set_arrays(i);
  atom->add_callback(Atom::GROW);
  atom->add_callback(Atom::RESTART);
}

FixHeat::~FixHeat() {
  if (!vector_atom) return;  // its words were wrong
  atom->delete_callback(id, Atom::GROW);
  atom->delete_callback(id, Atom::RESTART);
  memory->destroy(vector_atom);
}

FixHeat* FixHeat::of(const Modify& modify) {
  const auto found = modify.get_fix_by_style("^heat/ep$");
  return found.empty() ? nullptr : static_cast<FixHeat*>(found[0]);
}

void FixHeat::init() {
  if (modify->get_fix_by_style("^heat/ep$").size() > 1) error->all(FLERR, "fix heat/ep: there are two; keep one");
  const auto* const pair = dynamic_cast<PairEp*>(force->pair_match(PairEp::style_name, 1));
  if (!pair || !pair->energies())
    error->all(FLERR, "fix heat/ep: the area of the contacts comes from pair_style ep energies; give it");
}

void FixHeat::open() {
  flow_.assign(atom->nlocal, 0.0);
  conductance_.assign(atom->nlocal, 0.0);
  for (Wall& wall : walls_) wall.flow = 0.0;
  comm->forward_comm(this);
}

/// Heat [energy] of the plastic and frictional work of a contact in the step.
double FixHeat::source(const kernels::Block& b, int k, const Models& models) const {
  const double work = b.plastic_work_step.a[k];
  const double plastic = work > 0.0 || models.compaction ? work : 0.0;  // growth can give work back
  return share_ * (plastic + (models.adds_friction ? b.friction_work.a[k] : 0.0));
}

void FixHeat::add_pairs(const kernels::Block& b, int n, const Models& models) {
  const double per_time = 1.0 / update->dt;
  for (int k = 0; k < n; ++k) {
    const int i = b.i[k], j = b.j[k];
    const double G = conductance(conductivity_[atom->type[i]], conductivity_[atom->type[j]], b.contact_radius.a[k]);
    const double flow = G * (vector_atom[j] - vector_atom[i]), half = 0.5 * per_time * source(b, k, models);
    flow_[i] += flow + half;
    conductance_[i] += G;
    if (j >= atom->nlocal) continue;
    flow_[j] += half - flow;
    conductance_[j] += G;
  }
}

/// The work of a contact with a wall heats the sphere.
void FixHeat::add_wall(const kernels::Block& b, int n, const Models& models, const char* fix) {
  const auto wall = std::find_if(walls_.begin(), walls_.end(), [=](const Wall& w) { return w.fix == fix; });
  for (int k = 0; k < n; ++k) {
    const int i = b.i[k];
    flow_[i] += source(b, k, models) / update->dt;
    if (wall == walls_.end()) continue;
    const double G = conductance(conductivity_[atom->type[i]], wall->conductivity, b.contact_radius.a[k]);
    const double flow = G * (vector_atom[i] - wall->temperature);
    flow_[i] -= flow;
    conductance_[i] += G;
    wall->flow += flow;
  }
}

/// Explicit Euler: no temperature passes the temperatures of its neighbours while the step is below C/sum of the
/// conductances.
void FixHeat::end_of_step() {
  for (int i = 0; i < atom->nlocal; ++i) {
    const double C = atom->rmass[i] * capacity_[atom->type[i]], limit = C / conductance_[i];
    vector_atom[i] += update->dt * flow_[i] / C;
    if (update->dt > limit)
      error->one(FLERR,
                 "fix heat/ep: a time step of {} is too long for the heat of atom {}, which needs at most {}; give a "
                 "smaller step or a larger specific heat",
                 update->dt, atom->tag[i], limit);
    if (!std::isfinite(vector_atom[i]))
      error->one(FLERR, "fix heat/ep: atom {} or a neighbour has no temperature; give fix_modify {} temperature",
                 atom->tag[i], id);
  }
}

double FixHeat::compute_vector(int wall) {
  double all;
  MPI_Allreduce(&walls_[wall].flow, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

int FixHeat::modify_param(int count, char** word) {
  if (std::strcmp(word[0], "temperature") != 0) return 0;
  if (count < 4) error->all(FLERR, "fix_modify {}: the words are temperature FROM TO T", id);
  const tagint from = utils::tnumeric(FLERR, word[1], false, lmp), to = utils::tnumeric(FLERR, word[2], false, lmp);
  const double temperature = utils::numeric(FLERR, word[3], false, lmp);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->tag[i] >= from && atom->tag[i] <= to) vector_atom[i] = temperature;
  return 4;
}

int FixHeat::pack_forward_comm(int n, int* atoms, double* buffer, int, int*) {
  for (int k = 0; k < n; ++k) buffer[k] = vector_atom[atoms[k]];
  return n;
}

void FixHeat::unpack_forward_comm(int n, int first, double* buffer) { std::copy_n(buffer, n, vector_atom + first); }

void FixHeat::grow_arrays(int atoms) { memory->grow(vector_atom, atoms, "ep:temperature"); }

void FixHeat::copy_arrays(int from, int to, int) { vector_atom[to] = vector_atom[from]; }

void FixHeat::set_arrays(int i) { vector_atom[i] = std::numeric_limits<double>::quiet_NaN(); }

int FixHeat::pack_exchange(int i, double* buffer) {
  buffer[0] = vector_atom[i];
  return 1;
}

int FixHeat::unpack_exchange(int i, double* buffer) {
  vector_atom[i] = buffer[0];
  return 1;
}

int FixHeat::pack_restart(int i, double* buffer) {
  buffer[0] = 2;
  buffer[1] = vector_atom[i];
  return 2;
}

void FixHeat::unpack_restart(int i, int nth) {
  const double* values = atom->extra[i];
  for (int k = 0; k < nth; ++k) values += static_cast<int>(values[0]);
  vector_atom[i] = values[1];
}

double FixHeat::memory_usage() {
  return static_cast<double>((atom->nmax + flow_.capacity() + conductance_.capacity()) * sizeof(double));
}

}  // namespace epdem::lammps
