// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_wall.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "epdem/adhesive.hpp"
#include "epdem/compaction.hpp"
#include "epdem/kinematics.hpp"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "neighbor.h"
#include "update.h"
#include "utils.h"

namespace epdem::lammps {

using namespace LAMMPS_NS;
using kernels::block_size, kernels::most_constants;

namespace {

std::string place_of(int count, char** word) {
  std::string text = "fix";
  for (int k = 0; k < std::min(count, 4); ++k)
    if (k != 1) text += std::string(" ") + word[k];
  return text;
}

/// Adds a region and its parts.
void add_parts(Region& region, std::vector<Region*>& parts) {
  parts.push_back(&region);
  for (int k = 0; region.reglist && k < region.nregion; ++k) add_parts(*region.reglist[k], parts);
}

/// Whether a face lies at infinity (INF), where LAMMPS has no bounding box or one of 1e20.
bool is_infinite(const Region& part) {
  const auto far = [](double at) { return !(std::fabs(at) < 1e19); };
  return !part.bboxflag || far(part.extent_xlo) || far(part.extent_xhi) || far(part.extent_ylo) ||
         far(part.extent_yhi) || far(part.extent_zlo) || far(part.extent_zhi);
}

}  // namespace

FixWall::FixWall(LAMMPS* lmp, int count, char** word)
    : Fix(lmp, count, word), place_(place_of(count, word)), block_(std::make_unique<kernels::Block>()) {
  create_attribute = 1;
  restart_peratom = 1;
  vector_flag = 1;
  size_vector = sums;
  extvector = 1;
  global_freq = 1;
  local_flag = 1;
  size_local_cols = local_columns;
  local_freq = 1;
}

void FixWall::read(int first, int count, char** word, int most) {
  words_ = read_words(lmp, place_, count - first, word + first);
  layout_ = layout_of(words_.models, true);
  for (const bool complete : {false, true}) kernel_[complete] = kernel_of(lmp, place_, words_.models, true, complete);
  most_ = most;
  stride_ = 1 + layout_.values;
  maxexchange = 1 + most_ * stride_;
  FixWall::grow_arrays(atom->nmax);
  atom->add_callback(Atom::GROW);
  atom->add_callback(Atom::RESTART);
}

FixWall::~FixWall() {
  if (stride_ == 0) return;  // its words were wrong
  atom->delete_callback(id, Atom::GROW);
  atom->delete_callback(id, Atom::RESTART);
}

int FixWall::setmask() { return FixConst::POST_FORCE | FixConst::POST_NEIGHBOR; }

void FixWall::init() {
  check_settings(lmp, place_);
  pair_ = nullptr;
  for (int sub = 0; sub < 10 && !pair_; ++sub) {
    auto* const found = dynamic_cast<PairEp*>(force->pair_match(PairEp::style_name, 1, sub));
    if (found && found->models().law == words_.models.law) pair_ = found;
  }
  if (!pair_)
    error->all(FLERR, "{}: the material of the spheres comes from a pair_style ep of law {}, and there is none", place_,
               words_.models.law->name);
  if (words_.models.compaction != pair_->models().compaction)
    error->all(FLERR, "{}: compaction is {} here and {} in pair_coeff; give `compaction on` to both or to none", place_,
               words_.models.compaction ? "on" : "off", words_.models.compaction ? "off" : "on");
  heat_ = FixHeat::of(*modify);
  if (!claimed_) {
    const std::string wrong = pair_->history()->claim_wall(id, restart_reset != 0);
    if (!wrong.empty()) error->all(FLERR, "{}, ID {}: {}", place_, id, wrong);
    claimed_ = true;
  }
  constants_.assign(most_constants * (atom->ntypes + 1), 0.0);
  judge_.begin(atom->ntypes + 1);
  for (const int type : types_of_group())
    put_constants(*words_.models.law, pair_->words_of(type, place_).material, words_.material, words_.coefficients,
                  constants_.data() + most_constants * type);
  pass_ = {};
  pass_.damped = words_.coefficients.tangential_restitution > 0.0;
  pass_.viscous = words_.coefficients.normal_restitution > 0.0;
  pass_.rolling = words_.models.rolling;
  pass_.cohesion = words_.models.cohesion;
  if (words_.coefficients.damped()) refuse_rigid_bodies(lmp, place_);
  if (words_.models.compaction) reach_factor_ = 1.0 + growth_reach;
  if (layout_.gap.root < 0) return;
  reach_ = neighbor->skin;
  for (const int type : types_of_group()) {
    const double* const constants = constants_.data() + most_constants * type;
    checked_gap(lmp, place_, *words_.models.law, constants, pair_->largest_radius(type));
    judge_.note(type, *words_.models.law, constants, pair_->smallest_radius(type));
  }
}

/// Types with a material, and types of spheres that are there: without a material they are an error.
std::vector<int> FixWall::types_of_group() const {
  std::vector<int> here(atom->ntypes + 1, 0), there(atom->ntypes + 1), types;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) here[atom->type[i]] = 1;
  MPI_Allreduce(here.data(), there.data(), atom->ntypes + 1, MPI_INT, MPI_MAX, world);
  for (int type = 1; type <= atom->ntypes; ++type)
    if (there[type] || pair_->has_material(type)) types.push_back(type);
  return types;
}

