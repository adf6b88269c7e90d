// SPDX-License-Identifier: GPL-2.0-or-later
#include "pair_ep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "epdem/adhesive.hpp"
#include "epdem/compaction.hpp"
#include "epdem/sub_models.hpp"
#include "error.h"
#include "force.h"
#include "kernels/gather.hpp"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"
#include "utils.h"

namespace epdem::lammps {

using namespace LAMMPS_NS;
using kernels::block_size, kernels::most_constants;

namespace {

constexpr const char* placeholder = "_PLACE";

/// The first ID EP_HISTORY + number that no fix has.
std::string free_id(const Modify& modify) {
  for (int k = 0;; ++k) {
    const std::string id = FixHistory::style_name + std::to_string(k);
    if (!modify.get_fix_by_id(id) && !modify.get_fix_by_id(id + placeholder)) return id;
  }
}

std::vector<char*> words_of_text(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  return pointers;
}

}  // namespace

/// A fix in place of the history's keeps the history before the fixes of the deck: those may add atoms.
PairEp::PairEp(LAMMPS* lmp) : Pair(lmp), block_(std::make_unique<kernels::Block>()) {
  single_extra = 12;
  svector = single_;
  no_virial_fdotr_compute = 1;
  centroidstressflag = CENTROID_NOTAVAIL;
  finitecutflag = 1;
  if (domain->box_exist == 0) error->all(FLERR, "pair_style ep: there is no simulation box; create it before");
  fix_id_ = free_id(*modify);
  modify->add_fix(fix_id_ + placeholder + " all DUMMY");
}

PairEp::~PairEp() {
  for (const std::string& fix : {fix_id_, fix_id_ + placeholder})
    if (modify->get_fix_by_id(fix)) modify->delete_fix(fix);
  if (!allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
}

void PairEp::settings(int count, char** word) {
  energies_ = holds_ = strain_ = false;
  for (int k = 0; k < count; ++k) {
    const std::string setting = word[k];
    if (setting != "energies" && setting != "works" && setting != "strain")
      error->all(FLERR, "pair_style ep: {} is no setting of the style; there are energies, works and strain", setting);
    (setting == "strain" ? strain_ : energies_) = true;
    holds_ |= setting == "energies";
  }
  create_history();  // computes of the deck may name the fix
}

/// Not before the fixes of a restart file are known.
void PairEp::create_history() {
  Fix* fix = modify->get_fix_by_id(fix_id_);
  const std::string command = fix_id_ + " all " + FixHistory::style_name + (energies_ ? " energies" : "");
  if (!fix && modify->get_fix_by_id(fix_id_ + placeholder)) fix = modify->replace_fix(fix_id_ + placeholder, command);
  if (!fix) fix = modify->add_fix(command);
  history_ = static_cast<FixHistory*>(fix);
}

void PairEp::allocate() {
  allocated = 1;
  width_ = atom->ntypes + 1;
  memory->create(setflag, width_, width_, "pair:setflag");
  memory->create(cutsq, width_, width_, "pair:cutsq");
  std::fill_n(setflag[0], width_ * width_, 0);
  types_.assign(width_ * width_, {});
}

void PairEp::coeff(int count, char** word) {
  if (count < 3) error->all(FLERR, "pair_coeff: the words are I J LAW E nu PARAMETERS [options]");
  if (!allocated) allocate();
  int i_low, i_high, j_low, j_high;
  utils::bounds_typelabel(FLERR, word[0], 1, atom->ntypes, i_low, i_high, lmp, Atom::ATOM);
  utils::bounds_typelabel(FLERR, word[1], 1, atom->ntypes, j_low, j_high, lmp, Atom::ATOM);
  if (i_low > j_high)
    error->all(FLERR, "pair_coeff {} {}: the first type is above the second; exchange them", word[0], word[1]);
  std::string text;
  for (int k = 2; k < count; ++k) text += std::string(k > 2 ? " " : "") + word[k];
  for (int i = i_low; i <= i_high; ++i)
    for (int j = std::max(i, j_low); j <= j_high; ++j) set_words(i, j, text);
}

void PairEp::set_words(int i, int j, const std::string& text) {
  std::vector<std::string> words = utils::split_words(text);
  std::vector<char*> pointers = words_of_text(words);
  const std::string place = "pair_coeff " + std::to_string(i) + " " + std::to_string(j);
  if (i == j && words.front() == "mixed")
    error->all(FLERR, "{}: mixed takes the materials of two types, and this is one; give LAW E nu PARAMETERS", place);
  types(i, j) = {text, read_words(lmp, place, static_cast<int>(pointers.size()), pointers.data())};
  setflag[i][j] = 1;
}

const Words& PairEp::words_of(int type, const std::string& place) const {
  if (!has_material(type))
    lmp->error->all(FLERR, "{}: spheres of type {} have no material; add pair_coeff {} {}", place, type, type, type);
  return types_[type * width_ + type].words;
}

void PairEp::init_style() {
  check_settings(lmp, "pair_style ep");
  if (!comm->ghost_velocity)
    error->all(FLERR, "pair_style ep: contacts need the velocities of ghost atoms; add comm_modify vel yes");
  models_ = {};
  bool damped = false;
  for (int i = 1; i < width_; ++i)
    for (int j = i; j < width_; ++j)
      if (!types(i, j).text.empty()) {
        const Words& words = types(i, j).words;
        models_ =
            common_models(lmp, "pair_coeff " + std::to_string(i) + " " + std::to_string(j), models_, words.models);
        damped |= words.coefficients.damped();
      }
  if (damped) refuse_rigid_bodies(lmp, "pair_style ep");
  if (!models_.law) error->all(FLERR, "pair_style ep: no pair_coeff names a law; give pair_coeff 1 1 LAW E nu ...");
  for (const bool complete : {false, true})
    kernel_[complete] = kernel_of(lmp, "pair_style ep", models_, false, complete);
  spheres_ = &kernels_of(lmp).spheres;
  layout_ = layout_of(models_, false);
  // lists by radius end at the skin, lists by type at the cutoff of init_one
  const int by_radius = models_.compaction ? NeighConst::REQ_DEFAULT : NeighConst::REQ_SIZE;
  neighbor->add_request(this, by_radius | NeighConst::REQ_NEWTON_OFF);

  create_history();
  history_->prepare(&list, layout_, models_);
  heat_ = FixHeat::of(*modify);

  const auto freezes = modify->get_fix_by_style("^freeze");
  frozen_ = freezes.empty() ? 0 : freezes[0]->groupbit;
  measure_radii();
  constants_.assign(width_ * width_ * most_constants, 0.0);
  judge_.begin(width_ * width_);
  pass_ = {};
}

/// The largest and smallest radius of each type; of those that fixes will add LAMMPS knows the largest, and the
/// smallest is taken as 0.
void PairEp::measure_radii() {
  std::vector<double> mine(width_, 0.0), least(width_, HUGE_VAL);
  const auto take = [&](int type, double smallest, double largest) {
    least[type] = std::min(least[type], smallest);
    mine[type] = std::max(mine[type], largest);
  };
  for (int i = 0; i < atom->nlocal; ++i) take(atom->type[i], atom->radius[i], atom->radius[i]);
  for (const char* style : {"^pour", "^deposit"})
    for (Fix* fix : modify->get_fix_by_style(style))
      for (int type = 1; type < width_; ++type) {
        int itype = type;
        if (void* radius = fix->extract("radius", itype)) take(type, 0.0, *static_cast<double*>(radius));
      }
  largest_.assign(width_, 0.0);
  smallest_.assign(width_, HUGE_VAL);
  MPI_Allreduce(least.data(), smallest_.data(), width_, MPI_DOUBLE, MPI_MIN, world);
  MPI_Allreduce(mine.data(), largest_.data(), width_, MPI_DOUBLE, MPI_MAX, world);
}

double PairEp::init_one(int i, int j) {
  const std::string place = "pair_coeff " + std::to_string(i) + " " + std::to_string(j);
  Material a, b;
  Coefficients common;
  const PairOfTypes& given = types(i, j);
  const bool is_mixed = given.text.empty() || given.text.rfind("mixed", 0) == 0;
  if (is_mixed) {
    const Words &like_i = words_of(i, place), &like_j = words_of(j, place);
    a = like_i.material;
    b = like_j.material;
    common = mixed(like_i.coefficients, like_j.coefficients);
  } else {
    a = b = given.words.material;
  }
  if (!given.text.empty()) common = given.words.coefficients;
  double* const constants = constants_.data() + most_constants * (i * width_ + j);
  double* const constants_ji = constants_.data() + most_constants * (j * width_ + i);
  put_constants(*models_.law, a, b, common, constants, i == j ? nullptr : constants_ji);
  pass_.damped |= constants[kernels::damping] > 0.0;
  pass_.viscous |= constants[kernels::dashpot] > 0.0;
  const double R_star = 0.5 * std::max(largest_[i], largest_[j]);
  const double least = 1.0 / (1.0 / smallest_[i] + 1.0 / smallest_[j]);
  judge_.note(j * width_ + i, *models_.law, constants, least);
  if (judge_.note(i * width_ + j, *models_.law, constants, least) && least > 0.0 && comm->me == 0)
    utils::logmesg(lmp, "epdem: {}: the run ends where the smallest spheres of these types meet: {}\n", place,
                   models_.law->refused_adhesion(constants + kernels::law_data, least));
  const double gap = checked_gap(lmp, place, *models_.law, constants, R_star);
  return (models_.compaction ? 1.0 + growth_reach : 1.0) * (largest_[i] + largest_[j]) + gap;
}

void PairEp::set_pass(bool counts) {
  const int atoms = atom->nlocal + atom->nghost;
  pass_.x = readable_rows(atom->x, atoms, atom->nmax, copies_[0]);
  pass_.v = readable_rows(atom->v, atoms, atom->nmax, copies_[1]);
  pass_.omega = readable_rows(atom->omega, atoms, atom->nmax, copies_[2]);
  pass_.dt = counts ? update->dt : no_time;
  pass_.repeats = !counts;
  pass_.rolling = models_.rolling;
  pass_.cohesion = models_.cohesion;
  pass_.now = history_->now();
  pass_.sums = models_.compaction ? history_->bodies() : nullptr;
  pass_.freeze = frozen_ != 0;
  pass_.strain = strain_;
}

/// LAMMPS computes forces once more before the first step of a run; this evaluation changes no history and moves no
/// spring.
void PairEp::compute(int eflag, int vflag) {
  ev_init(eflag, vflag);
  history_->resume();
  const bool counts = !update->setupflag;
  pass_.work = energies_ && counts;
  pass_.holds = holds_;
  if (pass_.work) history_->open_energies(atom->nlocal);
  if (heat_) heat_->open();
  if (models_.compaction) {
    history_->close_growth(counts, spheres_->close_sums);
    if (counts) history_->widen();
  }
  if (list->inum > 0) {
    std::vector<double> before;
    if (!counts) before = history_->page();
    set_pass(counts);
    gather();
    if (!counts) history_->page().swap(before);
  }
  if (counts) history_->advance();
}

/// Has all pairs of the list computed that overlap or stand across a gap.
void PairEp::gather() {
  kernels::PairList& pairs = history_->pairs();
  if (layout_.gap.growth >= 0 && !pass_.repeats) pairs.begin_pass();
  const auto compute_block = [this](int n) { finish(n); };
  const auto search = [&](double factor) { return pairs.search(pass_.x, atom->radius, factor, pass_.sums); };
  if (!layout_.gap.any()) return kernels::each_overlap(*spheres_, search(1.0), *block_, place_, compute_block);
  const double factor = layout_.gap.growth < 0 ? HUGE_VAL : history_->factor();
  const auto across_gap = [this](int i, int j, int place) { return stands(i, j, history_->at(place)); };
  kernels::each_contact(*spheres_, search(factor), *block_, place_, across_gap, compute_block);
}

/// Whether two spheres that do not overlap are in contact: attached, or grown across the gap. A step that is evaluated
/// once more has the attachment and the growth that it had.
bool PairEp::stands(int i, int j, const double* history) const {
  const bool known = history && pass_.now - history[layout_.last_step] <= 1.0;
  return exists(layout_.gap, known ? history : nullptr, kernels::gap_of(pass_, atom->radius, i, j), pass_.repeats);
}

/// Fills the block with n > 0 pairs; history_at(k) is the history of pair k.
template <class HistoryAt>
void PairEp::fetch(int n, HistoryAt history_at) {
  kernels::Block& b = *block_;
  const int values = layout_.values;
  const auto history = [&](long, int k) {
    if (values == 0) return;
    double* const h = b.history[k] = history_at(k);
    for (int line = 0; line < values; line += 8) __builtin_prefetch(h + line, 1);
  };
  const kernels::Spheres spheres{atom->f[0], atom->torque[0], atom->radius, atom->rmass,
                                 atom->type, atom->mask,      frozen_};
  kernels::gather_pairs(b, pass_, n, spheres, {constants_.data(), width_, width_ > 2}, history);
  kernels::pad(b, n);
}

void PairEp::finish(int n) {
  if (n == 0) return;
  kernels::Block& b = *block_;
  fetch(n, [&](int k) { return history_->at(place_[k]); });
  judge_.judge(lmp, "pair_style ep", *models_.law, b, n, pass_.several, false, constants_.data());
  kernel_[pass_.work || pass_.repeats](b, n, pass_);
  if (strain_) history_->note_strain(b);
  if (models_.compaction) {
    history_->pairs().note(place_, n);
    history_->note_dents(b, n, false);
  }
  const auto scatter = [&](auto beside) {
    kernels::scatter_pairs<true>(b, n, atom->f[0], atom->torque[0], atom->nlocal, beside);
  };
  if (pass_.work) {
    if (holds_)
      scatter(history_->half_energies<3>(b, models_));
    else
      scatter(history_->half_energies<1>(b, models_));
    history_->add_works(b, n, models_, false);
    if (heat_) heat_->add_pairs(b, n);
  } else {
    scatter(kernels::NothingBeside{});
  }
  if (vflag_either) tally(n);
}

/// Virials. A fix ave/time that samples each step makes LAMMPS request the global virial of each step, which is
/// therefore summed up here, by the operations of ev_tally_xyz.
void PairEp::tally(int n) {
  const kernels::Block& b = *block_;
  double** const x = atom->x;
  for (int k = 0; k < n; ++k) {
    const double *const xi = x[b.i[k]], *const xj = x[b.j[k]];
    const double d[3] = {xi[0] - xj[0], xi[1] - xj[1], xi[2] - xj[2]};
    const double F[3] = {b.force[0].a[k], b.force[1].a[k], b.force[2].a[k]};
    if (vflag_atom) {
      ev_tally_xyz(b.i[k], b.j[k], atom->nlocal, 0, 0.0, 0.0, F[0], F[1], F[2], d[0], d[1], d[2]);
      continue;
    }
    const double v[6] = {d[0] * F[0], d[1] * F[1], d[2] * F[2], d[0] * F[1], d[0] * F[2], d[1] * F[2]};
    for (int c = 0; c < 6; ++c) virial[c] += 0.5 * v[c];
    if (b.j[k] >= atom->nlocal) continue;
    for (int c = 0; c < 6; ++c) virial[c] += 0.5 * v[c];
  }
}

/// The history of a contact at the list; null: none.
double* PairEp::history_of(int i, int j) const {
  for (const auto& [one, other] : {std::pair{i, j}, std::pair{j, i}}) {
    const int place = one < atom->nlocal ? history_->pairs().find(one, other) : -1;
    if (place >= 0) return history_->at(place);
  }
  return nullptr;
}

double PairEp::single(int i, int j, int, int, double rsq, double, double, double& fforce) {
  fforce = 0.0;
  std::fill_n(single_, 12, 0.0);
  const double sum = atom->radius[i] + atom->radius[j], r = std::sqrt(rsq), overlap = sum - r;
  const double* const known = layout_.values > 0 && history_->at_list() ? history_of(i, j) : nullptr;
  const bool recent = known && history_->now() - known[layout_.last_step] <= 1.0;
  set_pass(false);
  const bool attached = recent && ((layout_.gap.root >= 0 && known[layout_.gap.root] > 0.0) ||
                                   (layout_.gap.growth >= 0 && stands(i, j, known)));
  if (overlap <= 0.0 && !attached) return 0.0;
  std::vector<double> history(std::max(1, layout_.values), 0.0);
  if (known) std::copy_n(known, layout_.values, history.data());

  pass_.work = pass_.holds = true;
  pass_.strain = false;
  kernels::Block& b = *block_;
  b.i[0] = i;
  b.j[0] = j;
  fetch(1, [&](int) { return history.data(); });
  kernel_[true](b, 1, pass_);
  const double *const xi = atom->x[i], *const xj = atom->x[j];
  for (int axis = 0; axis < 3; ++axis) fforce += b.force[axis].a[0] * (xi[axis] - xj[axis]) / rsq;
  single_[0] = overlap;
  if (layout_.gap.growth >= 0) single_[11] = retreat_of(history.data() + layout_.gap.growth);
  single_[1] = models_.law->most < 0 ? overlap : std::max(overlap - single_[11], history[models_.law->most]);
  single_[2] = b.contact_radius.a[0];
  single_[3] = layout_.gap.root < 0 || history[layout_.gap.root] > 0.0;
  if (models_.cohesion == bond_place) single_[3] = !broken_of(history.data() + layout_.gap.growth);
  if (layout_.gap.growth >= 0) {
    single_[4] = added_overlap_of(history.data() + layout_.gap.growth);
    single_[5] = screening_of(history.data() + layout_.gap.growth);
    single_[9] = grown_overlap_of(history.data() + layout_.gap.growth);
    single_[10] = body_pressure_of(history.data() + layout_.gap.growth);
  }
  for (int axis = 0; axis < 3; ++axis) single_[6 + axis] = b.force[axis].a[0];
  return b.stored_energy.a[0];
}

void PairEp::write_restart(FILE* file) {
  if (comm->me != 0) return;
  const int settings = energies_ + 2 * strain_ + 4 * holds_;
  fwrite(&settings, sizeof settings, 1, file);
  for (int i = 1; i < width_; ++i)
    for (int j = i; j < width_; ++j) {
      const std::string& text = types(i, j).text;
      const int size = static_cast<int>(text.size());
      fwrite(&size, sizeof size, 1, file);
      fwrite(text.data(), 1, size, file);
    }
}

void PairEp::read_restart(FILE* file) {
  allocate();
  const auto read = [&](void* to, int bytes) {
    if (comm->me == 0) utils::sfread(FLERR, to, 1, bytes, file, nullptr, error);
    MPI_Bcast(to, bytes, MPI_CHAR, 0, world);
  };
  int settings;
  read(&settings, sizeof settings);
  energies_ = (settings & 1) != 0;
  strain_ = (settings & 2) != 0;
  holds_ = (settings & 4) != 0;
  for (int i = 1; i < width_; ++i)
    for (int j = i; j < width_; ++j) {
      int size;
      read(&size, sizeof size);
      std::string text(size, ' ');
      if (size == 0) continue;
      read(text.data(), size);
      set_words(i, j, text);
    }
}

}  // namespace epdem::lammps
