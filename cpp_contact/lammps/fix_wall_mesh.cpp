// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_wall_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "comm.h"
#include "domain.h"
#include "epdem/wear.hpp"
#include "error.h"
#include "kernels/triangles.hpp"
#include "modify.h"
#include "stl.hpp"
#include "update.h"
#include "utils.h"

namespace epdem::lammps {

using namespace LAMMPS_NS;
using kernels::TriangleSurface;

/// LAMMPS calls `surface_exterior` with the place of a sphere in the frame of the region. Beside the faces of a
/// periodic box the surface has its images: triangle t of n has the numbers t + k n. A wall that turns has images along
/// its axis.
class MeshRegion final : public Region {
 public:
  MeshRegion(LAMMPS* lmp, std::vector<double> corners, int count, char** word)
      : Region(lmp, count, word), surface(corners), own_(surface.size()) {
    options(count - 2, word + 2);
    openflag = 1;  // both sides act
    bboxflag = 0;
    cmax = tmax = 32;
    for (int axis = 0; axis < 3; ++axis) {
      if (!domain->periodicity[axis] || (rotateflag && std::fabs(runit[axis]) < 1.0)) continue;
      period_[axis] = domain->prd[axis];
      const std::size_t before = corners.size();
      for (const double way : {-period_[axis], period_[axis]})
        for (std::size_t k = 0; k < before; ++k)
          corners.push_back(corners[k] + (static_cast<int>(k) % 3 == axis) * way);
    }
    if (images()) surface = TriangleSurface(corners);
  }

  bool images() const { return *std::max_element(period_, period_ + 3) > 0.0; }
  bool fits_box() const {
    for (int axis = 0; axis < 3; ++axis)
      if (period_[axis] > 0.0 && period_[axis] != domain->prd[axis]) return false;
    return !(images() && domain->triclinic);
  }

  /// Puts the wall into the box again, by whole periods.
  void fold() {
    const double way[] = {dx, dy, dz};
    for (int axis = 0; axis < 3; ++axis)
      fold_[axis] = moveflag && period_[axis] > 0.0 ? period_[axis] * std::round(way[axis] / period_[axis]) : 0.0;
  }

  /// The image of a triangle on which a contact is now, or that meets the triangle of one; else the triangle.
  int image_beside(int triangle, const std::vector<int>& now, double size) const {
    for (const int c : now)
      if (c % own_ == triangle % own_) return c;
    for (int image = triangle % own_; image < surface.size(); image += own_)
      for (const int c : now)
        if (surface[image].meets(surface[c], size)) return image;
    return triangle;
  }

  /// The triangle of the file that a triangle is or is an image of.
  int own(int triangle) const { return triangle % own_; }
  int size() const { return own_; }
  double area(int triangle) const { return 0.5 * length(cross(surface[triangle].ab, surface[triangle].ac)); }
  /// The normal where the wall is now.
  Vec<double> normal(int triangle) const {
    const Vec<double> n = surface[triangle].normal;
    if (!rotateflag) return n;
    const Vec<double> axis{runit[0], runit[1], runit[2]};
    const double cosine = std::cos(theta);
    return cosine * n + std::sin(theta) * cross(axis, n) + (1.0 - cosine) * dot(axis, n) * axis;
  }

  int inside(double, double, double) override { return 0; }
  int surface_interior(double*, double) override { return 0; }
  int surface_exterior(double* x, double distance) override {
    const Vec<double> at{x[0] + fold_[0], x[1] + fold_[1], x[2] + fold_[2]};
    if (lists) {
      surface.near(at, distance, *lists);
      return 0;
    }
    if (!candidates) surface.near(at, distance, near_);
    surface.contacts(at, distance, candidates ? *candidates : near_, found_);
    contacts_.resize(found_.size());
    contact = contacts_.data();
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const kernels::TriangleContact& c = found_[k];
      contacts_[k] = {c.distance, c.from_wall.x, c.from_wall.y, c.from_wall.z, 0.0, c.triangle, 0};
    }
    return static_cast<int>(found_.size());
  }