/// Before new neighbor lists, no sphere moves by more than half of the skin, if LAMMPS checks this in each step; else
/// all spheres are candidates. While a wall moves by another half of the skin, spheres can move from one side of their
/// place in the lists to the other.
void FixWall::choose_candidates() {
  const double rounding = 1.0 + 1e-6, slack = (moves() ? 1.5 : 0.5) * rounding * neighbor->skin;
  const bool checks = neighbor->dist_check && neighbor->every == 1 && neighbor->delay == 0 && !neighbor->build_once &&
                      neighbor->includegroup == 0 && way() < HUGE_VAL && modify->get_fix_by_style("^adapt").empty();
  candidates_.clear();
  begin_search(checks);
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!checks || is_near(i, reach_of(i) + slack))
      candidates_.push_back(i);
    else
      held_[i].clear();
  }
  note_placement();
  candidates_valid_ = true;
}

/// LAMMPS also computes forces before the first step of a run; that evaluation changes no history.
void FixWall::post_force(int) {
  const bool counts = !update->setupflag;
  begin();
  if (!candidates_valid_ || (moves() && !(way() <= 0.5 * neighbor->skin))) choose_candidates();
  std::vector<std::vector<double>> before;
  if (!counts) before = held_;
  pass_.dt = counts ? update->dt : no_time;
  pass_.repeats = !counts;
  pass_.work = counts && pair_->energies();
  pass_.holds = pair_->holds();
  pass_.strain = pair_->strain();
  pass_.sums = words_.models.compaction ? pair_->history()->bodies() : nullptr;
  pass_.v = readable_rows(atom->v, atom->nlocal, atom->nmax, copies_[0]);
  pass_.omega = readable_rows(atom->omega, atom->nlocal, atom->nmax, copies_[1]);
  std::fill_n(sum_, sums, 0.0);
  size_local_rows = 0;

  kernels::Block& b = *block_;
  std::vector<Contact> found;
  int n = 0;
  for (const int i : candidates_) {
    if (!(atom->mask[i] & groupbit)) continue;
    found.clear();
    find(i, found);
    if (layout_.gap.any()) drop_parted(i, found);
    if (static_cast<int>(found.size()) > most_)
      error->one(FLERR, "{}: atom {} has more than {} contacts with the wall", place_, atom->tag[i], most_);
    if (!has_records_of(i, found)) keep_records(i, found);
    for (size_t k = 0; k < found.size(); ++k) {
      const Contact& c = found[k];
      b.i[n] = i;
      b.history[n] = record(i, static_cast<int>(k)) + 1;
      b.material[n] = constants_.data() + most_constants * atom->type[i];
      if (*b.material[n] == 0.0)
        error->one(FLERR, "{}: atom {} came during the run, and its type {} has no material; add pair_coeff {} {}",
                   place_, atom->tag[i], atom->type[i], atom->type[i], atom->type[i]);
      b.radius_i.a[n] = atom->radius[i];
      b.mass_i.a[n] = atom->rmass[i];
      b.j[n] = c.part;
      b.overlap.a[n] = atom->radius[i] - c.distance;
      for (int axis = 0; axis < 3; ++axis) {
        b.from_wall[axis].a[n] = c.from_wall[axis];
        b.wall_v[axis].a[n] = c.velocity[axis];
      }
      if (++n == block_size) {
        finish(n);
        n = 0;
      }
    }
  }
  finish(n);
  summed_ = -1;
  local_row_.resize(std::max<size_t>(local_row_.size(), size_local_rows));
  for (int k = 0; k < size_local_rows; ++k) local_row_[k] = local_.data() + local_columns * k;
  array_local = local_row_.data();
  if (!counts) held_.swap(before);
}

