// SPDX-License-Identifier: GPL-2.0-or-later
// Around LIGGGHTS's loops over the walls of our models: contacts that they found are computed by ours (wall.hpp).
//
// On meshes LIGGGHTS evaluates each sphere near a triangle, and resets the marks of all contacts that the neighbour
// lists allow, in every step. Here a loop in the order of LIGGGHTS's sees the spheres that can touch, and the marks of
// spheres with contacts; LIGGGHTS's own functions compute the geometry of a contact and find its history, so that not
// one bit differs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "fix_contact_history_mesh.h"
#include "fix_neighlist_mesh.h"
#include "replaced.hpp"
#include "triangles.hpp"
#include "wall.hpp"

#ifdef EPDEM_BUILT_FOR

namespace epdem::liggghts::loop {
namespace {

using LAMMPS_NS::bigint;
using LAMMPS_NS::FixContactHistoryMesh;
using LAMMPS_NS::FixNeighlistMesh;
using LAMMPS_NS::FixWallGran;
using LAMMPS_NS::TriMesh;

struct Lists : FixNeighlistMesh {
  static std::vector<LAMMPS_NS::TriangleNeighlist>& of(FixNeighlistMesh& mesh) { return mesh.*(&Lists::triangles); }
};

/// The spheres in the neighbour lists of a mesh, and shorter lists: those that can touch a triangle before a sphere or
/// the mesh has moved by a part of the skin.
class NearSpheres {
 public:
  /// For a step.
  void update(TriMesh& mesh, FixNeighlistMesh& lists, const LAMMPS_NS::Atom& atom, const LoopState& loops,
              double slack) {
    const bool searched = search_ != loops.mesh_searches;
    search_ = loops.mesh_searches;
    if (searched) take(mesh, Lists::of(lists), atom.nlocal);
    if (spheres_.empty()) return;
    double moved = std::sqrt(moved_spheres(atom));
    if (!searched && mesh.isMoving()) moved += std::sqrt(moved_corners(mesh));
    if (searched || !(moved <= slack)) shorten(mesh, loops.kernels.spheres, slack);
  }

  /// contact(triangle, sphere) for all that can touch now, in the order of LIGGGHTS's lists.
  template <class F>
  void each(const SphereKernels& kernels, F contact) {
    const NearTest test{now_.data(), reach, 0.0};
    const int* candidates = near_.data();
    for (const Near& near : triangles_) {
      const int n = kernels.near_triangle(test, near.planes, candidates, near.count, found_.data());
      for (int k = 0; k < n; ++k) contact(near.triangle, spheres_[found_[k]]);
      candidates += near.count;
    }
  }

 private:
  static inline const double reach = 1.0 + 1e-6;  // far above round-off

  struct Near {
    int triangle, count;
    TrianglePlanes planes;
  };

  void take(TriMesh& mesh, const std::vector<LAMMPS_NS::TriangleNeighlist>& lists, int owned) {
    std::vector<int>& place = place_;
    place.assign(owned, -1);
    spheres_.clear();
    listed_.clear();
    all_.clear();
    triangles_.clear();
    const int count = std::min(mesh.sizeLocal() + mesh.sizeGhost(), static_cast<int>(lists.size()));
    for (int t = 0; t < count; ++t) {
      const std::size_t before = all_.size();
      for (const int i : lists[t].contacts) {
        if (i >= owned) continue;
        if (place[i] < 0) {
          place[i] = static_cast<int>(spheres_.size());
          spheres_.push_back(i);
        }
        all_.push_back(place[i]);
      }
      if (all_.size() > before)
        listed_.push_back({t, static_cast<int>(all_.size() - before), Triangles::planes(mesh, t)});
    }
    near_.resize(all_.size() + most_lanes);
    found_.resize(all_.size() + most_lanes);
    now_.resize(4 * spheres_.size());
    before_.assign(now_.size(), 0.0);
  }

  void shorten(TriMesh& mesh, const SphereKernels& kernels, double slack) {
    before_ = now_;
    if (mesh.isMoving()) {
      const double* const corners = Triangles::corners(mesh);
      corners_.assign(corners, corners + 9 * (mesh.sizeLocal() + mesh.sizeGhost()));
    }
    triangles_.clear();
    const NearTest test{now_.data(), reach, slack};
    int *candidates = all_.data(), *near = near_.data();
    for (const Near& listed : listed_) {
      const int n = kernels.near_triangle(test, listed.planes, candidates, listed.count, near);
      if (n > 0) triangles_.push_back({listed.triangle, n, listed.planes});
      candidates += listed.count;
      near += n;
    }
  }

