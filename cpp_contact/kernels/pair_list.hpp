// SPDX-License-Identifier: BSD-3-Clause
// The pairs of a host's neighbor lists side by side in memory, and their way into blocks. For hosts alone: sources that
// are compiled for newer processors hold no inline function that others share.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/block.hpp"

namespace epdem::kernels {

/// Whether two spheres cannot touch while their distance shrinks by at most `way` and the sum of their radii grows to
/// at most `reach` times `radii`.
inline bool is_far(const double* xi, const double* xj, double radii, double reach, double way) {
  const double dx = xi[0] - xj[0], dy = xi[1] - xj[1], dz = xi[2] - xj[2], most = reach * radii + way;
  return dx * dx + dy * dy + dz * dz > most * most;
}

/// Pairs in the order of the neighbor lists; the place of a pair is its number in this order.
class PairList {
 public:
  /// Begins a list for this number of spheres.
  void clear(int spheres) {
    i_.clear();
    j_.clear();
    first_.assign(spheres, 0);
    count_ = 0;
  }

  /// Begins the pairs of sphere i.
  void begin(int i) { first_[i] = count_; }

  /// Adds a pair of the sphere that `begin` named.
  void add(int i, int j) {
    i_.push_back(i);
    j_.push_back(j);
    ++count_;
  }

  /// Ends the list.
  void close() {
    for (std::vector<int>* spheres : {&i_, &j_}) spheres->insert(spheres->end(), most_lanes, 0);
    in_contact_.assign(i_.size(), 0);
    pass_ = 2;
  }

  /// With compaction, before a pass over the pairs.
  void begin_pass() { ++pass_; }

  /// The pairs that were in contact in the pass before, where `note` has not been told.
  template <class Known>
  void recall(Known known) {
    for (int place = 0; place < count_; ++place) in_contact_[place] = known(place) ? pass_ : 0;
  }

  /// Notes n pairs in contact in this pass.
  void note(const int* place, int n) {
    for (int k = 0; k < n; ++k) in_contact_[place[k]] = pass_;
  }

  int count() const { return count_; }
  int i(int place) const { return i_[place]; }
  int j(int place) const { return j_[place]; }

  /// Place of the pair (i, j) in the list of i; -1: it is not there.
  int find(int i, int j) const {
    for (int place = first_[i]; place < count_ && i_[place] == i; ++place)
      if (j_[place] == j) return place;
    return -1;
  }

  /// A search for the pairs closer than the root of `factor` times the sum of their radii; sums: BodySums, with
  /// compaction.
  PairSearch search(const double* x, const double* radius, double factor, const double* sums = nullptr) const {
    return {x, radius, factor, i_.data(), j_.data(), count_, 0, sums, in_contact_.data(), pass_};
  }

 private:
  std::vector<int> i_, j_, in_contact_;  // most_lanes more than count_
  std::vector<int> first_;               // by sphere
  int count_ = 0, pass_ = 2;
};

/// Has the full vectors of a block's first n contacts computed, moves the others to its begin and returns their number.
template <class Finish>
inline int finish_full(Block& b, int* place, int n, Finish& finish) {
  const int left = n % most_lanes, full = n - left;
  int others[3][most_lanes];  // `finish` pads the block behind its contacts
  int* const numbers[] = {b.i, b.j, place};
  for (int c = 0; c < 3; ++c) std::copy_n(numbers[c] + full, most_lanes, others[c]);
  finish(full);
  for (int c = 0; c < 3; ++c) std::copy_n(others[c], most_lanes, numbers[c]);
  return left;
}

/// Writes the pairs of a search that overlap into the block, their places to `place`, and calls finish(n) for each full
/// block.
template <class Finish>
inline void each_overlap(const SphereKernels& kernels, PairSearch search, Block& b, int* place, Finish finish) {
  static_assert(2 * pairs_at_once <= block_size);
  int n = 0;
  while (search.tested < search.count) {
    n += kernels.next_pairs(search, b.i + n, b.j + n, place + n);
    if (n > block_size - pairs_at_once) n = finish_full(b, place, n, finish);
  }
  finish(n);
}

/// The same with the pairs of the search that do not overlap and for which stands(i, j, place) is true.
template <class Stands, class Finish>
inline void each_contact(const SphereKernels& kernels, PairSearch search, Block& b, int* place, Stands stands,
                         Finish finish) {
  int n = 0;
  while (search.tested < search.count) {
    const int last = n + kernels.next_near_pairs(search, b.i + n, b.j + n, place + n);
    while (n < last && place[n] >= 0) ++n;  // most overlap, and stay where they are
    for (int k = n; k < last; ++k) {
      const int i = b.i[k], j = b.j[k];
      const bool overlaps = place[k] >= 0;
      const int of_pair = overlaps ? place[k] : ~place[k];
      if (!overlaps && !stands(i, j, of_pair)) continue;
      b.i[n] = i;
      b.j[n] = j;
      place[n++] = of_pair;
    }
    if (n > block_size - pairs_at_once) n = finish_full(b, place, n, finish);
  }
  finish(n);
}

}  // namespace epdem::kernels
