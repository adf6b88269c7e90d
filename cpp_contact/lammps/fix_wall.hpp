// SPDX-License-Identifier: GPL-2.0-or-later
// Walls: planes, and every region of LAMMPS.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atom.h"
#include "fix.h"
#include "pair_ep.hpp"
#include "region.h"
#include "words.hpp"

namespace epdem::lammps {

/// Contacts of spheres with a wall. The words of the fix give the material of the wall and the coefficients; pair_style
/// ep gives the material of the spheres. Only candidates are looked at: spheres that can touch the wall before LAMMPS
/// makes the next neighbor lists.
class FixWall : public LAMMPS_NS::Fix {
 public:
  ~FixWall() override;

  int setmask() override;
  void init() override;
  void setup_post_neighbor() override { post_neighbor(); }
  void post_neighbor() override { candidates_valid_ = false; }
  void setup(int vflag) override { post_force(vflag); }
  void post_force(int vflag) override;
  /// Force of the wall on all spheres, their torque about the origin with that of rolling friction, power of the wall
  /// without it.
  double compute_vector(int axis) override;

  void grow_arrays(int atoms) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override;
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;
  int pack_restart(int i, double* buffer) override;
  void unpack_restart(int i, int nth) override;
  int size_restart(int i) override;
  int maxsize_restart() override { return 2 + most_ * stride_; }
  double memory_usage() override;

 protected:
  /// A contact of a sphere with one part of the wall.
  struct Contact {
    int part;
    double distance;
    double from_wall[3], velocity[3];
  };

  FixWall(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  /// Reads the words from number `first` on; a sphere has at most `most` contacts with the wall.
  void read(int first, int count, char** word, int most);

  /// Called before the first sphere of a step.
  virtual void begin() {}
  /// Distance [length] up to which `find` looks for parts of the wall: with adhesion across gaps, too.
  double reach_of(int i) const { return atom->radius[i] * reach_factor_ + reach_; }
  /// Finds the contacts of sphere i, at most `most`.
  virtual void find(int i, std::vector<Contact>& found) = 0;
  /// Whether the centre of sphere i is within this distance of the surface, on either side [length].
  virtual bool is_near(int i, double distance) = 0;
  /// Whether the wall has another shape or place in each step.
  virtual bool moves() const { return false; }
  /// Notes the placement of a wall that moves.
  virtual void note_placement() {}
  /// Upper limit of the way of the surface since its placement was noted [length].
  virtual double way() const { return 0.0; }
  /// Called with n contacts that have their forces.
  virtual void note_forces(const kernels::Block&, int /*n*/) {}
  /// Called before candidates are chosen; holds: until they are chosen again, no other sphere can touch the wall.
  virtual void begin_search(bool /*holds*/) {}

  /// Number k of the records of a sphere, one of each contact: number of the part, history.
  double* record(int i, int k) { return held_[i].data() + long(k) * stride_; }
  int count(int i) const { return static_cast<int>(held_[i].size()) / stride_; }
  bool has_records_of(int i, const std::vector<Contact>& found);

  const std::string place_;

 private:
  std::vector<int> types_of_group() const;
  void choose_candidates();
  void drop_parted(int i, std::vector<Contact>& found);
  bool stands(int i, const Contact& c);
  void keep_records(int i, const std::vector<Contact>& found);
  void finish(int n);
  void note(int n);

  AdhesionJudge judge_;
  Words words_;
  Layout layout_;
  int most_ = 0, stride_ = 0;
  double reach_ = 0.0;  // beyond the radius [length]
  double reach_factor_ = 1.0;
  std::vector<std::vector<double>> held_;  // by atom
  std::vector<int> candidates_;
  bool candidates_valid_ = false;
  bool claimed_ = false;  // its contacts of a restart file, if there is one
  PairEp* pair_ = nullptr;
  FixHeat* heat_ = nullptr;
  std::vector<double> constants_;   // by type
  kernels::Kernel kernel_[2] = {};  // the second one is complete
  kernels::Pass pass_{};
  std::unique_ptr<kernels::Block> block_;
  std::vector<double> copies_[2], scratch_;
  static constexpr int sums = 7, local_columns = 16;
  double sum_[sums] = {}, total_[sums] = {};
  std::vector<double> local_;  // of each contact: rows of `note`
  std::vector<double*> local_row_;
  LAMMPS_NS::bigint summed_ = -1;
};

/// fix ID group wall/ep xplane|yplane|zplane lo|NULL hi|NULL LAW ...
class FixWallPlanes : public FixWall {
 public:
  static constexpr const char* style_name = "wall/ep";
  FixWallPlanes(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  void init() override;

 protected:
  void find(int i, std::vector<Contact>& found) override;
  bool is_near(int i, double distance) override;

 private:
  int axis_ = 0;
  double low_, high_;
};

/// fix ID group wall/ep/region REGION LAW ...
class FixWallRegion : public FixWall {
 public:
  static constexpr const char* style_name = "wall/ep/region";
  FixWallRegion(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  void init() override;
  void write_restart(FILE* file) override;
  void restart(char* stored) override;

 protected:
  /// Of a wall that has its own region.
  struct OwnRegion {};
  FixWallRegion(LAMMPS_NS::LAMMPS* lmp, int count, char** word, OwnRegion);

  /// The region at the begin of a run.
  virtual LAMMPS_NS::Region* find_region();
  void begin() override;
  void find(int i, std::vector<Contact>& found) override;
  bool is_near(int i, double distance) override;
  bool moves() const override { return moves_; }
  void note_placement() override;
  double way() const override;
  /// Values of a restart file beside the motion. Collective.
  virtual void add_to_restart(std::vector<double>&) {}
  virtual void take_from_restart(const double*) {}

 private:
  void exchange_motion(bool recalls);

  const std::string name_;
  /// Placement of a part of the region when candidates were chosen.
  struct Placement {
    double shift[3], angle;
    double lever;  // largest distance of a sphere from the axis [length]
  };

  LAMMPS_NS::Region* region_ = nullptr;
  bool moves_ = false;
  std::vector<LAMMPS_NS::Region*> parts_;  // the region, and regions that it is made of
  std::vector<Placement> placements_;
  static constexpr int numbers_of_motion = 7;
  std::vector<double> motion_;  // in the last step: velocity, spin, growth of a radius of the region and of its parts
};

}  // namespace epdem::lammps
