// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_heat.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "pair_ep.hpp"
#include "update.h"
#include "utils.h"

namespace epdem::lammps {

using namespace LAMMPS_NS;

FixHeat::FixHeat(LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
  heat_.read(
      count, word, atom->ntypes, [=](int k) { return utils::numeric(FLERR, word[k], false, lmp); },
      [=](const std::string& text) { lmp->error->all(FLERR, text); });
  create_attribute = 1;
  restart_peratom = 1;
  peratom_flag = 1;
  peratom_freq = 1;
  size_peratom_cols = 0;
  size_vector = static_cast<int>(heat_.walls().size());
  vector_flag = size_vector > 0;
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
  auto* const pair = dynamic_cast<PairEp*>(force->pair_match(PairEp::style_name, 1));
  if (!pair || !pair->energies())
    error->all(FLERR, "fix heat/ep: the area of the contacts comes from pair_style ep energies; give it");
  history_ = pair->history();
}

void FixHeat::open() {
  comm->forward_comm(this);
  heat_.open(atom->nlocal, vector_atom, atom->type, [this](int i) { return history_->work_of(i); });
}

void FixHeat::add_wall(const kernels::Block& b, int n, const char* fix) {
  kernels::Heat::Wall* const wall = heat_.wall(fix);
  for (int k = 0; wall && k < n; ++k) heat_.add_wall(b.i[k], *wall, b.contact_radius.a[k]);
}

void FixHeat::end_of_step() {
  heat_.close(
      vector_atom, atom->rmass, update->dt, [this](int i) { return history_->work_of(i); },
      [this](int i, double limit) {
        error->one(FLERR,
                   "fix heat/ep: a time step of {} is too long for the heat of atom {}, which needs at most {}; give a "
                   "smaller step or a larger specific heat",
                   update->dt, atom->tag[i], limit);
      },
      [this](int i) {
        error->one(FLERR, "fix heat/ep: atom {} or a neighbour has no temperature; give fix_modify {} temperature",
                   atom->tag[i], id);
      });
}

double FixHeat::compute_vector(int wall) {
  double all;
  MPI_Allreduce(&heat_.walls()[wall].flow, &all, 1, MPI_DOUBLE, MPI_SUM, world);
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

double FixHeat::memory_usage() { return static_cast<double>(4 * atom->nmax * sizeof(double)); }

}  // namespace epdem::lammps
