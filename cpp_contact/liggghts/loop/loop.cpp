// SPDX-License-Identifier: GPL-2.0-or-later
#include "loop.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include "atom_vec.h"
#include "force.h"
#include "kernels/gather.hpp"
#include "modify.h"
#include "normal.hpp"

namespace epdem::liggghts {

const kernels::SphereKernels* sphere_kernels(LAMMPS_NS::LAMMPS* lmp) { return &loop::state_of(lmp).kernels.spheres; }

namespace loop {

using namespace LIGGGHTS::ContactModels;
using LAMMPS_NS::PairGran;

bool generic_loop(LAMMPS_NS::LAMMPS* lmp) {
  const char* const loop = std::getenv("EPDEM_LOOP");
  if (!loop || !*loop) return false;
  if (std::strcmp(loop, "generic") == 0) return true;
  const std::string text = "EPDEM_LOOP = " + std::string(loop) + ": no such loop; leave it unset, or take generic";
  lmp->error->all(FLERR, text.c_str());
  return true;
}

constexpr int ROOM = 10000;  // spheres, as LIGGGHTS's own steps of growth

LoopState& state_of(LAMMPS_NS::LAMMPS* lmp) {
  auto& loops = Simulation::of(lmp).loops;
  if (loops) return *loops;
  std::string refusal;
  const Kernels* const kernels = chosen_kernels(refusal);
  if (!kernels) lmp->error->all(FLERR, refusal.c_str());
  // The second fix insert of a step reads spheres past the end of arrays that read_data made as long as needed.
  if (LAMMPS_NS::Atom* const atom = lmp->atom; atom->nmax > 0 && atom->nmax < ROOM) atom->avec->grow(ROOM);
  loops = std::make_shared<LoopState>(LoopState{generic_loop(lmp), *kernels});
  return *loops;
}

LoopState* active_loops(LAMMPS_NS::LAMMPS* lmp) {
  if (!library_matches(lmp)) return nullptr;
  const Simulation* const known = Simulation::find(lmp);
  return known && known->loops && !known->loops->generic ? known->loops.get() : nullptr;
}

const char* obstacle_of_both(const LAMMPS_NS::Atom& atom, bool rigid, bool stores, bool sums) {
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
  pass.work = plan.tally != nullptr;
  pass.holds = plan.tally && plan.tally->energy();
  pass.strain = plan.strain != nullptr;
  return pass;
}

void note_strain(LargestStrain& strain, const Block& b) {
  strain.note(b.i[0], largest_strain(b, 0), largest_strain(b, 1));
}

const char* PairLoop::obstacle(PairGran* pair, const Plan& plan, int vflag, int addflag) const {
  const bool stores = pair->storeContactForces() || pair->storeContactForcesStress();
  if (const char* why = obstacle_of_both(*atom, pair->fr_pair(), stores, pair->store_sum_normal_force())) return why;
  if (force->newton_pair) return "newton on";
  if (atom->molecular) return "bonded particles";
  if (pair->storeSumDelta()) return "surface multicontact";
  if (neighbor->contactDistanceFactor != 1.0 && !plan.gap.any()) return "contacts at a distance";
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
  plan.growth      ? gather<Reach::grown>(plan)
  : plan.gap.any() ? gather<Reach::attached>(plan)
                   : gather<Reach::touching>(plan);
}

/// With growth, pairs that cannot meet before LIGGGHTS makes the next lists are left out, until a sphere grows more.
void PairLoop::read_lists(const Growth* growth) {
  if (listed_ == neighbor->lastcall && (!growth || growth->factor() <= listed_factor_)) return;
  passed_ = -1;
  const bool narrows = growth && listed_ != neighbor->lastcall;
  listed_factor_ = narrows ? growth->factor_until_lists() : HUGE_VAL;
  listed_ = neighbor->lastcall;
  // no sphere moves farther than half of the skin from its place in the step of the lists
  const double way = listed_ == update->ntimestep ? neighbor->skin : 2.0 * neighbor->skin;
  const double *const radius = atom->radius, reach = std::sqrt(listed_factor_);
  const auto is_apart = [&](int i, int j) { return is_far(atom->x[i], atom->x[j], radius[i] + radius[j], reach, way); };
  const LAMMPS_NS::NeighList& list = *pair_->list;
  pairs_.clear(atom->nlocal);
  slots_.clear();
  for (int ii = 0; ii < list.inum; ++ii) {
    const int i = list.ilist[ii];
    pairs_.begin(i);
    for (int jj = 0; jj < list.numneigh[i]; ++jj) {
      const int j = list.firstneigh[i][jj] & NEIGHMASK;
      if (narrows && is_apart(i, j)) continue;
      pairs_.add(i, j);
      slots_.push_back(jj);
    }
  }
  pairs_.close();
}

/// LIGGGHTS's own loop may have run in the step before: its marks say which pairs were in contact.
void PairLoop::begin_pass() {
  const auto marked = [&](int place) {
    return pair_->listgranhistory->firstneigh[pairs_.i(place)][slots_[place]] != 0;
  };
  if (passed_ != update->ntimestep - 1) pairs_.recall(marked);
  passed_ = update->ntimestep;
  pairs_.begin_pass();
}

/// Has all pairs computed that overlap, with adhesion the pairs that are attached across a gap, with growth the pairs
/// whose gap it closes; other near pairs lose their mark.
template <Reach reach>
void PairLoop::gather(const Plan& plan) {
  read_lists(plan.growth);
  if constexpr (reach == Reach::grown) begin_pass();
  const SphereKernels& kernels = *plan.spheres;
  const auto search = [&](double factor) { return pairs_.search(pass_.x, atom->radius, factor, pass_.sums); };
  const auto compute_block = [&](int n) { finish<reach>(plan, n); };
  if constexpr (reach == Reach::touching) return each_overlap(kernels, search(1.0), *block_, place_, compute_block);
  const double apart = neighbor->contactDistanceFactor;
  const auto stands = [&](int i, int j, int place) {
    const int slot = slots_[place];
    int& flag = pair_->listgranhistory->firstneigh[i][slot];
    if ((reach == Reach::grown || flag != 0) && stands_across_gap(plan, i, j, slot, flag != 0)) return true;
    flag &= ~flags_;
    return false;
  };
  const double factor = reach == Reach::grown ? plan.growth->factor() : apart * apart;
  each_contact(kernels, search(factor), *block_, place_, stands, compute_block);
}

template <Reach reach>
void PairLoop::finish(const Plan& plan, int n) {
  if (n == 0) return;
  if constexpr (reach == Reach::grown) pairs_.note(place_, n);
  fetch(plan, n);
  if (plan.judge) judge(plan, n);
  pad(*block_, n);
  plan.kernel(*block_, n, pass_);
  if (plan.strain) note_strain(*plan.strain, *block_);
  const bool turns = plan.friction || plan.settings.rolling;
  if (plan.tally)
    turns ? scatter<true, true, reach>(plan, n) : scatter<false, true, reach>(plan, n);
  else
    turns ? scatter<true, false, reach>(plan, n) : scatter<false, false, reach>(plan, n);
  if (plan.tally && plan.adds_friction) add_friction(*plan.tally, n);
  if (plan.heat) plan.heat->sums().add_pairs(*block_, n);
}

void PairLoop::judge(const Plan& plan, int n) const {
  const Block& b = *block_;
  const int k = first_below(b, n, pass_.several, false, plan.constants.data(), plan.judge->least().data());
  if (k >= 0) plan.judge->refuse_contact(b.i[k], b.j[k], atom->type[b.j[k]]);
}

/// A pair without a mark is new: its history is not read.
bool PairLoop::stands_across_gap(const Plan& plan, int i, int j, int slot, bool marked) const {
  const double* h = marked ? pair_->listgranhistory->firstdouble[i] + pair_->dnum() * slot : nullptr;
  if (h && pass_.now - h[plan.last_step] > 1.0) h = nullptr;
  return exists(plan.gap, h, gap_of(pass_, atom->radius, i, j), false);
}

/// Gathers n contacts and marks them in LIGGGHTS's list.
void PairLoop::fetch(const Plan& plan, int n) {
  Block& b = *block_;
  const int size = pair_->dnum(), marked = flags_;
  int** const flags = pair_->listgranhistory ? pair_->listgranhistory->firstneigh : nullptr;
  double** const histories = pair_->listgranhistory ? pair_->listgranhistory->firstdouble : nullptr;
  const int* const slots = slots_.data();
  const auto history = [=, &b](long i, int k) {
    if (!histories) return;
    const int slot = slots[place_[k]];
    double* const h = histories[i] + size * slot;
    __builtin_prefetch(h, 1);
    for (int line = 8; line < size - 8; line += 8) __builtin_prefetch(h + line, 1);
    __builtin_prefetch(h + size - 1, 1);
    b.history[k] = h;
    int& flag = flags[i][slot];
    if (flag != marked) flag |= marked;
  };
  const Spheres spheres{atom->f[0], atom->torque[0],          atom->radius, atom->rmass, atom->type,
                        atom->mask, pair_->freeze_group_bit()};
  gather_pairs(b, pass_, n, spheres, {plan.constants.data(), plan.width, mixed_}, history);
}

namespace {

/// Two sums at once: a single number that is stored is not yet there for a copy of several.
typedef double Two __attribute__((vector_size(16)));

/// Beside forces: each body of a pair gets half of the energies, and one loaded contact; with growth the depths of its
/// dents.
template <bool tallies, bool adheres, bool grown>
struct Beside {
  const Block& b;
  double* const dents;
  double *const work, *const energy, *const loaded, *const parted;
  const bool gives_back;
  double work_i{}, energy_i{}, loaded_i{};
  Two dents_i[dent_sums / 2] = {};
  long i = 0;
  double* const others;  // numbers of a ghost, which its owner computes; apart: the sums stay in registers