  TriangleSurface surface;
  std::vector<int>* lists = nullptr;             // where to write the triangles up to a distance, in place of contacts
  const std::vector<int>* candidates = nullptr;  // all triangles that the sphere can touch; nullptr: not known

 private:
  int own_;  // triangles without images
  double period_[3] = {}, fold_[3] = {};
  std::vector<int> near_;
  std::vector<kernels::TriangleContact> found_;
  std::vector<Region::Contact> contacts_;
};

FixWallMesh::FixWallMesh(LAMMPS* lmp, int count, char** word) : FixWallRegion(lmp, count, word, OwnRegion{}) {
  if (count < 6)
    error->all(FLERR, "{}: the words are ID group wall/ep mesh FILE [move ...] [rotate ...] LAW ...", place_);
  std::vector<double> corners;
  const std::string wrong = read_stl(word[4], corners);
  if (!wrong.empty()) error->all(FLERR, "{}: file {}: {}", place_, word[4], wrong);
  std::string fixed[] = {id, "mesh/ep", "units", "box"};
  std::vector<char*> words;
  for (std::string& text : fixed) words.push_back(text.data());
  int first = 5;
  for (int more = 1; more > 0; first += more) {
    const std::string name = word[first];
    more = name == "move" ? 4 : name == "rotate" ? 8 : name == "wear" ? 2 : 0;
    if (first + more >= count) error->all(FLERR, "{}: the law is missing behind {}", place_, name);
    if (name != "wear") {
      words.insert(words.end(), word + first, word + first + more);
      continue;
    }
    wear_ = utils::is_double(word[first + 1]) ? std::atof(word[first + 1]) : 0.0;
    if (!(wear_ > 0.0)) error->all(FLERR, "{}: wear {} must be a number above zero", place_, word[first + 1]);
  }
  mesh_ = std::make_unique<MeshRegion>(lmp, corners, static_cast<int>(words.size()), words.data());
  force_.resize(3 * mesh_->size());
  if (wear_ > 0.0) worn_.resize(mesh_->size());
  read(first, count, word, mesh_->tmax);
}

FixWallMesh::~FixWallMesh() = default;

Region* FixWallMesh::find_region() {
  mesh_->init();
  if (!mesh_->fits_box())
    error->all(FLERR, "{}: triangles beside periodic faces need a box without tilt that keeps its size", place_);
  return mesh_.get();
}

void FixWallMesh::begin_search(bool holds) {
  lists_hold_ = holds;
  mesh_->fold();
  near_.resize(atom->nmax);
  for (const int i : listed_) near_[i].clear();
  listed_.clear();
}

bool FixWallMesh::is_near(int i, double distance) {
  const double* const x = atom->x[i];
  mesh_->lists = &near_[i];
  mesh_->Region::surface(x[0], x[1], x[2], distance);
  mesh_->lists = nullptr;
  if (near_[i].empty()) return false;
  listed_.push_back(i);
  return true;
}

void FixWallMesh::begin() {
  FixWallRegion::begin();
  for (const int t : pressed_) std::fill_n(force_.data() + 3 * t, 3, 0.0);
  pressed_.clear();
}

void FixWallMesh::note_forces(const kernels::Block& b, int n) {
  const auto part = [](const auto& lines, int k) { return Vec<double>{lines[0].a[k], lines[1].a[k], lines[2].a[k]}; };
  if (!sums_ && worn_.empty()) return;
  for (int k = 0; k < n; ++k) {
    const int t = mesh_->own(b.j[k]);
    const Vec<double> force = part(b.force, k);
    pressed_.push_back(t);
    force_[3 * t] -= force.x;
    force_[3 * t + 1] -= force.y;
    force_[3 * t + 2] -= force.z;
    if (worn_.empty() || update->setupflag) continue;
    const double* const v = atom->v[b.i[k]];
    const Vec<double> beside = Vec<double>{v[0], v[1], v[2]} - part(b.wall_v, k);
    worn_[t] += worn_volume(wear_, length(force), beside, part(b.from_wall, k), mesh_->normal(t), update->dt);
  }
}

