// SPDX-License-Identifier: GPL-2.0-or-later
// Heat of spheres: conduction through the area of their contacts, and a share of the plastic and frictional work.
#pragma once

#include "fix.h"
#include "fix_history.hpp"
#include "kernels/heat.hpp"
#include "modify.h"

namespace epdem::lammps {

/// fix ID all heat/ep SHARE k c [k c ...] [wall FIX T k ...]: conductivity and specific heat of each type; FIX: a wall
/// with a temperature. fix_modify ID temperature FROM TO T: spheres with these numbers. vector_atom: temperatures;
/// vector: the heat flow into each wall in the last step.
class FixHeat final : public LAMMPS_NS::Fix {
 public:
  static constexpr const char* style_name = "heat/ep";

  FixHeat(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  ~FixHeat() override;

  /// The fix of a simulation; null: none.
  static FixHeat* of(const LAMMPS_NS::Modify& modify);

  /// At the start of an evaluation: gives ghosts their temperatures. Collective.
  void open();
  void add_pairs(const kernels::Block& b, int n) { heat_.add_pairs(b, n); }
  /// Adds the heat of n contacts with the wall of a fix.
  void add_wall(const kernels::Block& b, int n, const char* fix);

  int setmask() override { return LAMMPS_NS::FixConst::END_OF_STEP; }
  void init() override;
  void end_of_step() override;
  double compute_vector(int wall) override;
  int modify_param(int count, char** word) override;

  int pack_forward_comm(int n, int* atoms, double* buffer, int, int*) override;
  void unpack_forward_comm(int n, int first, double* buffer) override;
  void grow_arrays(int atoms) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override;
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;
  int pack_restart(int i, double* buffer) override;
  void unpack_restart(int i, int nth) override;
  int size_restart(int) override { return 2; }
  int maxsize_restart() override { return 2; }
  double memory_usage() override;

 private:
  kernels::Heat heat_;
  const FixHistory* history_ = nullptr;
};

}  // namespace epdem::lammps