  /// The largest square of a way since the lists were made; infinite if a radius has changed.
  double moved_spheres(const LAMMPS_NS::Atom& atom) {
    double most = 0.0;
    double* now = now_.data();
    const double* before = before_.data();
    for (const int i : spheres_) {
      for (int k = 0; k < 3; ++k) now[k] = atom.x[i][k];
      now[3] = atom.radius[i];
      most = std::max(most, square_of_way(now, before));
      if (now[3] != before[3]) most = std::numeric_limits<double>::infinity();
      now += 4;
      before += 4;
    }
    return most;
  }

  double moved_corners(TriMesh& mesh) const {
    double most = 0.0;
    const double* const now = Triangles::corners(mesh);
    for (std::size_t k = 0; k < corners_.size(); k += 3)
      most = std::max(most, square_of_way(now + k, corners_.data() + k));
    return most;
  }

  static double square_of_way(const double* a, const double* b) {
    const double dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
    return dx * dx + dy * dy + dz * dz;
  }

  long search_ = -1;                  // of which the lists are
  std::vector<int> spheres_;          // each once
  std::vector<int> place_;            // of a sphere in spheres_
  std::vector<double> now_, before_;  // rows of position and radius: in this step, and when the short lists were made
  std::vector<double> corners_;       // then, of a mesh that moves
  std::vector<Near> listed_, triangles_;
  std::vector<int> all_, near_;  // places in spheres_: all lists one after the other, and the short ones
  std::vector<int> found_;
};

/// The spheres in contact with a mesh, once per contact: in the last step of our loop, and in the step before.
struct Touching {
  bigint step = -1;
  std::vector<int> spheres, before;
};

/// While LIGGGHTS's loop over a wall runs; nullptr: not a wall of our models.
class ScopedWall {
 public:
  ScopedWall(BatchedWall* wall, FixWallGran& fix) : wall_(wall) {
    if (wall_) wall_->open(fix);
  }
  ScopedWall(const ScopedWall&) = delete;
  ScopedWall& operator=(const ScopedWall&) = delete;
  ~ScopedWall() {
    if (wall_) wall_->close();
  }

 private:
  BatchedWall* const wall_;
};

/// Whether only the contacts of the step before are marked: that was a step of our loop, and no list was made since.
bool settled(const Touching& contacts, const LAMMPS_NS::Update& update, const LAMMPS_NS::Neighbor& lists) {
  return contacts.step == update.ntimestep - 1 && lists.lastcall != update.ntimestep;
}

/// Access to the protected members of LIGGGHTS's contacts with a mesh.
struct Contacts : FixContactHistoryMesh {
  static int* count(FixContactHistoryMesh& of) { return of.*(&Contacts::npartner_); }
  static int* triangles(FixContactHistoryMesh& of, int i) { return (of.*(&Contacts::partner_))[i]; }
  static bool* marks(FixContactHistoryMesh& of, int i) { return (of.*(&Contacts::keepflag_))[i]; }
  static bool* intersects(FixContactHistoryMesh& of, int i) { return (of.*(&Contacts::intersectflag_))[i]; }
  static double* history(FixContactHistoryMesh& of, int i) { return (of.*(&Contacts::contacthistory_))[i]; }
  static int values(FixContactHistoryMesh& of) { return of.*(&Contacts::dnum_); }

  /// As markAllContacts of LIGGGHTS, for the spheres that had contacts in the step before.
  static void unmark(FixContactHistoryMesh& of, const std::vector<int>& spheres) {
    for (const int i : spheres)
      for (int k = 0, left = count(of)[i]; left > 0; ++k) {
        if (triangles(of, i)[k] < 0) continue;
        marks(of, i)[k] = false;
        --left;
      }
  }

  /// As cleanUpContacts of LIGGGHTS, for the same spheres.
  static void end_unmarked(FixContactHistoryMesh& of, const std::vector<int>& spheres) {
    for (const int i : spheres)
      for (int k = 0, left = count(of)[i]; left > 0; ++k) {
        if (triangles(of, i)[k] < 0) continue;
        --left;
        if (marks(of, i)[k]) continue;
        --count(of)[i];
        triangles(of, i)[k] = -1;
        intersects(of, i)[k] = false;
        std::fill_n(history(of, i) + k * values(of), values(of), 0.0);
      }
  }
};

}  // namespace

struct MeshState {
  NearSpheres near;
  Touching touching;
};

}  // namespace epdem::liggghts::loop