/// Over the ranks, on all of them.
std::vector<double> FixWallMesh::sum(const std::vector<double>& of_rank) const {
  std::vector<double> found(of_rank.size());
  MPI_Allreduce(of_rank.data(), found.data(), static_cast<int>(found.size()), MPI_DOUBLE, MPI_SUM, world);
  return found;
}

std::vector<double> FixWallMesh::table() const {
  const std::vector<double> force = sum(force_), worn = sum(worn_);
  std::vector<double> found;
  for (int t = 0; comm->me == 0 && t < mesh_->size(); ++t) {
    const Vec<double> all{force[3 * t], force[3 * t + 1], force[3 * t + 2]}, normal = mesh_->normal(t);
    const double area = mesh_->area(t), pressed = dot(all, normal);
    const double values[] = {double(t), area, std::fabs(pressed) / area, length(all - pressed * normal) / area,
                             worn.empty() ? 0.0 : worn[t] / area};
    found.insert(found.end(), values, values + table_columns);
  }
  return found;
}

/// A run that goes on and a run from the file add up in the same order: rank 0 has the sum.
void FixWallMesh::add_to_restart(std::vector<double>& values) {
  worn_ = sum(worn_);
  values.push_back(static_cast<double>(worn_.size()));
  values.insert(values.end(), worn_.begin(), worn_.end());
  if (comm->me != 0) std::fill(worn_.begin(), worn_.end(), 0.0);
}

void FixWallMesh::take_from_restart(const double* values) {
  const auto count = static_cast<std::size_t>(values[0]);
  if (worn_.empty() || count == 0) return;
  if (count != worn_.size())
    error->all(FLERR, "{}: the restart file has the wear of {} triangles, and the wall has {}", place_, count,
               worn_.size());
  if (comm->me == 0) std::copy_n(values + 1, count, worn_.begin());
}

void FixWallMesh::find(int i, std::vector<Contact>& found) {
  mesh_->candidates = lists_hold_ ? &near_[i] : nullptr;
  FixWallRegion::find(i, found);
  pass_records(i, found);
}

void FixWallMesh::pass_records(int i, const std::vector<Contact>& found) {
  if (count(i) == 0 || has_records_of(i, found)) return;
  const TriangleSurface& surface = mesh_->surface;
  std::vector<int> before(count(i)), now;
  for (const Contact& c : found) now.push_back(c.part);
  for (int k = 0; k < count(i); ++k) {
    const int triangle = static_cast<int>(record(i, k)[0]);
    before[k] = triangle < surface.size() ? mesh_->image_beside(triangle, now, atom->radius[i]) : -1;
    if (before[k] >= 0) record(i, k)[0] = before[k];
  }
  kernels::pass_records(
      before, now, atom->radius[i], [&](int t) -> const kernels::Triangle& { return surface[t]; },
      [&](std::size_t k, std::size_t c) { record(i, static_cast<int>(k))[0] = now[c]; });
}

ComputeTriangles::ComputeTriangles(LAMMPS* lmp, int count, char** word)
    : Compute(lmp, count, word), name_(count == 4 ? word[3] : "") {
  if (count != 4) error->all(FLERR, "compute {}: the words are ID group triangles/ep FIX", style_name);
  local_flag = 1;
  size_local_cols = FixWallMesh::table_columns;
}

void ComputeTriangles::init() {
  wall_ = dynamic_cast<FixWallMesh*>(modify->get_fix_by_id(name_));
  if (!wall_) error->all(FLERR, "compute {}: there is no fix wall/ep mesh {}", style_name, name_);
  wall_->sum_forces();
}

void ComputeTriangles::compute_local() {
  invoked_local = update->ntimestep;
  values_ = wall_->table();
  rows_.clear();
  for (std::size_t k = 0; k < values_.size(); k += size_local_cols) rows_.push_back(values_.data() + k);
  size_local_rows = static_cast<int>(rows_.size());
  array_local = rows_.data();
}

}  // namespace epdem::lammps
