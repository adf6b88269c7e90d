// SPDX-License-Identifier: GPL-2.0-or-later
#include "wall.hpp"

#include <mesh_module_stress.h>

#include <algorithm>
#include <string>

#include "epdem/kinematics.hpp"
#include "triangles.hpp"

#ifdef EPDEM_BUILT_FOR

namespace epdem::liggghts::loop {

using LAMMPS_NS::FixWallGran;

const char* WallLoop::obstacle(FixWallGran& wall, const Plan& plan) const {
  const bool stores = wall.store_force_contact() || wall.store_force_contact_stress();
  if (const char* why = obstacle_of_both(*atom, wall.fix_rigid(), stores, wall.store_sum_normal_force())) return why;
  if (wall.heattransfer_flag()) return "heat that walls conduct";
  if (neighbor->contactDistanceFactor != 1.0 && !plan.gap.any()) return "contacts at a distance";
  if (wall.compute_wall_gran_local() && wall.addflag()) return "steps of compute wall/gran/local";
  return beside_the_steps(*atom, wall.computeflag(), wall.shearupdate()) ? "" : nullptr;
}

void WallLoop::open(FixWallGran& wall, const Plan& plan) {
  if (atom->nlocal == 0) return;
  wall_ = &wall;
  plan_ = &plan;
  pass_ = pass_of(*atom, plan, update->dt);
  pass_.sums = plan.growth ? plan.growth->of_all() : nullptr;
}

void WallLoop::close() {
  compute();
  wall_ = nullptr;
}

bool WallLoop::stands_across_gap(const LIGGGHTS::ContactModels::SurfacesIntersectData& s) const {
  if (!plan_->growth) return false;
  const double r = s.radi - s.deltan;
  return exists(plan_->gap, s.contact_history, {r * r, s.radi, 0.0, plan_->growth->of(s.i), {}}, false);
}

void WallLoop::note(const LIGGGHTS::ContactModels::SurfacesIntersectData& s, const double* v_wall,
                    LAMMPS_NS::FixMeshSurface* mesh, int triangle) {
  Block& b = *block_;
  const int k = n_++;
  b.i[k] = s.i;
  b.history[k] = s.contact_history;
  b.material[k] = plan_->constants.data() + most_constants * (atom->type[s.i] * plan_->width + wall_->atom_type_wall());
  b.radius_i.a[k] = s.radi;
  b.mass_i.a[k] = atom->rmass[s.i];
  b.overlap.a[k] = s.deltan;
  for (int x = 0; x < 3; ++x) {
    b.from_wall[x].a[k] = s.delta[x];
    b.wall_v[x].a[k] = v_wall[x];
  }
  mesh_[k] = mesh;
  triangle_[k] = triangle;
  if (n_ == block_size) compute();
}

void WallLoop::compute() {
  if (n_ == 0) return;
  Block& b = *block_;
  pass_.several = std::any_of(b.material, b.material + n_, [&](const double* m) { return m != b.material[0]; });
  pad(b, n_);
  plan_->kernel(b, n_, pass_);
  if (plan_->strain) note_strain(*plan_->strain, b);
  scatter();
  n_ = 0;
}

/// Forces and torques in the order of LIGGGHTS's loop, and who asks for them: the tally, forces of the wall, the mesh.
void WallLoop::scatter() {
  const Block& b = *block_;
  const bool turns = plan_->friction || plan_->settings.rolling;
  for (int k = 0; k < n_; ++k) {
    const int i = b.i[k];
    double *const f = atom->f[i], *const t = atom->torque[i];
    double share[3];
    for (int x = 0; x < 3; ++x) {
      const double before = f[x];
      f[x] += b.force[x].a[k];
      share[x] = f[x] - before;
      if (turns) t[x] += b.torque_i[x].a[k];
    }
    if (wall_->store_force())
      for (int x = 0; x < 3; ++x) wall_->fix_wallforce()->array_atom[i][x] += share[x];
    if (mesh_[k]) {
      double to_wall[3], v[3];
      for (int x = 0; x < 3; ++x) {
        to_wall[x] = -b.from_wall[x].a[k];
        v[x] = b.wall_v[x].a[k];
      }
      mesh_[k]->add_particle_contribution(i, share, to_wall, triangle_[k], v);
    }
    if (plan_->settings.rolling) {
      const auto part = [k](const auto& lines) { return Vec<double>{lines[0].a[k], lines[1].a[k], lines[2].a[k]}; };
      add_couple(i, mesh_[k], b.overlap.a[k], part(b.from_wall), part(b.force), part(b.torque_i));
    }
    if (plan_->growth)
      for (int c = 0; c < dent_sums; ++c) plan_->growth->sums()[dent_sums * long(i) + c] += b.dents_i[c].a[k];
    const double radius = b.contact_radius.a[k];
    if (plan_->heat) plan_->heat->add_wall(i, mesh_[k], *wall_, radius);
    if (!plan_->tally) continue;
    plan_->tally->credit(i, b.plastic_work_step.a[k], b.stored_energy.a[k], radius > 0.0);
    if (plan_->adds_friction)
      plan_->tally->add_friction(true, b.friction_work.a[k], b.spring_energy.a[k], {i, i, atom->nlocal});
  }
}

void WallLoop::find_couples(const FixWallGran& wall) {
  coupled_ = nullptr;
  const std::string name = std::string("couple_") + wall.id;
  const auto* const kept = modify->find_fix_property(name.c_str(), "property/atom", "vector", 3, 0, "epdem", false);
  couples_ = kept ? kept->array_atom : nullptr;
  if (couples_ && atom->nlocal) std::fill_n(couples_[0], 3L * atom->nlocal, 0.0);
}

void WallLoop::add_couple(int i, LAMMPS_NS::FixMeshSurface* mesh, double overlap, const Vec<double>& from_wall,
                          const Vec<double>& force, const Vec<double>& torque) {
  const Vec<double> couple = torque - cross(to_middle(overlap, from_wall) - from_wall, force);
  if (mesh) {
    double none[3] = {}, on_wall[3] = {-couple.x, -couple.y, -couple.z};
    if (mesh != coupled_) {  // a search by name
      coupled_ = mesh;
      stress_ = dynamic_cast<LAMMPS_NS::MeshModuleStress*>(mesh->get_module("stress"));
    }
    if (stress_) stress_->add_global_external_contribution(none, on_wall);
  } else if (couples_) {
    const double of_axes[] = {couple.x, couple.y, couple.z};
    for (int x = 0; x < 3; ++x) couples_[i][x] += of_axes[x];
  }
}

bool Wall::velocity_in_middle(const SurfacesIntersectData& s, const double* at_surface, LAMMPS_NS::TriMesh& mesh,
                              int triangle, double* v) {
  if (moving_ != &mesh) {
    const auto velocities = mesh.prop().getElementProperty<LAMMPS_NS::MultiVectorContainer<double, 3, 3>>("v");
    moving_ = &mesh;
    rates_ = velocities ? velocities->begin() : nullptr;
  }
  if (!rates_) return false;
  double** const rate = rates_[triangle];
  const double* const corner = Triangles::corners(mesh) + 9L * triangle;
  const auto edge = [&](int k) { return vector_of(corner + 3 * k) - vector_of(corner); };
  const auto edge_rate = [&](int k) { return vector_of(rate[k]) - vector_of(rate[0]); };
  const Vec<double> spin = spin_of_triangle(edge(1), edge(2), edge_rate(1), edge_rate(2));
  const Vec<double> more = cross(spin, to_middle(s.deltan, vector_of(s.delta)));
  v[0] = at_surface[0] + more.x;
  v[1] = at_surface[1] + more.y;
  v[2] = at_surface[2] + more.z;
  return true;
}

}  // namespace epdem::liggghts::loop
#endif
