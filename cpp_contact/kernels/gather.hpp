// SPDX-License-Identifier: BSD-3-Clause
// Fills a block with pairs of spheres of a host. For hosts alone: sources that are compiled for newer processors hold
// no inline function that others share.
#pragma once

#include <algorithm>
#include <string>

#include "epdem/exists.hpp"
#include "kernels/block.hpp"

namespace epdem::kernels {

/// The kernels of the instruction set that EPDEM_SIMD names (sse2, avx2 or avx512), else of the widest set of this
/// processor. nullptr: the processor lacks the set, or there is no set of this name, as `refusal` says.
const Kernels* chosen_kernels(std::string& refusal);

/// The largest strains in a block, w a/R* (0) and w overlap/R* (1).
inline double largest_strain(const Block& b, int which) {
  const double* const lanes = which == 0 ? b.radius_ratio : b.overlap_ratio;
  return *std::max_element(lanes, lanes + most_lanes);
}

/// Numbers of all spheres of a host, force and torque as rows of three.
struct Spheres {
  const double *force, *torque, *radius, *mass;
  const int *type, *mask;
  int frozen;  // bits of the frozen group in a mask, 0: no sphere is frozen
};

/// Constants of the pairs of types: most_constants for each i * width + j.
struct PairConstants {
  const double* all;
  int width;   // number of types + 1
  bool mixed;  // whether the spheres can have several types
};

/// Whether n spheres have several types: a type of walls alone, such as that of a floor, is none of them.
inline bool several_types(const int* type, int n) {
  int others = 0;
  for (int i = 0; i < n; ++i) others |= type[i] ^ type[0];
  return others != 0;
}

/// The gap between two spheres.
inline Gap gap_of(const Pass& pass, const double* radius, long i, long j) {
  const double* const x = pass.x;
  const double dx = x[3 * i] - x[3 * j], dy = x[3 * i + 1] - x[3 * j + 1], dz = x[3 * i + 2] - x[3 * j + 2];
  return {dx * dx + dy * dy + dz * dz, radius[i], radius[j], sums_of(pass.sums, i), sums_of(pass.sums, j)};
}

/// Fills a block whose n > 0 pairs (i, j) are known and prefetches what lies apart in memory. history(i, k) fetches the
/// history of pair k, if it has one.
template <class History>
inline void gather_pairs(Block& b, Pass& pass, int n, const Spheres& spheres, const PairConstants& constants,
                         History history) {
  const double *const v = pass.v, *const w = pass.omega, *const f = spheres.force, *const t = spheres.torque;
  const double *const radius = spheres.radius, *const mass = spheres.mass;
  for (int k = 0; k < n; ++k) {
    const long i = b.i[k], j = b.j[k];
    history(i, k);
    __builtin_prefetch(v + 3 * j);
    __builtin_prefetch(w + 3 * j);
    __builtin_prefetch(f + 3 * j, 1);
    __builtin_prefetch(t + 3 * j, 1);
    b.radius_i.a[k] = radius[i];
    b.radius_j.a[k] = radius[j];
    b.mass_i.a[k] = mass[i];
    b.mass_j.a[k] = mass[j];
  }
  const int *const type = spheres.type, *const mask = spheres.mask, frozen = spheres.frozen, width = constants.width;
  const double* const all = constants.all;
  const auto material = [=](int i, int j) { return all + most_constants * (type[i] * width + type[j]); };
  b.material[0] = material(b.i[0], b.j[0]);
  bool several = false;
  for (int k = 0; k < n && constants.mixed; ++k) {
    b.material[k] = material(b.i[k], b.j[k]);
    several |= b.material[k] != b.material[0];
  }
  pass.several = several;
  for (int k = 0; k < n && frozen; ++k) {
    b.frozen_i.a[k] = (mask[b.i[k]] & frozen) != 0;
    b.frozen_j.a[k] = (mask[b.j[k]] & frozen) != 0;
  }
}

/// The first of n contacts whose R* is below the least of their pair of materials, -1: none. least: by the place of the
/// pair's numbers in `constants`.
inline int first_below(const Block& b, int n, bool several, bool wall, const double* constants, const double* least) {
  for (int k = 0; k < n; ++k) {
    const double i = b.radius_i.a[k], R_star = wall ? i : reduced_finite(i, b.radius_j.a[k]);
    if (R_star < least[(b.material[several ? k : 0] - constants) / most_constants]) return k;
  }
  return -1;
}

/// Adds the forces and torques of n pairs in their order; those of body i stay in registers while its pairs follow each
/// other. A ghost gets nothing: its owner computes what it gets. beside: begin(i), add(k, j, owned) for each pair of i,
/// end(i).
template <bool torques, class Beside>
inline void scatter_pairs(const Block& b, int n, double* f, double* t, int owned, Beside&& beside) {
  double others[6] = {};
  for (int k = 0; k < n;) {
    const long i = b.i[k];
    double *const fi = f + 3 * i, *const ti = t + 3 * i;
    double fx = fi[0], fy = fi[1], fz = fi[2], tx = ti[0], ty = ti[1], tz = ti[2];
    beside.begin(i);
    do {
      const long j = b.j[k];
      const bool is_owned = j < owned;
      double* const fj = is_owned ? f + 3 * j : others;
      const double gx = b.force[0].a[k], gy = b.force[1].a[k], gz = b.force[2].a[k];
      fx += gx;
      fy += gy;
      fz += gz;
      fj[0] -= gx;
      fj[1] -= gy;
      fj[2] -= gz;
      if constexpr (torques) {
        double* const tj = is_owned ? t + 3 * j : others + 3;
        tx += b.torque_i[0].a[k];
        ty += b.torque_i[1].a[k];
        tz += b.torque_i[2].a[k];
        tj[0] += b.torque_j[0].a[k];
        tj[1] += b.torque_j[1].a[k];
        tj[2] += b.torque_j[2].a[k];
      }
      beside.add(k, j, is_owned);
      ++k;
    } while (k < n && b.i[k] == i);
    fi[0] = fx;
    fi[1] = fy;
    fi[2] = fz;
    if constexpr (torques) {
      ti[0] = tx;
      ti[1] = ty;
      ti[2] = tz;
    }
    beside.end(i);
  }
}

/// Forces and torques alone.
struct NothingBeside {
  void begin(long) const {}
  void add(int, long, bool) const {}
  void end(long) const {}
};

}  // namespace epdem::kernels
