// SPDX-License-Identifier: GPL-2.0-or-later
// Walls of triangles from an STL file.
#pragma once

#include <memory>
#include <vector>

#include "fix_wall.hpp"

namespace epdem::lammps {

/// A surface of triangles with the motion of a region of LAMMPS.
class MeshRegion;

/// fix ID group wall/ep mesh FILE [move VX VY VZ] [rotate V PX PY PZ AX AY AZ] LAW ...: words of a region's motion.
class FixWallMesh : public FixWallRegion {
 public:
  FixWallMesh(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  ~FixWallMesh() override;

 protected:
  LAMMPS_NS::Region* find_region() override;
  void begin_search(bool holds) override;
  void find(int i, std::vector<Contact>& found) override;
  bool is_near(int i, double distance) override;

 private:
  void pass_records(int i, const std::vector<Contact>& found);

  std::unique_ptr<MeshRegion> mesh_;
  bool lists_hold_ = false;             // until the next search
  std::vector<std::vector<int>> near_;  // by atom: triangles that it can touch until then
  std::vector<int> listed_;             // atoms with triangles in near_
};

}  // namespace epdem::lammps