namespace LAMMPS_NS {

namespace loop = epdem::liggghts::loop;

[[gnu::visibility("default")]] void FixWallGran::post_force_primitive(int vflag) {
  static const auto original = loop::next<FixWallGran*, int>("_ZN9LAMMPS_NS11FixWallGran20post_force_primitiveEi");
  const loop::ScopedWall work(dynamic_cast<loop::BatchedWall*>(impl), *this);
  original(this, vflag);
}

[[gnu::visibility("default")]] void FixWallGran::post_force_mesh(int vflag) {
  static const auto original = loop::next<FixWallGran*, int>("_ZN9LAMMPS_NS11FixWallGran15post_force_meshEi");
  auto* const wall = dynamic_cast<loop::BatchedWall*>(impl);
  const loop::ScopedWall work(wall, *this);
  const loop::LoopState* const loops = wall ? loop::active_loops(lmp) : nullptr;
  bool batched_mesh_loop =
      loops && neighbor->contactDistanceFactor == 1.0 && atom->sphere_flag && !atom->shapetype_flag && atom->nlocal > 0;
  for (int m = 0; m < n_FixMesh_; ++m) {
    TriMesh& mesh = *FixMesh_list_[m]->triMesh();
    batched_mesh_loop &= !mesh.isDeforming() && !mesh.isScaling() && !FixMesh_list_[m]->meshMulticontactData();
  }
  if (!batched_mesh_loop) return original(this, vflag);
  LIGGGHTS::ContactModels::SurfacesIntersectData contact;
  contact.is_wall = true;
  auto& kept = wall->meshes;
  kept.resize(n_FixMesh_);
  for (int m = 0; m < n_FixMesh_; ++m) {
    FixMeshSurface& fix = *FixMesh_list_[m];
    TriMesh& mesh = *fix.triMesh();
    FixContactHistoryMesh* const history = fix.contactHistory();
    if (!kept[m]) kept[m] = std::make_shared<loop::MeshState>();
    loop::Touching& touching = kept[m]->touching;
    touching.before.swap(touching.spheres);
    touching.spheres.clear();
    const bool settled = loop::settled(touching, *update, *neighbor);
    if (history) settled ? loop::Contacts::unmark(*history, touching.before) : history->markAllContacts();
    if (store_force_contact_) fix_wallforce_contact_ = fix.meshforceContact();
    if (store_force_contact_stress_) fix_wallforce_contact_stress_ = fix.meshforceContactStress();
    atom_type_wall_ = fix.atomTypeWall();
    const auto velocities = mesh.prop().getElementProperty<MultiVectorContainer<double, 3, 3>>("v");
    double*** const v = velocities ? velocities->begin() : nullptr;
    double v_wall[3] = {}, delta[3], weight[3];
    contact.mesh = &mesh;
    contact.fix_mesh = &fix;
    loop::NearSpheres& near = kept[m]->near;
    near.update(mesh, *fix.meshNeighlist(), *atom, *loops, neighbor->skin / 4.0);
    near.each(loops->kernels.spheres, [&](int triangle, int i) {
      int side;
      contact.i = i;
      contact.radi = atom->radius[i];
      const double gap = mesh.resolveTriSphereContactBary(i, triangle, contact.radi, atom->x[i], delta, weight, side);
      constexpr int face = 7;  // of LIGGGHTS's sides
      if (!(gap <= 0.0)) return;
      if (history) {
        if (!history->handleContact(i, mesh.id(triangle), contact.contact_history, true, side == face)) return;
        touching.spheres.push_back(i);
      }
      for (int x = 0; x < 3; ++x) {
        if (v)
          v_wall[x] = weight[0] * v[triangle][0][x] + weight[1] * v[triangle][1][x] + weight[2] * v[triangle][2][x];
        contact.delta[x] = -delta[x];
      }
      contact.deltan = -gap;
      impl->compute_force(this, contact, true, v_wall, &fix, m, &mesh, triangle);
    });
    if (!history) continue;
    settled ? loop::Contacts::end_unmarked(*history, touching.before) : history->cleanUpContacts();
    touching.step = update->ntimestep;
  }
}

}  // namespace LAMMPS_NS
#endif
