// SPDX-License-Identifier: GPL-2.0-or-later
// Around LIGGGHTS's loops over the walls of our models: contacts that they found are computed by ours (wall.hpp).
//
// On meshes LIGGGHTS evaluates each sphere near a triangle, and resets the marks of all contacts that the neighbour
// lists allow, in every step. Here a loop in the order of LIGGGHTS's sees the spheres that can touch, and the marks of
// spheres with contacts; LIGGGHTS's own functions compute the geometry of a contact and find its history.
//
// LIGGGHTS adds the contact with a convex edge to the contact with a face beside the edge. Here a sphere has one
// contact over a face, an edge or a corner, whose history goes along, also with EPDEM_LOOP=generic.
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "fix_contact_history_mesh.h"
#include "fix_move_mesh.h"
#include "fix_neighlist_mesh.h"
#include "kernels/near_spheres.hpp"
#include "kernels/triangles.hpp"
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

/// The spheres near a mesh, from the last search for its neighbours.
struct NearMesh {
  NearSpheres spheres;
  long search = -1;

  /// For a step.
  void update(TriMesh& mesh, FixNeighlistMesh& lists, const LAMMPS_NS::Atom& atom, const LoopState& loops,
              const LAMMPS_NS::Neighbor& neighbor) {
    const int triangles = mesh.sizeLocal() + mesh.sizeGhost();
    if (search != loops.mesh_searches) {
      const auto& listed = Lists::of(lists);
      spheres.take(
          std::min(triangles, static_cast<int>(listed.size())), atom.nlocal, neighbor.contactDistanceFactor,
          [&](int t) -> const std::vector<int>& { return listed[t].contacts; },
          [&](int t) { return Triangles::planes(mesh, t); });
      search = loops.mesh_searches;
    }
    const double* const corners = mesh.isMoving() && triangles > 0 ? Triangles::corners(mesh) : nullptr;
    spheres.update(loops.kernels.spheres, atom.x[0], atom.radius, corners, triangles, neighbor.skin / 4.0);
  }
};

/// The spheres in contact with a mesh, once per contact: in the last step of our loop, and in the step before.
struct Touching {
  bigint step = -1;
  std::vector<int> spheres, before;
};

/// A sphere and a triangle that it reaches.
struct Reached {
  int triangle, i;
  int before;  // the place of the same sphere at another triangle, or -1
  bool is_face, is_contact;
  double gap, delta[3], weight[3];
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
  NearMesh near;
  Touching touching;
  std::vector<Reached> reached{};

  /// Chooses the contacts among all that is reached, and gives them the records of contacts that end.
  void find_contacts(TriMesh& mesh, FixContactHistoryMesh* history, const LAMMPS_NS::Atom& atom);

 private:
  std::vector<int> last_;  // of each sphere: its last place in `reached`
  std::vector<kernels::TriangleContact> near_, found_;
  std::vector<int> recorded_, now_;
};

void MeshState::find_contacts(TriMesh& mesh, FixContactHistoryMesh* history, const LAMMPS_NS::Atom& atom) {
  last_.assign(atom.nlocal, -1);
  for (std::size_t k = 0; k < reached.size(); ++k) {
    reached[k].before = last_[reached[k].i];
    last_[reached[k].i] = static_cast<int>(k);
  }
  const auto triangle_of = [&](int t) { return kernels::Triangle(Triangles::corners(mesh) + 9L * t); };
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const int i = reached[k].i;
    if (last_[i] != static_cast<int>(k)) continue;
    const Vec<double> x = vector_of(atom.x[i]);
    now_.assign(1, reached[k].triangle);
    if (reached[k].before >= 0) {
      near_.clear();
      for (int c = last_[i]; c >= 0; c = reached[c].before)
        near_.push_back({reached[c].triangle, reached[c].gap + atom.radius[i], -vector_of(reached[c].delta)});
      kernels::find_contacts(x, near_, triangle_of, found_);
      now_.clear();
      for (const kernels::TriangleContact& c : found_) now_.push_back(c.triangle);
      for (int c = last_[i]; c >= 0; c = reached[c].before)
        reached[c].is_contact = std::find(now_.begin(), now_.end(), reached[c].triangle) != now_.end();
    }
    if (!history || Contacts::count(*history)[i] == 0) continue;
    int* const ids = Contacts::triangles(*history, i);
    int* const end = ids + history->nneighs(i);
    const auto has_record = [&](int t) { return std::find(ids, end, mesh.id(t)) != end; };
    if (std::all_of(now_.begin(), now_.end(), has_record)) continue;
    recorded_.clear();
    for (const int* id = ids; id != end; ++id) {
      double least = std::numeric_limits<double>::max();
      recorded_.push_back(-1);
      for (int copy = 0; copy < (*id < 0 ? 0 : mesh.map_size(*id)); ++copy) {  // across periodic faces
        const int t = mesh.map(*id, copy);
        const double distance = length(triangle_of(t).to(x));
        if (distance >= least) continue;
        least = distance;
        recorded_.back() = t;
      }
    }
    kernels::pass_records(recorded_, now_, atom.radius[i], triangle_of,
                          [&](std::size_t record, std::size_t contact) { ids[record] = mesh.id(now_[contact]); });
  }
}

}  // namespace epdem::liggghts::loop