/// Across a gap, only spheres are in contact that are attached, or whose growth closes the gap.
void FixWall::drop_parted(int i, std::vector<Contact>& found) {
  const auto parted = [&](const Contact& c) { return !(c.distance < atom->radius[i]) && !stands(i, c); };
  found.erase(std::remove_if(found.begin(), found.end(), parted), found.end());
}

bool FixWall::stands(int i, const Contact& contact) {
  const double* history = nullptr;
  for (int k = 0; k < count(i); ++k)
    if (record(i, k)[0] == contact.part) history = record(i, k) + 1;
  const Gap gap{contact.distance * contact.distance, atom->radius[i], 0.0, sums_of(pass_.sums, i), {}};
  return exists(layout_.gap, history, gap, pass_.repeats);
}

/// Whether the records of a sphere have the order of its contacts.
bool FixWall::has_records_of(int i, const std::vector<Contact>& found) {
  if (count(i) != static_cast<int>(found.size())) return false;
  for (int k = 0; k < count(i); ++k)
    if (record(i, k)[0] != found[k].part) return false;
  return true;
}

/// Puts the records of a sphere in the order of its contacts; the history of a new contact begins with zeros.
void FixWall::keep_records(int i, const std::vector<Contact>& found) {
  scratch_.swap(held_[i]);
  held_[i].assign(found.size() * stride_, 0.0);
  for (size_t k = 0; k < found.size(); ++k) {
    double* const to = record(i, static_cast<int>(k));
    for (auto old = scratch_.begin(); old != scratch_.end(); old += stride_)
      if (*old == found[k].part) std::copy_n(old, stride_, to);
    to[0] = found[k].part;
  }
}

void FixWall::finish(int n) {
  if (n == 0) return;
  kernels::Block& b = *block_;
  pass_.several = std::any_of(b.material, b.material + n, [&](const double* m) { return m != b.material[0]; });
  judge_.judge(lmp, place_, *words_.models.law, b, n, pass_.several, true, constants_.data());
  kernels::pad(b, n);
  kernel_[pass_.work || pass_.repeats](b, n, pass_);
  for (int k = 0; k < n; ++k) {
    const int i = b.i[k];
    double *const f = atom->f[i], *const torque = atom->torque[i];
    const double* const x = atom->x[i];
    for (int axis = 0; axis < 3; ++axis) {
      f[axis] += b.force[axis].a[k];
      torque[axis] += b.torque_i[axis].a[k];
      sum_[axis] += b.force[axis].a[k];
      const int second = (axis + 1) % 3, third = (axis + 2) % 3;
      sum_[3 + axis] += x[second] * b.force[third].a[k] - x[third] * b.force[second].a[k] + b.torque_i[axis].a[k];
      sum_[6] += b.force[axis].a[k] * b.wall_v[axis].a[k];
    }
  }
  if (pass_.work) {
    pair_->history()->add_wall_energies(b, n, words_.models, pass_.holds);
    pair_->history()->add_works(b, n, words_.models, true);
    if (heat_) heat_->add_wall(b, n, id);
  }
  if (words_.models.compaction) pair_->history()->note_dents(b, n, true);
  if (pass_.strain) pair_->history()->note_strain(b);
  if (pair_->energies()) note(n);
  note_forces(b, n);
}

