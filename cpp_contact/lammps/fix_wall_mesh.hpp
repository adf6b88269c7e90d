// SPDX-License-Identifier: GPL-2.0-or-later
// Walls of triangles from an STL file, and a table of their triangles.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compute.h"
#include "fix_wall.hpp"

namespace epdem::lammps {

/// A surface of triangles with the motion of a region of LAMMPS.
class MeshRegion;

/// fix ID group wall/ep mesh FILE [move VX VY VZ] [rotate V PX PY PZ AX AY AZ] [wear K] LAW ...: words of a region's
/// motion, constant of Finnie's law [length^2/force].
class FixWallMesh : public FixWallRegion {
 public:
  FixWallMesh(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  ~FixWallMesh() override;

  static constexpr int table_columns = 5;
  /// From the next step on the forces of the triangles are summed.
  void sum_forces() { sums_ = true; }
  /// On rank 0 a row of each triangle: number, area, normal and shear stress in this step, depth worn so far.
  /// Collective.
  std::vector<double> table() const;

 protected:
  LAMMPS_NS::Region* find_region() override;
  void begin_search(bool holds) override;
  void find(int i, std::vector<Contact>& found) override;
  bool is_near(int i, double distance) override;
  void begin() override;
  void note_forces(const kernels::Block& b, int n) override;
  void add_to_restart(std::vector<double>& values) override;
  void take_from_restart(const double* values) override;

 private:
  std::vector<double> sum(const std::vector<double>& of_rank) const;
  void pass_records(int i, const std::vector<Contact>& found);

  std::unique_ptr<MeshRegion> mesh_;
  bool lists_hold_ = false;             // until the next search
  std::vector<std::vector<int>> near_;  // by atom: triangles that it can touch until then
  std::vector<int> listed_;             // atoms with triangles in near_
  double wear_ = 0.0;                   // constant of Finnie's law
  bool sums_ = false;                   // a table is requested
  std::vector<int> pressed_;            // triangles with a force in this step
  std::vector<double> force_, worn_;    // of each triangle: three components, volume; worn_ is empty without wear
};

/// compute ID GROUP triangles/ep FIX: a local table of the triangles of a wall, in the order of their file.
class ComputeTriangles final : public LAMMPS_NS::Compute {
 public:
  static constexpr const char* style_name = "triangles/ep";
  ComputeTriangles(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  void init() override;
  void compute_local() override;

 private:
  const std::string name_;
  FixWallMesh* wall_ = nullptr;
  std::vector<double> values_;
  std::vector<double*> rows_;
};

}  // namespace epdem::lammps
