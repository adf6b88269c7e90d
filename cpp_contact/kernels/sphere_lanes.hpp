// SPDX-License-Identifier: GPL-2.0-or-later
// The loops of spheres.hpp as lanes; compiled once per instruction set, as kernel.hpp says.
#pragma once

#include "epdem/lanes.hpp"
#include "kernels/spheres.hpp"

namespace epdem::kernels {
namespace {

/// Each number of a sphere three times, for the three numbers of its rows.
EPDEM_INLINE void repeat(const double* from, double* to, int n) {
  for (int k = 0; k < n; ++k) to[3 * k] = to[3 * k + 1] = to[3 * k + 2] = from[k];
}

/// y += a x
EPDEM_INLINE void add(double* __restrict y, const double* __restrict a, const double* __restrict x, int n) {
  for (int q = 0; q < n; ++q) y[q] += a[q] * x[q];
}

void half_step(const HalfStep& s) {
  constexpr int most = 128;
  alignas(64) double of_sphere[most], of_number[3 * most];
  for (int first = 0; first < s.n; first += most) {
    const int n = s.n - first < most ? s.n - first : most, row = 3 * first;
    const double *const mass = s.mass + first, *const radius = s.radius + first;
    for (int k = 0; k < n; ++k) of_sphere[k] = s.dt_force / (mass[k] * s.mass_factor);
    repeat(of_sphere, of_number, n);
    add(s.v + row, of_number, s.force + row, 3 * n);
    for (int k = 0; k < n; ++k) of_sphere[k] = s.dt_torque / (radius[k] * radius[k] * mass[k]);
    repeat(of_sphere, of_number, n);
    add(s.omega + row, of_number, s.torque + row, 3 * n);
    if (!s.x) continue;
    double* const __restrict x = s.x + row;
    const double* const __restrict v = s.v + row;
    for (int q = 0; q < 3 * n; ++q) x[q] += s.dt * v[q];
  }
}

/// The next candidates, in the lanes behind the last of them that one again.
struct Candidates {
  int index[lane_count];
  Vec<Lanes> x;
  Lanes radius;

  EPDEM_INLINE Candidates(const NearTest& t, const int* candidates, int n) {
    for (int l = 0; l < lane_count; ++l) {
      index[l] = candidates[l < n ? l : n - 1];
      radius[l] = t.radius[index[l]];
    }
    const Columns c =
        columns([&](int l) __attribute__((always_inline)) { return load<Row>(t.x + 3 * long(index[l])); });
    x = {c.a, c.b, c.c};
  }

  /// Writes those of the mask, at most n; their number.
  EPDEM_INLINE int keep(Mask mask, int n, int* found) const {
    int count = 0;
    for (int l = 0; l < lane_count && l < n; ++l) {
      found[count] = index[l];
      count -= static_cast<int>(mask[l]);
    }
    return count;
  }
};

int near_sphere(const NearTest& t, int of, const int* candidates, int n, int* found) {
  const double* const at = t.x + 3 * long(of);
  const Vec<Lanes> x{constant<Lanes>(at[0]), constant<Lanes>(at[1]), constant<Lanes>(at[2])};
  int count = 0;
  for (int k = 0; k < n; k += lane_count) {
    const Candidates c(t, candidates + k, n - k);
    const Lanes reach = (t.radius[of] + c.radius) * t.factor + t.skin;
    Lanes index;
    for (int l = 0; l < lane_count; ++l) index[l] = c.index[l];
    const Lanes dx = x.x - c.x.x, dy = x.y - c.x.y, dz = x.z - c.x.z;
    const Mask near = dx * dx + dy * dy + dz * dz <= reach * reach;
    count += c.keep(near & (index > constant<Lanes>(of)), n - k, found + count);
  }
  return count;
}

int near_triangle(const NearTest& t, const TrianglePlanes& planes, const int* candidates, int n, int* found) {
  int count = 0;
  for (int k = 0; k < n; k += lane_count) {
    const Candidates c(t, candidates + k, n - k);
    const Lanes reach = c.radius * t.factor + t.skin;
    const auto height = [&](int plane) __attribute__((always_inline)) {
      const double *const p = planes.point[plane], *const normal = planes.normal[plane];
      return normal[0] * (c.x.x - p[0]) + normal[1] * (c.x.y - p[1]) + normal[2] * (c.x.z - p[2]);
    };
    Mask near = fabs(height(0)) <= reach;
    if (!any(near)) continue;
    for (int edge = 1; edge < 4; ++edge) {
      const Lanes beyond = height(edge);
      near &= (beyond <= 0.0) | (beyond * beyond <= reach * reach);
    }
    count += c.keep(near, n - k, found + count);
  }
  return count;
}

}  // namespace
}  // namespace epdem::kernels