/// Writes the rows of a `dump local`.
void FixWall::note(int n) {
  const kernels::Block& b = *block_;
  const int most = words_.models.law->most, root = layout_.gap.root, growth = layout_.gap.growth;
  const size_t first = size_t(local_columns) * size_local_rows, last = first + size_t(local_columns) * n;
  if (local_.size() < last) local_.resize(2 * last);
  size_local_rows += n;
  double* row = local_.data() + first;
  for (int k = 0; k < n; ++k, row += local_columns) {
    const double overlap = b.overlap.a[k], distance = atom->radius[b.i[k]] - overlap, *const history = b.history[k];
    row[0] = atom->tag[b.i[k]];
    row[1] = b.j[k];
    row[2] = overlap;
    row[15] = growth < 0 ? 0.0 : retreat_of(history + growth);
    row[3] = most < 0 ? overlap : std::max(overlap - row[15], history[most]);
    row[4] = root < 0 || history[root] > 0.0;
    row[5] = growth < 0 ? 0.0 : added_overlap_of(history + growth);
    row[6] = growth < 0 ? 0.0 : screening_of(history + growth);
    row[13] = growth < 0 ? 0.0 : grown_overlap_of(history + growth);
    row[14] = growth < 0 ? 0.0 : body_pressure_of(history + growth);
    for (int axis = 0; axis < 3; ++axis) {
      row[7 + axis] = b.force[axis].a[k];
      row[10 + axis] = distance > 0.0 ? b.from_wall[axis].a[k] / distance : 0.0;
    }
  }
}

double FixWall::compute_vector(int axis) {
  if (summed_ != update->ntimestep) {
    MPI_Allreduce(sum_, total_, sums, MPI_DOUBLE, MPI_SUM, world);
    summed_ = update->ntimestep;
  }
  return total_[axis];
}

double FixWall::memory_usage() {
  size_t bytes = held_.capacity() * sizeof held_[0];
  for (const auto& held : held_) bytes += held.capacity() * sizeof(double);
  return static_cast<double>(bytes);
}

void FixWall::grow_arrays(int atoms) { held_.resize(atoms); }

void FixWall::copy_arrays(int from, int to, int) { held_[to] = held_[from]; }

void FixWall::set_arrays(int i) { held_[i].clear(); }

int FixWall::pack_exchange(int i, double* buffer) {
  buffer[0] = count(i);
  return static_cast<int>(std::copy(held_[i].begin(), held_[i].end(), buffer + 1) - buffer);
}

int FixWall::unpack_exchange(int i, double* buffer) {
  const int size = static_cast<int>(buffer[0]) * stride_;
  held_[i].assign(buffer + 1, buffer + 1 + size);
  return 1 + size;
}

int FixWall::size_restart(int i) { return 2 + static_cast<int>(held_[i].size()); }

int FixWall::pack_restart(int i, double* buffer) {
  buffer[0] = size_restart(i);
  pack_exchange(i, buffer + 1);
  return size_restart(i);
}

void FixWall::unpack_restart(int i, int nth) {
  double* values = atom->extra[i];
  for (int k = 0; k < nth; ++k) values += static_cast<int>(values[0]);
  const int held = static_cast<int>(values[1]);
  if (held > most_ || 2 + held * stride_ != static_cast<int>(values[0]))
    error->one(FLERR, "{}: the restart file holds contacts of other models; take its law and models, or another ID",
               place_);
  unpack_exchange(i, values + 1);
}

