// SPDX-License-Identifier: GPL-2.0-or-later
#include "loop.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include "force.h"
#include "kernels/gather.hpp"
#include "modify.h"

namespace epdem::liggghts::loop {

using namespace LIGGGHTS::ContactModels;
using LAMMPS_NS::PairGran;

const Kernels& chosen_kernels(LAMMPS_NS::LAMMPS* lmp) {
  const char* const named = std::getenv("EPDEM_SIMD");
  const Kernels* const found = kernels_of(named ? named : "");
  if (!found) {
    const std::string text = std::string("EPDEM_SIMD = ") + named +
                             ": this processor has no such instructions; leave it unset, or "
                             "take sse2, avx2 or avx512";
    lmp->error->all(FLERR, text.c_str());
  }
  return *found;
}

const SphereKernels& sphere_kernels(LAMMPS_NS::LAMMPS* lmp) {
  static const SphereKernels& found = chosen_kernels(lmp).spheres;
  return found;
}

bool generic_loop() {
  static const char* const loop = std::getenv("EPDEM_LOOP");
  return loop && std::strcmp(loop, "generic") == 0;
}

void refuse_unknown_loop(LAMMPS_NS::LAMMPS* lmp) {
  const char* const loop = std::getenv("EPDEM_LOOP");
  if (!loop || !*loop || generic_loop()) return;
  const std::string text = "EPDEM_LOOP = " + std::string(loop) + ": no such loop; leave it unset, or take generic";
  lmp->error->all(FLERR, text.c_str());
}

const char* obstacle_of_both(const LAMMPS_NS::Atom& atom, bool rigid, bool stores, bool sums) {
  if (generic_loop()) return "EPDEM_LOOP = generic";
  if (rigid) return "rigid bodies";
  if (!atom.rmass || !atom.sphere_flag || atom.shapetype_flag) return "particles other than spheres";
  if (stores) return "contact forces are stored";
  return sums ? "normal forces are summed up" : nullptr;
}

bool beside_the_steps(const LAMMPS_NS::Atom& atom, bool computes, bool shears) {
  return !computes || !shears || atom.nlocal + atom.nghost >= atom.nmax;
}

Pass pass_of(const LAMMPS_NS::Atom& atom, const Plan& plan, double dt) {
  Pass pass{};
  pass.x = atom.x[0];
  pass.v = atom.v[0];
  pass.omega = atom.omega[0];
  static_cast<ContactSettings&>(pass) = plan.settings;
  pass.dt = dt;
  pass.work = plan.ledger != nullptr;
  pass.strain = plan.strain != nullptr;
  return pass;
}

void note_strain(LargestStrain& strain, const Block& b) {
  strain.note(b.i[0], *std::max_element(b.radius_ratio, b.radius_ratio + most_lanes),
              *std::max_element(b.overlap_ratio, b.overlap_ratio + most_lanes));
}

const char* PairLoop::obstacle(PairGran* pair, const Plan& plan, int vflag, int addflag) const {
  const bool stores = pair->storeContactForces() || pair->storeContactForcesStress();
  if (const char* why = obstacle_of_both(*atom, pair->fr_pair(), stores, pair->store_sum_normal_force())) return why;
  if (force->newton_pair) return "newton on";
  if (atom->molecular) return "bonded particles";
  if (pair->storeSumDelta()) return "surface multicontact";
  if (neighbor->contactDistanceFactor != 1.0 && plan.root < 0 && !plan.growth) return "contacts at a distance";
  if (modify->n_fixes_style("insert/stream/predefined") > 0) return "fix insert/stream/predefined";
  if (vflag) return "steps that ask for the virial";
  if (addflag) return "steps of compute pair/gran/local";
  return beside_the_steps(*atom, pair->computeflag(), pair->shearupdate()) ? "" : nullptr;
}

void PairLoop::run(PairGran* pair, const Plan& plan, double now) {
  if (atom->nlocal == 0) return;
  pair_ = pair;
  pass_ = pass_of(*atom, plan, update->dt);
  pass_.now = now;
  pass_.freeze = pair->freeze_group_bit() != 0;
  pass_.sums = plan.growth ? plan.growth->of_all() : nullptr;
  mixed_ = plan.width > 2 && several_types(atom->type, atom->nlocal + atom->nghost);
  flags_ = CONTACT_NORMAL_MODEL | (plan.friction ? CONTACT_TANGENTIAL_MODEL : 0) |
           (plan.settings.cohesion ? CONTACT_COHESION_MODEL : 0) | (plan.rolls ? CONTACT_ROLLING_MODEL : 0);
  plan.growth     ? gather<Reach::grown>(plan)
  : plan.root < 0 ? gather<Reach::touching>(plan)
                  : gather<Reach::attached>(plan);
}

/// The pairs of LIGGGHTS's lists side by side in memory.
void PairLoop::read_lists() {
  if (listed_ == neighbor->lastcall) return;
  listed_ = neighbor->lastcall;
  const LAMMPS_NS::NeighList& list = *pair_->list;
  i_.clear();
  j_.clear();
  first_.resize(atom->nlocal);
  for (int ii = 0; ii < list.inum; ++ii) {
    const int i = list.ilist[ii], count = list.numneigh[i];
    first_[i] = static_cast<int>(j_.size());
    i_.insert(i_.end(), count, i);
    for (int jj = 0; jj < count; ++jj) j_.push_back(list.firstneigh[i][jj] & NEIGHMASK);
  }
  for (std::vector<int>* spheres : {&i_, &j_}) spheres->insert(spheres->end(), most_lanes, 0);
}

/// Writes into the block the pairs that overlap, with adhesion the pairs that are near, with growth also the pairs
/// whose gap it closes.
template <Reach reach>
void PairLoop::gather(const Plan& plan) {
  static_assert(2 * pairs_at_once <= block_size);
  read_lists();
  Block& b = *block_;
  PairSearch search{pass_.x, atom->radius, 1.0, i_.data(), j_.data(), static_cast<int>(j_.size()) - most_lanes};
  if (reach == Reach::attached) search.factor = neighbor->contactDistanceFactor * neighbor->contactDistanceFactor;
  if (reach == Reach::grown) search.factor = plan.growth->factor();
  const SphereKernels& kernels = sphere_kernels(lmp);
  const auto next_pairs = reach == Reach::grown ? kernels.next_near_pairs : kernels.next_pairs;
  int n = 0;
  while (search.tested < search.count) {
    const int found = next_pairs(search, b.i + n, b.j + n, slot_ + n);
    if constexpr (reach == Reach::grown)
      n += without_gaps(plan, n, found);
    else
      for (const int last = n + found; n < last; ++n) slot_[n] -= first_[b.i[n]];
    if (n <= block_size - pairs_at_once) continue;
    finish<reach>(plan, n);
    n = 0;
  }
  finish<reach>(plan, n);
}

template <Reach reach>
void PairLoop::finish(const Plan& plan, int n) {
  constexpr bool adheres = reach == Reach::attached, grown = reach == Reach::grown;
  if constexpr (adheres) n = without_parted(plan, n);
  if (n == 0) return;
  fetch(plan, n);
  pad(*block_, n);
  (grown ? plan.grown : kernel_)(*block_, n, pass_);
  if (plan.strain) note_strain(*plan.strain, *block_);
  const bool turns = plan.friction || plan.settings.rolling;
  if (plan.ledger)
    turns ? scatter<true, true, reach>(plan, n) : scatter<false, true, reach>(plan, n);
  else
    turns ? scatter<true, false, reach>(plan, n) : scatter<false, false, reach>(plan, n);
  if (plan.ledger && plan.books_friction) book_friction(*plan.ledger, n);
}

/// Keeps the contacts that overlap or are attached across a gap and returns their number; other pairs lose their mark.
int PairLoop::without_parted(const Plan& plan, int n) {
  Block& b = *block_;
  const int size = pair_->dnum();
  const double *const x = atom->x[0], *const radius = atom->radius;
  int kept = 0;
  for (int k = 0; k < n; ++k) {
    const int i = b.i[k], j = b.j[k], slot = slot_[k];
    const double dx = x[3 * i] - x[3 * j], dy = x[3 * i + 1] - x[3 * j + 1], dz = x[3 * i + 2] - x[3 * j + 2];
    const double sum = radius[i] + radius[j];
    if (!(dx * dx + dy * dy + dz * dz < sum * sum)) {
      if (pair_->listgranhistory->firstneigh[i][slot] == 0) continue;
      const double* const h = pair_->listgranhistory->firstdouble[i] + size * slot;
      if (!(h[plan.root] > 0.0) || pass_.now - h[plan.last_step] > 1.0) {
        pair_->listgranhistory->firstneigh[i][slot] &= ~flags_;
        continue;
      }
    }
    b.i[kept] = i;
    b.j[kept] = j;
    slot_[kept++] = slot;
  }
  return kept;
}

/// Of the `found` pairs behind the first n, keeps the pairs that overlap or whose growth closes a gap, and returns the
/// number of kept pairs; other pairs lose their mark.
int PairLoop::without_gaps(const Plan& plan, int n, int found) {
  Block& b = *block_;
  int kept = n;
  for (int k = n; k < n + found; ++k) {
    const int i = b.i[k], j = b.j[k], place = slot_[k], slot = (place < 0 ? ~place : place) - first_[i];
    if (place < 0 && !closes_gap(plan, i, j, slot)) continue;
    b.i[kept] = i;
    b.j[kept] = j;
    slot_[kept++] = slot;
  }
  return kept - n;
}

/// Whether growth closes the gap of a pair; else the pair loses its mark.
bool PairLoop::closes_gap(const Plan& plan, int i, int j, int slot) {
  const double *const x = atom->x[0], *const radius = atom->radius;
  const double dx = x[3 * i] - x[3 * j], dy = x[3 * i + 1] - x[3 * j + 1], dz = x[3 * i + 2] - x[3 * j + 2];
  const double rsq = dx * dx + dy * dy + dz * dz;
  const double* const h = pair_->listgranhistory->firstdouble[i] + pair_->dnum() * slot;
  const bool is_new = pass_.now - h[plan.last_step] > 1.0;
  const auto c = growing_pair(radius[i], radius[j], sums_of(pass_.sums, i), sums_of(pass_.sums, j),
                              is_new ? nullptr : h + pair_->dnum() - growth_values);
  if (epdem::closes_gap(c, rsq, false)) return true;
  pair_->listgranhistory->firstneigh[i][slot] &= ~flags_;
  return false;
}

/// Gathers n contacts and marks them in LIGGGHTS's list.
void PairLoop::fetch(const Plan& plan, int n) {
  Block& b = *block_;
  const int size = pair_->dnum(), marked = flags_, *const slot = slot_;
  int** const flags = pair_->listgranhistory ? pair_->listgranhistory->firstneigh : nullptr;
  double** const histories = pair_->listgranhistory ? pair_->listgranhistory->firstdouble : nullptr;
  const auto history = [=, &b](long i, int k) {
    if (!histories) return;
    double* const h = histories[i] + size * slot[k];
    __builtin_prefetch(h, 1);
    for (int line = 8; line < size - 8; line += 8) __builtin_prefetch(h + line, 1);
    __builtin_prefetch(h + size - 1, 1);
    b.history[k] = h;
    int& flag = flags[i][slot[k]];
    if (flag != marked) flag |= marked;
  };
  const Spheres spheres{atom->f[0], atom->torque[0],          atom->radius, atom->rmass, atom->type,
                        atom->mask, pair_->freeze_group_bit()};
  gather_pairs(b, pass_, n, spheres, {plan.constants.data(), plan.width, mixed_}, history);
}

/// Adds forces and torques in the order of the list; the sums of body i stay in registers while its pairs follow each
/// other. books: each body of a pair gets half of the energies, and one loaded contact. Grown spheres also get the
/// depths of their dents.
template <bool torques, bool books, Reach reach>
void PairLoop::scatter(const Plan& plan, int n) {
  constexpr bool adheres = reach == Reach::attached, grown = reach == Reach::grown;
  const Block& b = *block_;
  Ledger* const ledger = plan.ledger;
  double* const dents = grown ? plan.growth->sums() : nullptr;
  double *const f = atom->f[0], *const t = atom->torque[0];
  double *const work = books ? ledger->work() : nullptr, *const energy = books ? ledger->energy() : nullptr;
  double *const loaded = books ? ledger->loaded() : nullptr, *const parted = books ? ledger->adhesive() : nullptr;
  const bool gives_back = books && ledger->gives_back();
  const int nlocal = atom->nlocal;
  double others[13] = {};  // what a ghost gets is computed by its owner
  for (int k = 0; k < n;) {
    const int i = b.i[k];
    double *const fi = f + 3 * i, *const ti = t + 3 * i;
    double fx = fi[0], fy = fi[1], fz = fi[2], tx = ti[0], ty = ti[1], tz = ti[2];
    double work_i{}, energy_i{}, loaded_i{}, cover_i{}, volume_i{}, area_i{};
    if constexpr (books) work_i = work[i], energy_i = energy[i], loaded_i = loaded[i];
    if constexpr (grown) cover_i = dents[3 * i], volume_i = dents[3 * i + 1], area_i = dents[3 * i + 2];
    do {
      const int j = b.j[k];
      const bool ours = j < nlocal;
      double* const fj = ours ? f + 3 * j : others;
      const double gx = b.force[0].a[k], gy = b.force[1].a[k], gz = b.force[2].a[k];
      fx += gx;
      fy += gy;
      fz += gz;
      fj[0] -= gx;
      fj[1] -= gy;
      fj[2] -= gz;
      if constexpr (torques) {
        double* const tj = ours ? t + 3 * j : others + 3;
        tx += b.torque_i[0].a[k];
        ty += b.torque_i[1].a[k];
        tz += b.torque_i[2].a[k];
        tj[0] += b.torque_j[0].a[k];
        tj[1] += b.torque_j[1].a[k];
        tj[2] += b.torque_j[2].a[k];
      }
      if constexpr (books) {
        const double grown = b.plastic_work_step.a[k] > 0.0 || gives_back ? 0.5 * b.plastic_work_step.a[k] : 0.0,
                     stored = 0.5 * b.stored_energy.a[k];
        const bool bears = adheres ? b.contact_radius.a[k] > 0.0 : stored > 0.0;
        work_i += grown;
        energy_i += stored;
        loaded_i += bears;
        *(ours ? work + j : others + 6) += grown;
        *(ours ? energy + j : others + 7) += stored;
        *(ours ? loaded + j : others + 8) += bears;
        if constexpr (adheres) {
          parted[i] += 0.5 * b.adhesion_loss.a[k];
          *(ours ? parted + j : others + 9) += 0.5 * b.adhesion_loss.a[k];
        }
      }
      if constexpr (grown) {
        cover_i += b.cover_i.a[k];
        volume_i += b.volume_i.a[k];
        area_i += b.dented_area.a[k];
        double* const dents_j = ours ? dents + 3 * j : others + 10;
        dents_j[0] += b.cover_j.a[k];
        dents_j[1] += b.volume_j.a[k];
        dents_j[2] += b.dented_area.a[k];
      }
      ++k;
    } while (k < n && b.i[k] == i);
    fi[0] = fx;
    fi[1] = fy;
    fi[2] = fz;
    if constexpr (torques) {
      ti[0] = tx;
      ti[1] = ty;
      ti[2] = tz;
    }
    if constexpr (books) work[i] = work_i, energy[i] = energy_i, loaded[i] = loaded_i;
    if constexpr (grown) dents[3 * i] = cover_i, dents[3 * i + 1] = volume_i, dents[3 * i + 2] = area_i;
  }
}

/// The work of friction with partial slip, in the order of the list.
void PairLoop::book_friction(Ledger& ledger, int n) {
  const Block& b = *block_;
  for (int k = 0; k < n; ++k)
    ledger.book_friction(false, b.friction_work.a[k], b.spring_energy.a[k], {b.i[k], b.j[k], atom->nlocal});
}

}  // namespace epdem::liggghts::loop
