// SPDX-License-Identifier: BSD-3-Clause
// Whether bodies that do not overlap are in contact: the one test of all hosts, on histories as numbers in memory.
#pragma once

#include <cstddef>

#include "compaction.hpp"

namespace epdem {

/// Places in a history of the values that hold bodies across a gap; -1: it has none.
struct GapPlaces {
  int root = -1, jump = -1;  // with adhesion
  int growth = -1;           // of GrowthState, with compaction

  /// Whether bodies can be in contact across a gap.
  bool any() const noexcept { return root >= 0 || growth >= 0; }
};

/// The places in a history that begins with the values of the law.
template <class Law>
constexpr GapPlaces gap_places(int growth = -1) noexcept {
  GapPlaces at;
  if constexpr (adheres<Law>) {
    at.root = offsetof(State<Law>, root) / sizeof(Number<Law>);
    at.jump = offsetof(State<Law>, jump) / sizeof(Number<Law>);
  }
  at.growth = growth;
  return at;
}

/// Two bodies apart; a wall has the radius 0 and no sums.
struct Gap {
  double rsq;                 // square of the distance of the centres, or of centre and wall [m^2]
  double radius_i, radius_j;  // [m]
  BodySums<double> i, j;      // with compaction
};

/// Whether bodies are attached across the gap, or grown across it. history: null of a new contact; repeats: the last
/// step is evaluated once more, where bodies that have just parted still have their last force.
inline bool exists(const GapPlaces& at, const double* history, const Gap& gap, bool repeats) noexcept {
  if (history && at.root >= 0 && (history[at.root] > 0.0 || (repeats && history[at.jump] != 0.0))) return true;
  if (at.growth < 0) return false;
  if (repeats && !history) return false;
  const auto c = growing_pair(gap.radius_i, gap.radius_j, gap.i, gap.j, history ? history + at.growth : nullptr);
  return gap.radius_i + gap.radius_j - sqrt(gap.rsq) + added_overlap(c, repeats).extrapolated > 0.0;
}

}  // namespace epdem
