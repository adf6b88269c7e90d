// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_history.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "kernels/gather.hpp"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "utils.h"

namespace epdem::lammps {

using namespace LAMMPS_NS;

namespace {

constexpr int most_beside = FixHistory::columns + dent_sums + 3;  // of an atom that is sent, beside its contacts
/// First number of a restart file; files of before have another number, and lack values.
constexpr double restart_form = -5.0;

}  // namespace

FixHistory::FixHistory(LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
  create_attribute = 1;
  restart_global = 1;
  restart_peratom = 1;
  maxexchange_dynamic = 1;
  maxexchange = most_beside;
  comm_forward = body_values;
  peratom_flag = count > 3;
  size_peratom_cols = columns;
  peratom_freq = 1;
  vector_flag = 1;
  size_vector = 2;
  extvector = 0;
  global_freq = 1;
  FixHistory::grow_arrays(atom->nmax);
  atom->add_callback(Atom::GROW);
  atom->add_callback(Atom::RESTART);
}

FixHistory::~FixHistory() {
  atom->delete_callback(id, Atom::GROW);
  atom->delete_callback(id, Atom::RESTART);
  memory->destroy(array_atom);
}

void FixHistory::prepare(NeighList* const* list, const Layout& layout, const Models& models) {
  list_ = list;
  std::vector<double> identity = ids_of(models);
  identity.push_back(layout.values);
  if (!identity_.empty() && identity_ != identity) {
    if (comm->me == 0)
      error->warning(FLERR, "pair_style ep: law or models changed; all contacts begin without a history");
    for (auto& held : held_) held.clear();
    page_.clear();
  }
  identity_ = identity;
  layout_ = layout;
  rename_partners();
  dents_.resize(models.compaction ? dent_sums * long(rows_) : 0);
}

int FixHistory::setmask() { return FixConst::PRE_EXCHANGE | FixConst::POST_NEIGHBOR; }

void FixHistory::open_energies(int atoms) {
  for (int i = 0; i < atoms; ++i)
    array_atom[i][elastic_energy] = array_atom[i][loaded_contacts] = array_atom[i][friction_energy] = 0.0;
}

void FixHistory::add_wall_energies(const kernels::Block& b, int n, const Models& models, bool holds) {
  for (int k = 0; k < n; ++k) {
    double* const row = array_atom[b.i[k]];
    const double work = b.plastic_work_step.a[k];
    if (work > 0.0 || models.compaction) row[plastic_work] += work;
    if (!holds) continue;
    row[elastic_energy] += b.stored_energy.a[k];
    row[loaded_contacts] += b.contact_radius.a[k] > 0.0;
  }
}

void FixHistory::add_works(const kernels::Block& b, int n, const Models& models, bool wall) {
  const bool adheres = models.law->gap.root >= 0;
  if (!adheres && !models.adds_friction) return;
  const double share = wall ? 1.0 : 0.5;
  const auto add = [&](int k, double* row) {
    if (adheres) row[adhesive_work] += share * b.adhesion_loss.a[k];
    if (!models.adds_friction) return;
    row[friction_work] += share * b.friction_work.a[k];
    row[friction_energy] += share * b.spring_energy.a[k];
  };
  for (int k = 0; k < n; ++k) {
    add(k, array_atom[b.i[k]]);
    if (!wall && b.j[k] < atom->nlocal) add(k, array_atom[b.j[k]]);
  }
}

void FixHistory::close_growth(bool counts, double (*close)(const kernels::BodyRows&)) {
  bodies_.resize(long(body_values) * rows_);
  largest_ = growth_reach;
  if (counts) {
    const int n = atom->nlocal;
    largest_ = n > 0 ? close({n, dents_.data(), bodies_.data(), array_atom[0] + body_memory, columns}) : 0.0;
    comm->forward_comm(this);
    for (long i = n; i < n + atom->nghost; ++i) largest_ = std::max(largest_, bodies_[body_values * i]);
  } else {
    std::fill_n(dents_.begin(), dent_sums * long(atom->nlocal), 0.0);
  }
}

void FixHistory::note_dents(const kernels::Block& b, int n, bool wall) {
  const auto add = [this](int i, const kernels::Line* dent, int k) {
    for (int c = 0; c < dent_sums; ++c) dents_[dent_sums * long(i) + c] += dent[c].a[k];
  };
  for (int k = 0; k < n; ++k) {
    add(b.i[k], b.dents_i, k);
    if (!wall && b.j[k] < atom->nlocal) add(b.j[k], b.dents_j, k);
  }
}

int FixHistory::pack_forward_comm(int n, int* atoms, double* buffer, int, int*) {
  for (long k = 0; k < n; ++k)
    std::copy_n(&bodies_[long(body_values) * atoms[k]], body_values, buffer + body_values * k);
  return body_values * n;
}

void FixHistory::unpack_forward_comm(int n, int first, double* buffer) {
  std::copy_n(buffer, long(body_values) * n, &bodies_[long(body_values) * first]);
}

void FixHistory::note_strain(const kernels::Block& b) {
  for (const int which : {0, 1}) strain_[which] = std::max(strain_[which], kernels::largest_strain(b, which));
}

double FixHistory::compute_vector(int which) {
  double most;
  MPI_Allreduce(&strain_[which], &most, 1, MPI_DOUBLE, MPI_MAX, world);
  return most;
}

void FixHistory::remember(int i, tagint partner, const double* values, bool mirrored) {
  std::vector<double>& held = held_[i];
  held.resize(held.size() + stride());
  double* const value = &held[held.size() - layout_.values];
  value[-1] = ubuf(partner).d;
  for (int k = 0; k < layout_.values; ++k) value[k] = mirrored ? layout_.mirror[k] * values[k] : values[k];
}

size_t FixHistory::longest() const {
  size_t most = 0;
  for (const auto& held : held_) most = std::max(most, held.size());
  return most;
}

int FixHistory::longest_of_ranks() const {
  const int here = static_cast<int>(longest());
  int most;
  MPI_Allreduce(&here, &most, 1, MPI_INT, MPI_MAX, world);
  return most;
}

/// From the list to the atoms: the contacts of the last evaluation.
void FixHistory::collect() {
  if (!page_holds_ || layout_.values == 0) return;
  const int nlocal = atom->nlocal;
  const tagint* const tag = atom->tag;
  for (auto& held : held_) held.clear();
  for (int place = 0; place < pairs_.count(); ++place) {
    const double* const history = at(place);
    if (history[layout_.last_step] != evaluations_) continue;
    const int i = pairs_.i(place), j = pairs_.j(place);
    remember(i, tag[j], history, false);
    if (j < nlocal) remember(j, tag[i], history, true);
  }
  std::copy_n(tag, nlocal, own_.begin());
  maxexchange = static_cast<int>(longest()) + most_beside;
}

/// An atom may pass a rank whose atoms have fewer contacts.
void FixHistory::setup_pre_exchange() { maxexchange = longest_of_ranks() + most_beside; }

void FixHistory::pre_exchange() {
  collect();
  setup_pre_exchange();
}

/// From tags of the last run to those of now; the history with an atom that is gone ends.
void FixHistory::rename_partners() {
  const int nlocal = atom->nlocal;
  const tagint* const tag = atom->tag;
  const int same_here = std::equal(tag, tag + nlocal, own_.begin());
  int same;
  MPI_Allreduce(&same_here, &same, 1, MPI_INT, MPI_MIN, world);
  if (same) return;
  std::vector<tagint> mine;
  for (int i = 0; i < nlocal; ++i)
    if (own_[i]) mine.insert(mine.end(), {own_[i], tag[i]});
  const int count = static_cast<int>(mine.size());
  std::vector<int> counts(comm->nprocs), first(comm->nprocs);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  std::exclusive_scan(counts.begin(), counts.end(), first.begin(), 0);
  std::vector<tagint> all(first.back() + counts.back());
  MPI_Allgatherv(mine.data(), count, MPI_LMP_TAGINT, all.data(), counts.data(), first.data(), MPI_LMP_TAGINT, world);
  std::unordered_map<tagint, tagint> now;
  for (size_t k = 0; k < all.size(); k += 2) now[all[k]] = all[k + 1];
  for (int i = 0; i < nlocal; ++i) {
    std::vector<double> kept;
    for (auto at = held_[i].begin(); at != held_[i].end(); at += stride()) {
      const auto found = now.find(static_cast<tagint>(ubuf(*at).i));
      if (found == now.end()) continue;
      kept.push_back(ubuf(found->second).d);
      kept.insert(kept.end(), at + 1, at + stride());
    }
    held_[i].swap(kept);
    own_[i] = tag[i];
  }
}

/// Commands between two runs may add, remove and sort atoms.
void FixHistory::post_run() {
  has_run_ = true;
  collect();
  page_holds_ = false;
}

/// Whether no atom moves farther than half of the skin from its place in the step of the lists.
bool FixHistory::narrows() const {
  return layout_.gap.growth >= 0 && neighbor->dist_check && neighbor->every == 1 && neighbor->delay == 0 &&
         !neighbor->build_once && !domain->box_change;
}

/// With compaction, pairs that cannot meet before the next lists are left out, until an atom grows more.
void FixHistory::post_neighbor() {
  listed_factor_ = narrows() ? touch_factor(largest_ + 0.02) : HUGE_VAL;
  distribute();
}

/// The growth of a restart is not known yet.
void FixHistory::setup_post_neighbor() {
  listed_factor_ = HUGE_VAL;
  distribute();
}

void FixHistory::widen() {
  if (factor() <= listed_factor_) return;
  listed_factor_ = HUGE_VAL;
  collect();
  distribute();
}

/// From the atoms to a new list.
void FixHistory::distribute() {
  read_list();
  page_holds_ = layout_.values > 0;
  if (!page_holds_) return;
  page_.assign(long(layout_.values) * pairs_.count(), 0.0);
  const tagint* const tag = atom->tag;
  for (int place = 0; place < pairs_.count(); ++place) {
    const std::vector<double>& held = held_[pairs_.i(place)];
    const tagint partner = held.empty() ? 0 : tag[pairs_.j(place)];
    for (size_t k = 0; k < held.size(); k += stride())
      if (static_cast<tagint>(ubuf(held[k]).i) == partner) {
        std::copy_n(held.data() + k + 1, layout_.values, at(place));
        break;
      }
  }
  if (layout_.gap.growth >= 0) pairs_.recall([this](int place) { return at(place)[layout_.last_step] > 0.0; });
}

void FixHistory::read_list() {
  const NeighList& list = **list_;
  const bool excludes = atom->molecular != Atom::ATOMIC;
  const double reach = std::sqrt(listed_factor_), *const radius = atom->radius;
  const auto is_apart = [&](int i, int j) {
    return kernels::is_far(atom->x[i], atom->x[j], radius[i] + radius[j], reach, neighbor->skin);
  };
  pairs_.clear(atom->nmax);
  for (int ii = 0; ii < list.inum; ++ii) {
    const int i = list.ilist[ii];
    pairs_.begin(i);
    for (int jj = 0; jj < list.numneigh[i]; ++jj) {
      const int j = list.firstneigh[i][jj];
      if (excludes && force->special_lj[(j >> SBBITS) & 3] == 0.0) continue;
      if (listed_factor_ < HUGE_VAL && is_apart(i, j & NEIGHMASK)) continue;
      pairs_.add(i, j & NEIGHMASK);
    }
  }
  pairs_.close();
}

void FixHistory::grow_arrays(int atoms) {
  held_.resize(atoms);
  own_.resize(atoms);
  if (!dents_.empty()) dents_.resize(dent_sums * long(atoms));
  memory->grow(array_atom, atoms, columns, "ep:energies");
  for (int i = rows_; i < atoms; ++i) std::fill_n(array_atom[i], int(columns), 0.0);
  rows_ = atoms;
}

void FixHistory::copy_arrays(int from, int to, int) {
  held_[to] = held_[from];
  own_[to] = own_[from];
  if (!dents_.empty()) std::copy_n(&dents_[dent_sums * long(from)], dent_sums, &dents_[dent_sums * long(to)]);
  std::copy_n(array_atom[from], int(columns), array_atom[to]);
}

void FixHistory::set_arrays(int i) {
  held_[i].clear();
  own_[i] = 0;
  if (!dents_.empty()) std::fill_n(&dents_[dent_sums * long(i)], dent_sums, 0.0);
  std::fill_n(array_atom[i], int(columns), 0.0);
}

int FixHistory::pack_exchange(int i, double* buffer) {
  double* end = std::copy_n(array_atom[i], int(columns), buffer);
  if (!dents_.empty()) end = std::copy_n(&dents_[dent_sums * long(i)], dent_sums, end);
  *end++ = ubuf(own_[i]).d;
  *end = ubuf(bigint(held_[i].size())).d;
  return static_cast<int>(std::copy(held_[i].begin(), held_[i].end(), end + 1) - buffer);
}

int FixHistory::unpack_exchange(int i, double* buffer) {
  const double* values = buffer + columns;
  std::copy_n(buffer, int(columns), array_atom[i]);
  if (!dents_.empty()) {
    std::copy_n(values, dent_sums, &dents_[dent_sums * long(i)]);
    values += dent_sums;
  }
  own_[i] = static_cast<tagint>(ubuf(*values++).i);
  const auto size = ubuf(*values++).i;
  held_[i].assign(values, values + size);
  return static_cast<int>(values + size - buffer);
}

void FixHistory::write_restart(FILE* file) {
  collect();
  const double strain[] = {compute_vector(0), compute_vector(1)};
  stored_most_ = longest_of_ranks();
  if (comm->me != 0) return;
  std::vector<double> stored{restart_form};
  stored.insert(stored.end(), identity_.begin(), identity_.end());
  stored.insert(stored.end(), {evaluations_, strain[0], strain[1]});
  std::string walls;  // their IDs, which have no blank
  for (const Fix* fix : modify->get_fix_by_style("^wall/ep")) walls += std::string(fix->id) + " ";
  stored.push_back(static_cast<double>(walls.size()));
  stored.insert(stored.end(), walls.begin(), walls.end());
  const int bytes = static_cast<int>(stored.size() * sizeof(double));
  fwrite(&bytes, sizeof bytes, 1, file);
  fwrite(stored.data(), 1, bytes, file);
}

void FixHistory::restart(char* stored) {
  const double* const values = reinterpret_cast<const double*>(stored);
  if (values[0] != restart_form)
    error->all(FLERR, "pair_style ep: the restart file comes from a former version of epdem; run its deck again");
  identity_.assign(values + 1, values + 5);
  layout_.values = static_cast<int>(values[4]);
  evaluations_ = values[5];
  std::copy_n(values + 6, 2, strain_);
  walls_ = utils::split_words(std::string(values + 9, values + 9 + long(values[8])));
}

std::string FixHistory::claim_wall(const std::string& fix, bool found) {
  const auto known = std::find(walls_.begin(), walls_.end(), fix);
  const bool listed = known != walls_.end();
  if (listed && found) walls_.erase(known);
  if (found || walls_.empty()) return "";
  if (listed) return "its contacts of the restart file ended with the first run; give the fix before this run";
  std::string others;
  for (const std::string& wall : walls_)
    if (!modify->get_fix_by_id(wall)) others += " " + wall;
  if (has_run_ || others.empty()) return "";
  return "the restart file holds contacts of walls with the IDs" + others +
         ", and none of a wall with this ID; give the fix its ID of before, a new wall after a run 0";
}

int FixHistory::size_restart(int i) { return static_cast<int>(held_[i].size()) + 1 + columns; }

int FixHistory::maxsize_restart() { return stored_most_ + 1 + columns; }

int FixHistory::pack_restart(int i, double* buffer) {
  const int size = size_restart(i);
  buffer[0] = size;
  std::copy(held_[i].begin(), held_[i].end(), std::copy_n(array_atom[i], int(columns), buffer + 1));
  return size;
}

void FixHistory::unpack_restart(int i, int nth) {
  const double* values = atom->extra[i];
  for (int k = 0; k < nth; ++k) values += static_cast<int>(values[0]);
  const int size = static_cast<int>(values[0]);
  std::copy_n(values + 1, int(columns), array_atom[i]);
  held_[i].assign(values + 1 + columns, values + size);
  own_[i] = atom->tag[i];
  maxexchange = std::max(maxexchange, size + most_beside);
}

double FixHistory::memory_usage() {
  size_t numbers =
      page_.capacity() + pairs_.count() + (columns + 1) * held_.size() + dents_.capacity() + bodies_.capacity();
  for (const auto& held : held_) numbers += held.capacity();
  return static_cast<double>(numbers * sizeof(double));
}

}  // namespace epdem::lammps
