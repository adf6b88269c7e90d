// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's wall of one contact model: its loop finds the contacts and their geometry; where our loop can compute
// them, they are noted and computed as lanes, with forces added in the order of LIGGGHTS's loop. In a source tree,
// where nothing stands around LIGGGHTS's loops (mesh.cpp), all is left to them.
#pragma once

#include <memory>
#include <vector>

#include "planned.hpp"
#include "stored_walls.hpp"

#ifdef EPDEM_BUILT_FOR

namespace LAMMPS_NS {
class MeshModuleStress;
}

namespace epdem::liggghts::loop {

/// State of the loop over a mesh of a wall, of mesh.cpp.
struct MeshState;

/// A wall whose contacts are computed in blocks, as LIGGGHTS's loops over walls see it; mesh.cpp stands around them.
class BatchedWall {
 public:
  virtual ~BatchedWall() = default;

  /// Before and after LIGGGHTS's loop over the spheres at a wall.
  virtual void open(LAMMPS_NS::FixWallGran& wall) = 0;
  virtual void close() = 0;

  std::vector<std::shared_ptr<MeshState>> meshes;
};

/// The contacts of walls, noted one by one.
class WallLoop : protected LAMMPS_NS::Pointers {
 public:
  explicit WallLoop(LAMMPS_NS::LAMMPS* lmp) : Pointers(lmp), block_(std::make_unique<Block>()) {}

  /// Why this step cannot take this loop; nullptr: it can.
  const char* obstacle(LAMMPS_NS::FixWallGran& wall, const Plan& plan) const;

  void open(LAMMPS_NS::FixWallGran& wall, const Plan& plan);
  bool is_open() const { return wall_ != nullptr; }
  void close();

  /// Whether growth closes the gap between a sphere and the wall.
  bool stands_across_gap(const LIGGGHTS::ContactModels::SurfacesIntersectData& s) const;

  /// Looks for the fix in which a deck keeps the torque of rolling friction of a wall on each sphere, and empties it.
  void find_couples(const LAMMPS_NS::FixWallGran& wall);

  /// Adds what the torque on a sphere has beside the moment of the force, as rolling friction, to the sums of the wall:
  /// LIGGGHTS's own are those of the forces. from_wall: to the centre of the sphere.
  void add_couple(int i, LAMMPS_NS::FixMeshSurface* mesh, double overlap, const Vec<double>& from_wall,
                  const Vec<double>& force, const Vec<double>& torque);

  /// One sphere in contact with the wall; `triangle` of a mesh, or none.
  void note(const LIGGGHTS::ContactModels::SurfacesIntersectData& s, const double* v_wall,
            LAMMPS_NS::FixMeshSurface* mesh, int triangle);

 private:
  /// All that is noted.
  void compute();
  void scatter();

  const std::unique_ptr<Block> block_;
  LAMMPS_NS::FixMeshSurface* mesh_[block_size];
  int triangle_[block_size];
  Pass pass_{};
  const Plan* plan_ = nullptr;
  LAMMPS_NS::FixWallGran* wall_ = nullptr;
  double** couples_ = nullptr;                    // of rolling friction on each sphere, which a deck asks for by a fix
  LAMMPS_NS::FixMeshSurface* coupled_ = nullptr;  // the mesh of the last couple in this step, and its sums or none
  LAMMPS_NS::MeshModuleStress* stress_ = nullptr;
  int n_ = 0;
};

class Wall : public LIGGGHTS::Walls::Granular<Model>, public BatchedWall, private Planned {
  using Base = LIGGGHTS::Walls::Granular<Model>;

 public:
  Wall(LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::FixWallGran* parent, int64_t hash)
      : Base(lmp, parent, hash),
        Planned(lmp, model_of(static_cast<Base&>(*this)), hash, true),
        stored_(lmp),
        parent_(*parent),
        loop_(lmp) {}

  void init_granular() override {
    Base::init_granular();
    stored_.claim(parent_);
    if (!missing()) prepare();
  }

  void open(LAMMPS_NS::FixWallGran& wall) override {
    moving_ = nullptr;
    if (rolls()) loop_.find_couples(wall);
    const char* why = missing();
    if (!why) why = loop_.obstacle(wall, plan_);
    if (why)
      say(why);
    else
      loop_.open(wall, plan_);
  }
  void close() override { loop_.close(); }

  void compute_force(LAMMPS_NS::FixWallGran* wall, SurfacesIntersectData& s, bool intersects, double* v_wall,
                     LAMMPS_NS::FixMeshSurface* mesh = nullptr, int at = 0, LAMMPS_NS::TriMesh* triangles = nullptr,
                     int triangle = 0) override {
    double v_middle[3];
    if (triangles && intersects && velocity_in_middle(s, v_wall, *triangles, triangle, v_middle)) v_wall = v_middle;
    if (loop_.is_open() && (intersects || loop_.stands_across_gap(s))) return loop_.note(s, v_wall, mesh, triangle);
    const LAMMPS_NS::Atom& atom = atoms();
    const Vec<double> from_wall = vector_of(s.delta), force = vector_of(atom.f[s.i]),
                      torque = vector_of(atom.torque[s.i]);
    const double overlap = s.deltan;
    Base::compute_force(wall, s, intersects, v_wall, mesh, at, triangles, triangle);
    if (rolls() && intersects)
      loop_.add_couple(s.i, mesh, overlap, from_wall, vector_of(atom.f[s.i]) - force,
                       vector_of(atom.torque[s.i]) - torque);
  }

 private:
  /// LIGGGHTS takes the velocity of a mesh at its surface, but the arm of a sphere ends in the middle of the overlap.
  bool velocity_in_middle(const SurfacesIntersectData& s, const double* at_surface, LAMMPS_NS::TriMesh& mesh,
                          int triangle, double* v);

  StoredContacts stored_;
  const LAMMPS_NS::FixWallGran& parent_;
  WallLoop loop_;
  const LAMMPS_NS::TriMesh* moving_ = nullptr;  // the mesh of the last contact in this step; a search by name gives
  double*** rates_ = nullptr;                   // the velocities of its corners, or none
};

}  // namespace epdem::liggghts::loop
#endif
