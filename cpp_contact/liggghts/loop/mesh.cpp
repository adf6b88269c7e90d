// SPDX-License-Identifier: GPL-2.0-or-later
// Around LIGGGHTS's loops over the walls of our models: contacts that they found are computed by ours (wall.hpp).
//
// On meshes LIGGGHTS evaluates each sphere near a triangle, and resets the marks of all contacts that the neighbour
// lists allow, in every step. Here its loop sees the spheres that can touch, and the marks of spheres with contacts;
// geometry and marks are computed by LIGGGHTS's own functions, so that not one bit differs.
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "fix_contact_history_mesh.h"
#include "fix_neighlist_mesh.h"
#include "near.hpp"
#include "replaced.hpp"
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

/// The neighbour lists of meshes, reduced to spheres that may touch for as long as this object lives.
class ReducedNeighborLists {
 public:
  ~ReducedNeighborLists() {
    for (const auto& [list, kept] : swapped_) list->swap(spare()[kept]);
  }

  void reduce(TriMesh& mesh, FixNeighlistMesh& lists, const NearTest& test, const SphereKernels& kernels) {
    std::vector<LAMMPS_NS::TriangleNeighlist>& triangles = Lists::of(lists);
    const int count = std::min(mesh.sizeLocal() + mesh.sizeGhost(), static_cast<int>(triangles.size()));
    for (int t = 0; t < count; ++t) {
      std::vector<int>& all = triangles[t].contacts;
      if (all.empty()) continue;
      if (used_ == spare().size()) spare().emplace_back();
      std::vector<int>& near = spare()[used_];
      near.resize(all.size() + most_lanes);
      const int n = static_cast<int>(all.size());
      near.resize(kernels.near_triangle(test, Triangles::planes(mesh, t), all.data(), n, near.data()));
      all.swap(near);
      swapped_.push_back({&all, used_++});
    }
  }

 private:
  struct Swapped {
    std::vector<int>* list;
    std::size_t kept;
  };

  static std::vector<std::vector<int>>& spare() {
    static std::vector<std::vector<int>> lists;
    return lists;
  }

  std::vector<Swapped> swapped_;
  std::size_t used_ = 0;
};

OurWall* active_wall = nullptr;                                   // the wall of our models over which a loop runs
bool ours = false;                                                // whether it is a mesh wall whose lists are reduced
std::unordered_map<const FixContactHistoryMesh*, bigint> marked;  // the last step of a mesh in which one was

/// While LIGGGHTS's loop over a wall runs.
class ScopedWall {
 public:
  ScopedWall(LIGGGHTS::Walls::IGranularWall* impl, FixWallGran& wall) {
    active_wall = dynamic_cast<OurWall*>(impl);
    if (active_wall) active_wall->open(wall);
  }
  ScopedWall(const ScopedWall&) = delete;
  ScopedWall& operator=(const ScopedWall&) = delete;
  ~ScopedWall() {
    if (active_wall) active_wall->close();
    active_wall = nullptr;
  }
};

/// Whether all contacts but those of spheres with contacts are unmarked: they were in the step before, and no list was
/// made since.
bool settled(const FixContactHistoryMesh* contacts, const LAMMPS_NS::Update& update, const LAMMPS_NS::Neighbor& lists) {
  if (!ours) return false;
  const auto found = marked.find(contacts);
  return found != marked.end() && found->second == update.ntimestep - 1 && lists.lastcall != update.ntimestep;
}

}  // namespace
}  // namespace epdem::liggghts::loop

namespace LAMMPS_NS {

namespace loop = epdem::liggghts::loop;

[[gnu::visibility("default")]] void FixWallGran::post_force_primitive(int vflag) {
  static const auto original = loop::next<FixWallGran*, int>("_ZN9LAMMPS_NS11FixWallGran20post_force_primitiveEi");
  const loop::ScopedWall work(impl, *this);
  original(this, vflag);
}

[[gnu::visibility("default")]] void FixWallGran::post_force_mesh(int vflag) {
  static const auto original = loop::next<FixWallGran*, int>("_ZN9LAMMPS_NS11FixWallGran15post_force_meshEi");
  const loop::ScopedWall work(impl, *this);
  if (!loop::active_wall || loop::generic_loop() || neighbor->contactDistanceFactor != 1.0 || !atom->sphere_flag ||
      atom->shapetype_flag || atom->nlocal == 0)
    return original(this, vflag);
  loop::ReducedNeighborLists near;
  const loop::NearTest test = loop::near_test(*atom, 1.0 + 1e-6, 0.0);  // far above round-off
  for (int m = 0; m < n_FixMesh_; ++m) {
    TriMesh& mesh = *FixMesh_list_[m]->triMesh();
    if (!mesh.isDeforming() && !mesh.isScaling())
      near.reduce(mesh, *FixMesh_list_[m]->meshNeighlist(), test, loop::sphere_kernels(lmp));
  }
  loop::ours = true;
  original(this, vflag);
  loop::ours = false;
}

[[gnu::visibility("default")]] void FixContactHistoryMesh::markAllContacts() {
  static const auto original =
      loop::next<FixContactHistoryMesh*>("_ZN9LAMMPS_NS21FixContactHistoryMesh15markAllContactsEv");
  if (!loop::settled(this, *update, *neighbor)) return original(this);
  for (int i = 0; i < atom->nlocal; ++i)
    if (npartner_[i] > 0) std::fill_n(keepflag_[i], nneighs(i), false);
}

[[gnu::visibility("default")]] void FixContactHistoryMesh::cleanUpContacts() {
  static const auto original =
      loop::next<FixContactHistoryMesh*>("_ZN9LAMMPS_NS21FixContactHistoryMesh15cleanUpContactsEv");
  if (!loop::settled(this, *update, *neighbor)) {
    original(this);
  } else {
    for (int i = 0; i < atom->nlocal; ++i)
      if (npartner_[i] > 0) cleanUpContacts(i, i + 1);
  }
  if (loop::ours) loop::marked[this] = update->ntimestep;
}

}  // namespace LAMMPS_NS
#endif