  Beside(const Block& block, const Plan& plan, double* ghost)
      : b(block),
        dents(grown ? plan.growth->sums() : nullptr),
        work(tallies ? plan.tally->work() : nullptr),
        energy(tallies ? plan.tally->energy() : nullptr),
        loaded(tallies ? plan.tally->loaded() : nullptr),
        parted(tallies ? plan.tally->adhesive() : nullptr),
        gives_back(tallies && plan.tally->gives_back()),
        others(ghost) {}

  EPDEM_INLINE void begin(long body) {
    i = body;
    if constexpr (tallies) {
      work_i = work[i];
      if (energy && loaded) energy_i = energy[i], loaded_i = loaded[i];
    }
    if constexpr (grown)
      for (int c = 0; c < dent_sums; c += 2) dents_i[c / 2] = load<Two>(dents + dent_sums * i + c);
  }

  EPDEM_INLINE void add(int k, long j, bool owned) {
    if constexpr (tallies) {
      const double lost = b.plastic_work_step.a[k] > 0.0 || gives_back ? 0.5 * b.plastic_work_step.a[k] : 0.0;
      work_i += lost;
      *(owned ? work + j : others) += lost;
      if (energy && loaded) {
        const double stored = 0.5 * b.stored_energy.a[k];
        const bool bears = b.contact_radius.a[k] > 0.0;
        energy_i += stored;
        loaded_i += bears;
        *(owned ? energy + j : others + 1) += stored;
        *(owned ? loaded + j : others + 2) += bears;
      }
      if (adheres && parted) {
        parted[i] += 0.5 * b.adhesion_loss.a[k];
        *(owned ? parted + j : others + 3) += 0.5 * b.adhesion_loss.a[k];
      }
    }
    if constexpr (grown) {
      double* const dents_j = owned ? dents + dent_sums * j : others + 4;
      for (int c = 0; c < dent_sums; c += 2) {
        dents_i[c / 2] += Two{b.dents_i[c].a[k], b.dents_i[c + 1].a[k]};
        store(dents_j + c, load<Two>(dents_j + c) + Two{b.dents_j[c].a[k], b.dents_j[c + 1].a[k]});
      }
    }
  }

  EPDEM_INLINE void end(long) {
    if constexpr (tallies) {
      work[i] = work_i;
      if (energy && loaded) energy[i] = energy_i, loaded[i] = loaded_i;
    }
    if constexpr (grown)
      for (int c = 0; c < dent_sums; c += 2) store(dents + dent_sums * i + c, dents_i[c / 2]);
  }
};

}  // namespace

/// Adds forces and torques in the order of the list.
template <bool torques, bool tallies, Reach reach>
void PairLoop::scatter(const Plan& plan, int n) {
  double ghost[4 + dent_sums] = {};
  Beside<tallies, reach != Reach::touching, reach == Reach::grown> beside(*block_, plan, ghost);
  scatter_pairs<torques>(*block_, n, atom->f[0], atom->torque[0], atom->nlocal, beside);
}

/// The work of friction with partial slip, in the order of the list.
void PairLoop::add_friction(EnergyTally& tally, int n) {
  const Block& b = *block_;
  for (int k = 0; k < n; ++k)
    tally.add_friction(false, b.friction_work.a[k], b.spring_energy.a[k], {b.i[k], b.j[k], atom->nlocal});
}

}  // namespace loop
}  // namespace epdem::liggghts
