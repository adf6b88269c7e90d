// SPDX-License-Identifier: BSD-3-Clause
// Loops over spheres beside the loop over contacts, as lanes: half a step of motion, and the search for spheres near a
// sphere or a triangle. Each number has the bits of a loop over single spheres.
#pragma once

namespace epdem::kernels {

/// Half a step of the motion of n spheres; x, v, omega, force and torque are rows of three.
struct HalfStep {
  int n;
  double *x, *v, *omega;  // x may be null: positions stay
  const double *force, *torque, *mass, *radius;
  double dt;           // [time] whole step, for positions
  double dt_force;     // half a step, for velocities
  double dt_torque;    // half a step over the factor of the moment of inertia, for spins
  double mass_factor;  // mass with added mass over mass
};

/// A sphere is near a triangle at a distance below radius * factor + skin, and near a sphere at a distance below the
/// sum of both radii * factor + skin.
struct NearTest {
  const double* spheres;  // rows of position and radius
  double factor, skin;
};

/// Four planes, each by a point and a unit normal: the plane of a triangle, and for each edge the plane through the
/// edge that is normal to the triangle, with its normal outward.
struct TrianglePlanes {
  const double *point[4], *normal[4];
};

constexpr int pairs_at_once = 32;

/// Pairs of neighbours, and the number of them that are tested.
struct PairSearch {
  const double *x, *radius;  // rows of three; one number behind the last row can be read
  double factor;             // a pair meets at a distance below the root of `factor` times the sum of its radii
  const int *i, *j;          // spheres; 8 more can be read
  int count, tested = 0;
  // with compaction: BodySums of all spheres; of each pair the last pass in which it was in contact; this pass
  const double* sums = nullptr;
  const int* in_contact = nullptr;
  int pass = 0;
};

/// With compaction: rows of n spheres, of dent_sums, body_values and memory_values numbers.
struct BodyRows {
  int n;
  double *sums, *bodies, *memory;
  int memory_stride;  // from row to row of the memory
};

struct SphereKernels {
  /// v += dt_force F / (mass_factor m) and omega += dt_torque T / (R^2 m), then x += dt v.
  void (*half_step)(const HalfStep&);
  /// Whether one of n positions is farther than the root of `square` from its position before.
  bool (*any_moved)(const double* now, const double* before, int n, double square);
  /// Write the near spheres among n candidates in the order of the candidates and return their number. near_sphere
  /// writes spheres with an index above `of` only; listed_at_triangle tests each plane alone, as LIGGGHTS does;
  /// near_triangle tests the distance and adds few spheres at the corners. `found` may be the array of the candidates
  /// and has room for one more.
  int (*near_sphere)(const NearTest&, int of, const int* candidates, int n, int* found);
  int (*listed_at_triangle)(const NearTest&, const TrianglePlanes&, const int* candidates, int n, int* found);
  int (*near_triangle)(const NearTest&, const TrianglePlanes&, const int* candidates, int n, int* found);
  /// Tests the next pairs_at_once pairs, writes those that meet, with their place among all pairs, and returns their
  /// number. The arrays have room for 8 more.
  int (*next_pairs)(PairSearch&, int* i, int* j, int* place);
  /// The same; pairs that do not overlap, but meet by the factor, have the complement of their place. With compaction
  /// they meet where the growth of both closes the gap, or where they were in contact one pass before.
  int (*next_near_pairs)(PairSearch&, int* i, int* j, int* place);
  /// Gives each sphere the BodySums that follow from its sums, sets the sums to 0 and returns the largest growth.
  double (*close_sums)(const BodyRows&);
};

}  // namespace epdem::kernels