FixWallPlanes::FixWallPlanes(LAMMPS* lmp, int count, char** word) : FixWall(lmp, count, word) {
  static const char* const names[] = {"xplane", "yplane", "zplane"};
  if (count < 6) error->all(FLERR, "{}: the words are ID group wall/ep xplane|yplane|zplane lo hi LAW ...", place_);
  axis_ = static_cast<int>(std::find(names, names + 3, std::string(word[3])) - names);
  if (axis_ == 3) error->all(FLERR, "{}: must be xplane, yplane or zplane; other walls are wall/ep/region", place_);
  const auto position = [&](const char* text, double none) {
    if (std::strcmp(text, "NULL") == 0) return none;
    if (!utils::is_double(text)) error->all(FLERR, "{}: position {} must be a number or NULL", place_, text);
    return std::atof(text);
  };
  low_ = position(word[4], -HUGE_VAL);
  high_ = position(word[5], HUGE_VAL);
  if (!(low_ <= high_)) error->all(FLERR, "{}: lo = {} must lie below hi = {}", place_, word[4], word[5]);
  read(6, count, word, 2);
}

void FixWallPlanes::init() {
  FixWall::init();
  if (domain->periodicity[axis_])
    error->all(FLERR, "{}: the box is periodic along {}; give boundary f, s or m, or another plane", place_,
               "xyz"[axis_]);
}

void FixWallPlanes::find(int i, std::vector<Contact>& found) {
  const double x = atom->x[i][axis_], reach = reach_of(i);
  const auto note = [&](int part, double from_wall) {
    if (!(std::fabs(from_wall) < reach)) return;
    Contact c{part, std::fabs(from_wall), {}, {}};
    c.from_wall[axis_] = from_wall;
    found.push_back(c);
  };
  if (x > low_) note(0, x - low_);
  if (x < high_) note(1, x - high_);
}

bool FixWallPlanes::is_near(int i, double distance) {
  const double x = atom->x[i][axis_];
  return std::fabs(x - low_) < distance || std::fabs(x - high_) < distance;
}

FixWallRegion::FixWallRegion(LAMMPS* lmp, int count, char** word, OwnRegion) : FixWall(lmp, count, word) {
  restart_global = 1;
}

FixWallRegion::FixWallRegion(LAMMPS* lmp, int count, char** word)
    : FixWall(lmp, count, word), name_(count > 3 ? word[3] : "") {
  if (count < 5) error->all(FLERR, "{}: the words are ID group wall/ep/region REGION LAW ...", place_);
  region_ = domain->get_region_by_id(name_);
  if (!region_) error->all(FLERR, "{}: there is no region {}", place_, name_);
  read(4, count, word, region_->tmax);
  restart_global = 1;
}

Region* FixWallRegion::find_region() {
  Region* const found = domain->get_region_by_id(name_);
  if (!found) error->all(FLERR, "{}: region {} is gone", place_, name_);
  return found;
}

void FixWallRegion::init() {
  region_ = find_region();
  moves_ = region_->dynamic_check() != 0;
  parts_.clear();
  add_parts(*region_, parts_);
  FixWall::init();
}

void FixWallRegion::begin() {
  if (!moves_) return;
  region_->prematch();
  region_->set_velocity();
  // LAMMPS finds the wall at rest before the first step of a run, and after read_restart moved by its way so far
  exchange_motion(update->setupflag);
}

/// Recalls the motion of the last step, or notes that of this step.
void FixWallRegion::exchange_motion(bool recalls) {
  motion_.resize(numbers_of_motion * parts_.size());
  double* number = motion_.data();
  for (Region* const part : parts_) {
    for (double* const of : {part->v, part->omega}) {
      recalls ? std::copy_n(number, 3, of) : std::copy_n(of, 3, number);
      number += 3;
    }
    double& growth = *number++;
    if (!part->varshape) continue;
    if (recalls)
      part->rprev = part->prev[4] - growth;
    else
      growth = part->prev[4] - part->rprev;
  }
}

