// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_wall_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "domain.h"
#include "error.h"
#include "kernels/triangles.hpp"
#include "stl.hpp"

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
  int first = 5;
  for (bool moves = true; moves;) {
    const int words = std::strcmp(word[first], "move") == 0 ? 4 : std::strcmp(word[first], "rotate") == 0 ? 8 : 0;
    moves = words > 0;
    first += words;
    if (first >= count) error->all(FLERR, "{}: the law is missing behind the motion", place_);
  }
  std::string fixed[] = {id, "mesh/ep", "units", "box"};
  std::vector<char*> words;
  for (std::string& text : fixed) words.push_back(text.data());
  words.insert(words.end(), word + 5, word + first);
  mesh_ = std::make_unique<MeshRegion>(lmp, corners, static_cast<int>(words.size()), words.data());
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

}  // namespace epdem::lammps
