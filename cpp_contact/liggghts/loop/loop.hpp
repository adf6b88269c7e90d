// SPDX-License-Identifier: GPL-2.0-or-later
// The pair loop for throughput: which neighbours touch, without a branch; contacts computed as lanes; forces added in
// the order of LIGGGHTS's own loop, so that not one bit differs.
#pragma once

#include <memory>
#include <vector>

#include "energy_tally.hpp"
#include "epdem/exists.hpp"
#include "growth.hpp"
#include "heat.hpp"
#include "kernels/pair_list.hpp"
#include "state.hpp"
#include "strain.hpp"

namespace epdem::liggghts {
class NormalModel;
}

namespace epdem::liggghts::loop {

/// Settings and properties of a run.
struct Plan {
  Kernel kernel = nullptr;
  const SphereKernels* spheres = nullptr;
  int friction = 0;  // place in Frictions
  ContactSettings settings{};
  bool rolls = false;                  // rolling friction has a history
  bool adds_friction = false;          // friction computes its work
  EnergyTally* tally = nullptr;        // where plastic work is added, if it is requested
  LargestStrain* strain = nullptr;     // where the largest strain is noted, if it is requested
  FixHeat* heat = nullptr;             // of the spheres, with temperatures
  Growth* growth = nullptr;            // of the spheres, with compaction
  const NormalModel* judge = nullptr;  // of the adhesion of contacts, if it can refuse one
  GapPlaces gap;                       // in a history
  int last_step = -1;                  // place in a history
  int width = 0;                       // number of types + 1
  std::vector<double> constants;       // most_constants for each type of i * width + type of j; see Constant
};

/// Why the atoms of a run, or what it stores of its contacts, keep pairs and walls from our loops; nullptr: nothing.
const char* obstacle_of_both(const LAMMPS_NS::Atom& atom, bool rigid, bool stores, bool sums);

/// Whether a step changes no history, or no number can be read behind the last atom: rare, and no reason is given.
bool beside_the_steps(const LAMMPS_NS::Atom& atom, bool computes, bool shears);

/// The pass of a step of length dt, without the values of pairs.
Pass pass_of(const LAMMPS_NS::Atom& atom, const Plan& plan, double dt);

/// Notes the largest strain of the contacts of a block.
void note_strain(LargestStrain& strain, const Block& block);

/// Bodies in contact: bodies that overlap; also bodies that adhere across a gap; also bodies whose growth closes a gap.
enum class Reach { touching, attached, grown };

class PairLoop : protected LAMMPS_NS::Pointers {
 public:
  explicit PairLoop(LAMMPS_NS::LAMMPS* lmp) : Pointers(lmp), block_(std::make_unique<Block>()) {}

  /// Why this step cannot take this loop; nullptr: it can.
  const char* obstacle(LAMMPS_NS::PairGran* pair, const Plan& plan, int vflag, int addflag) const;

  /// At the start of each run: LIGGGHTS makes new lists.
  void forget_lists() { listed_ = -1; }

  /// All forces between pairs; `now` is the step.
  void run(LAMMPS_NS::PairGran* pair, const Plan& plan, double now);

 private:
  void read_lists(const Growth* growth);
  void begin_pass();
  template <Reach reach>
  void gather(const Plan& plan);
  template <Reach reach>
  void finish(const Plan& plan, int n);
  bool stands_across_gap(const Plan& plan, int i, int j, int slot, bool marked) const;
  void fetch(const Plan& plan, int n);
  void judge(const Plan& plan, int n) const;
  template <bool torques, bool tallies, Reach reach>
  void scatter(const Plan& plan, int n);
  void add_friction(EnergyTally& tally, int n);

  const std::unique_ptr<Block> block_;
  int place_[block_size + most_lanes];  // in the list
  PairList pairs_;
  std::vector<int> slots_;         // of the pairs, in the list of their first sphere
  LAMMPS_NS::bigint listed_ = -1;  // step in which LIGGGHTS made its lists
  LAMMPS_NS::bigint passed_ = -1;  // step of the last pass over pairs_, with growth
  double listed_factor_ = 0.0;     // up to which pairs_ holds all pairs that meet
  Pass pass_{};
  LAMMPS_NS::PairGran* pair_ = nullptr;
  int flags_ = 0;
  bool mixed_ = false;  // spheres of several types
};

}  // namespace epdem::liggghts::loop
