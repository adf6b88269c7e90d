// SPDX-License-Identifier: GPL-2.0-or-later
// Heat of spheres in LIGGGHTS: fix heat/ep.
#pragma once

#include "host.hpp"
#include "kernels/heat.hpp"

namespace epdem::liggghts {

/// Makes the plugin's fixes known to a simulation.
void add_fix_styles(LAMMPS_NS::LAMMPS* lmp);

/// fix ID all heat/ep SHARE k c [k c ...] [wall NAME T k ...]: conductivity and specific heat of each type; NAME: a fix
/// wall/gran of a formula, or a fix mesh/surface, with a temperature. fix_modify ID temperature FROM TO T: spheres with
/// these numbers. Vector: the heat flow into each wall in the last step. A fix property/atom temperature holds the
/// temperatures; fix insert sets it by `set_property temperature T`.
class FixHeat final : public LAMMPS_NS::Fix {
 public:
  FixHeat(LAMMPS_NS::LAMMPS* lmp, int count, char** word);

  /// Before each run of a contact model, which computes areas or not: the fix of a simulation; null: none.
  static FixHeat* of(LAMMPS_NS::LAMMPS* lmp, bool computes_areas);

  /// At the start of a kept pass over all pairs: gives ghosts their temperatures. Collective.
  void open();
  kernels::Heat& sums() { return sums_; }
  /// Adds a contact with a wall, which is a mesh or else a formula.
  void add_wall(int i, const LAMMPS_NS::FixMeshSurface* mesh, const LAMMPS_NS::FixWallGran& wall, double radius);

  int setmask() override { return LAMMPS_NS::FixConst::END_OF_STEP; }
  void post_create() override;
  void init() override;
  void end_of_step() override;
  double compute_vector(int wall) override;
  int modify_param(int count, char** word) override;
  void set_arrays(int i) override;

 private:
  /// Plastic and frictional work of the contacts of a sphere since the start.
  double work_of(int i) const { return work_->vector_atom[i] + (friction_ ? friction_->vector_atom[i] : 0.0); }
  LAMMPS_NS::FixPropertyAtom* find(const char* name);

  kernels::Heat sums_;
  LAMMPS_NS::FixPropertyAtom *temperature_ = nullptr, *work_ = nullptr, *friction_ = nullptr;
};

}  // namespace epdem::liggghts