void FixWallRegion::write_restart(FILE* file) {
  std::vector<double> values{static_cast<double>(motion_.size())};
  values.insert(values.end(), motion_.begin(), motion_.end());
  add_to_restart(values);
  if (comm->me != 0) return;
  const int bytes = static_cast<int>(values.size() * sizeof(double));
  fwrite(&bytes, sizeof bytes, 1, file);
  fwrite(values.data(), sizeof(double), values.size(), file);
}

void FixWallRegion::restart(char* stored) {
  const double* const values = reinterpret_cast<const double*>(stored);
  const double* const end = values + 1 + static_cast<size_t>(values[0]);
  motion_.assign(values + 1, end);
  take_from_restart(end);
}

void FixWallRegion::note_placement() {
  placements_.clear();
  for (const Region* const part : parts_) {
    double most = 0.0;
    for (int i = 0; part->rotateflag && i < atom->nlocal; ++i) {
      double square = 0.0;
      for (int axis = 0; axis < 3; ++axis) square += std::pow(atom->x[i][axis] - part->rpoint[axis], 2);
      most = std::max(most, std::sqrt(square) + reach_of(i));
    }
    placements_.push_back({{part->dx, part->dy, part->dz}, part->theta, most + 2.0 * neighbor->skin});
  }
}

/// Of a region whose shape varies there is none.
double FixWallRegion::way() const {
  double most = 0.0;
  for (size_t k = 0; k < parts_.size(); ++k) {
    const Region& part = *parts_[k];
    if (part.varshape) return HUGE_VAL;
    if (k == placements_.size()) break;
    const Placement& noted = placements_[k];
    const double dx = part.dx - noted.shift[0], dy = part.dy - noted.shift[1], dz = part.dz - noted.shift[2];
    const double turn = part.rotateflag ? std::fabs(part.theta - noted.angle) * noted.lever : 0.0;
    most = std::max(most, (part.moveflag ? std::sqrt(dx * dx + dy * dy + dz * dz) : 0.0) + turn);
  }
  return most;
}

/// A part can hide the nearest point of another: each part is tested alone, from inside and outside. From outside
/// LAMMPS finds no face of an open part that is infinite (INF), but the sphere can enter through it: all are near.
bool FixWallRegion::is_near(int i, double distance) {
  const double* const x = atom->x[i];
  for (Region* const part : parts_) {
    if (part->reglist) continue;
    const int side = part->interior, open = part->openflag;
    part->openflag = 0;
    bool near = open && is_infinite(*part) && !(part->match(x[0], x[1], x[2]) == side);
    part->openflag = open;
    for (part->interior = 0; part->interior < 2; ++part->interior)
      near |= part->surface(x[0], x[1], x[2], distance) > 0;
    part->interior = side;
    if (near) return true;
  }
  return false;
}

void FixWallRegion::find(int i, std::vector<Contact>& found) {
  double* const x = atom->x[i];
  const int count = region_->surface(x[0], x[1], x[2], reach_of(i));
  // LAMMPS turns the sphere into the frame of a region once more for each question; open regions hold every point
  if (count == 0 || (!region_->openflag && !region_->match(x[0], x[1], x[2]))) return;
  for (int k = 0; k < count; ++k) {
    const Region::Contact& at = region_->contact[k];
    Contact c{at.iwall, at.r, {at.delx, at.dely, at.delz}, {}};
    if (moves_) {
      const Vec<double> away{at.delx, at.dely, at.delz}, deeper = to_middle(atom->radius[i] - at.r, away);
      double centre[3] = {x[0] + deeper.x, x[1] + deeper.y, x[2] + deeper.z};  // over the middle of the overlap
      region_->velocity_contact(c.velocity, centre, k);
    }
    found.push_back(c);
  }
}

}  // namespace epdem::lammps
