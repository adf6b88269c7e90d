// SPDX-License-Identifier: BSD-3-Clause
// Fills a block with pairs of spheres of a host. For hosts alone: sources that are compiled for newer processors hold
// no inline function that others share.
#pragma once

#include "kernels/block.hpp"

namespace epdem::kernels {

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

}  // namespace epdem::kernels