namespace LAMMPS_NS {

namespace loop = epdem::liggghts::loop;

/// LIGGGHTS gives a wall its velocity in the first step of a run. Contacts are computed before it, too, for output and
/// after a restart file: a step of no duration gives the velocity and moves nothing.
[[gnu::visibility("default")]] void FixMoveMesh::setup(int vflag) {
  static const auto original = loop::next<FixMoveMesh*, int>("_ZN9LAMMPS_NS11FixMoveMesh5setupEi");
  original(this, vflag);
  if (!epdem::liggghts::library_matches(lmp) || !epdem::liggghts::Simulation::find(lmp)) return;
  const double dt = update->dt;
  update->dt = 0.0;
  initial_integrate(0);
  update->dt = dt;
}

/// LIGGGHTS takes the torque on a mesh at its surface. A contact of our models has one point for force, velocity and
/// torque, in the middle of the overlap.
[[gnu::visibility("default")]] void FixMeshSurface::add_particle_contribution(int i, double* force, double* to_wall,
                                                                              int triangle, double* v_wall) {
  static const auto original = loop::next<FixMeshSurface*, int, double*, double*, int, double*>(
      "_ZN9LAMMPS_NS14FixMeshSurface25add_particle_contributionEiPdS1_iS1_");
  if (!epdem::liggghts::library_matches(lmp) || !epdem::liggghts::Simulation::find(lmp))
    return original(this, i, force, to_wall, triangle, v_wall);
  const auto surface = epdem::liggghts::vector_of(to_wall);
  const auto more = epdem::to_middle(atom->radius[i] - length(surface), -surface);
  double to_middle[3] = {surface.x + more.x, surface.y + more.y, surface.z + more.z};
  original(this, i, force, to_middle, triangle, v_wall);
}

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
  bool is_ours = wall && epdem::liggghts::library_matches(lmp) && atom->sphere_flag && !atom->shapetype_flag;
  for (int m = 0; m < n_FixMesh_; ++m) {
    TriMesh& mesh = *FixMesh_list_[m]->triMesh();
    is_ours &= !mesh.isDeforming() && !mesh.isScaling() && !FixMesh_list_[m]->meshMulticontactData();
  }
  if (!is_ours || atom->nlocal == 0) return original(this, vflag);
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
    const bool settled = loops && loop::settled(touching, *update, *neighbor);
    if (history) settled ? loop::Contacts::unmark(*history, touching.before) : history->markAllContacts();
    if (store_force_contact_) fix_wallforce_contact_ = fix.meshforceContact();
    if (store_force_contact_stress_) fix_wallforce_contact_stress_ = fix.meshforceContactStress();
    atom_type_wall_ = fix.atomTypeWall();
    const auto velocities = mesh.prop().getElementProperty<MultiVectorContainer<double, 3, 3>>("v");
    double*** const v = velocities ? velocities->begin() : nullptr;
    double v_wall[3] = {};
    contact.mesh = &mesh;
    contact.fix_mesh = &fix;
    std::vector<loop::Reached>& reached = kept[m]->reached;
    reached.clear();
    const double at_distance = neighbor->contactDistanceFactor - 1.0;
    const auto resolve = [&](int triangle, int i) {
      int side;
      loop::Reached r{triangle, i, -1, false, true, 0.0, {}, {}};
      r.gap = mesh.resolveTriSphereContactBary(i, triangle, atom->radius[i], atom->x[i], r.delta, r.weight, side);
      constexpr int face = 7;  // of LIGGGHTS's sides
      r.is_face = side == face;
      if (r.gap <= 0.0 || r.gap < at_distance * atom->radius[i]) reached.push_back(r);
    };
    if (loops) {
      loop::NearMesh& near = kept[m]->near;
      near.update(mesh, *fix.meshNeighlist(), *atom, *loops, *neighbor);
      near.spheres.each(loops->kernels.spheres, resolve);
    } else {
      const auto& listed = loop::Lists::of(*fix.meshNeighlist());
      const int triangles = std::min(mesh.sizeLocal() + mesh.sizeGhost(), static_cast<int>(listed.size()));
      for (int t = 0; t < triangles; ++t)
        for (const int i : listed[t].contacts)
          if (i < atom->nlocal) resolve(t, i);
    }
    kept[m]->find_contacts(mesh, history, *atom);
    for (loop::Reached& r : reached) {
      if (!r.is_contact) continue;
      const bool intersects = r.gap <= 0.0;
      contact.i = r.i;
      contact.radi = atom->radius[r.i];
      if (history) {
        if (!history->handleContact(r.i, mesh.id(r.triangle), contact.contact_history, intersects, r.is_face)) continue;
        touching.spheres.push_back(r.i);
      }
      for (int x = 0; x < 3; ++x) {
        if (v)
          v_wall[x] =
              r.weight[0] * v[r.triangle][0][x] + r.weight[1] * v[r.triangle][1][x] + r.weight[2] * v[r.triangle][2][x];
        contact.delta[x] = -r.delta[x];
      }
      contact.deltan = -r.gap;
      impl->compute_force(this, contact, intersects, v_wall, &fix, m, &mesh, r.triangle);
    }
    if (!history) continue;
    settled ? loop::Contacts::end_unmarked(*history, touching.before) : history->cleanUpContacts();
    touching.step = update->ntimestep;
  }
}

}  // namespace LAMMPS_NS
#endif
