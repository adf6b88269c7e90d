// SPDX-License-Identifier: GPL-2.0-or-later
// Compaction: a sphere that other contacts dent is thicker at this one, because the displaced volume moves to the free
// surface. To lowest order a sphere with dents of depths x_k R grows by g R, g = S2/(4 - 2 S1), S1 = sum x_k, S2 = sum
// x_k^2; a contact sees the growth by the other dents only, so that a contact alone keeps its law bit by bit:
//   u = R_i max(0, g_i - g(x_i)) + R_j max(0, g_j - g(x_j)),   F = law(alpha + u) with the memory alpha_max + u.
// The depths follow from the largest overlaps: depths of current overlaps would create energy. No number is fitted.
#pragma once

#include "law.hpp"

namespace epdem {

template <class T>
struct Cavity;

/// Whether hosts offer compaction with a law.
template <class Law>
inline constexpr bool compacts = false;
template <class T>
inline constexpr bool compacts<Cavity<T>> = true;

/// Growth closes gaps of two spheres up to this share of the sum of their radii.
inline constexpr double growth_reach = 0.25;

/// Growth of a sphere over its radius from the sums of its depths and of their squares; finite for any sums.
template <class T>
EPDEM_INLINE T growth(T depths, T squares) noexcept {
  return squares / (4.0 - 2.0 * min(depths, constant<T>(1.6)));
}

/// Depths of the dents that a contact made in both bodies, over their radii, to the plane where the spheres intersect.
template <class T>
struct Depths {
  T i, j;
};

template <bool wall, class T>
EPDEM_INLINE Depths<T> depths_of(T radius_i, T radius_j, T delta_max) noexcept {
  const T delta = max(T{}, delta_max);
  if constexpr (wall) {
    (void)radius_j;
    return {delta / radius_i, T{}};
  } else {
    const T share = 0.5 * delta / (radius_i + radius_j - delta);
    return {share * (2.0 * radius_j - delta) / radius_i, share * (2.0 * radius_i - delta) / radius_j};
  }
}

/// Overlap u [m] that growth adds to a contact whose largest overlap is delta_max; growth_i, growth_j: of the bodies.
template <bool wall, class T>
EPDEM_INLINE T added_overlap(T radius_i, T radius_j, T delta_max, T growth_i, T growth_j) noexcept {
  const Depths<T> x = depths_of<wall>(radius_i, radius_j, delta_max);
  const T u_i = radius_i * max(T{}, growth_i - growth(x.i, x.i * x.i));
  if constexpr (wall) return u_i;
  return u_i + radius_j * max(T{}, growth_j - growth(x.j, x.j * x.j));
}

/// Spheres that grow by at most `largest` touch below this factor of the squared sum of their radii.
inline double touch_factor(double largest) noexcept {
  const double reach = 1.0 + (largest < growth_reach ? largest : growth_reach);
  return reach * reach;
}

/// Whether growth closes the gap between bodies whose centres are sqrt(rsq) apart.
template <class T>
EPDEM_INLINE bool closes_gap(T radii, T rsq, T added) noexcept {
  return radii - sqrt(rsq) + added > 0.0;
}

/// A contact of grown bodies in one step. `reached`: largest overlap before, without growth; added: u of this step.
template <class T>
struct Grown {
  T reached, added;
};

/// Gives the memory of a contact, whose largest overlap is without growth, the growth of this step. now: u of the sums
/// of the step before; last: the same one step earlier, kept by the contact; their extrapolation makes the error one of
/// second order in the time step. A contact without memory starts at its overlap, which is negative across a gap.
template <class Law, class T = Number<Law>>
EPDEM_INLINE Grown<T> grow(State<Law>& memory, T overlap, T now, T last) noexcept {
  const auto is_new = (memory.delta_max == 0.0) & (last == 0.0);
  const T reached = select(is_new, min(overlap, T{}), memory.delta_max);
  const T added = select(is_new, now, max(now, 2.0 * now - last));
  memory.delta_max = reached + added;
  // the stored peak is of another growth: none is plausible, and the step computes a new one
  memory.point.force = select((now == 0.0) & (last == 0.0), memory.point.force, T{});
  return {reached, added};
}

/// The largest overlap after a step, without growth.
template <class T>
EPDEM_INLINE T largest_overlap(const Grown<T>& before, T overlap) noexcept {
  return select((overlap < before.reached) & (before.reached < no_overlap), before.reached, overlap);
}

/// Elastic energy [J] that growth took from a contact in a step, negative if it gave some: with it the plastic work of
/// a bed is what its walls did less what its contacts can give back. delta_max: largest overlap without growth.
template <class Law, class T = Number<Law>>
inline T growth_loss(const Law& law, T R_star, T delta_max, T overlap, T now, T last) noexcept {
  if (!any(now != last)) return T{};
  const auto stored = [&](T added) {
    State<Law> memory{};
    memory.delta_max = delta_max + added;
    const T delta = overlap + added;
    return elastic_energy(law, R_star, step(law, R_star, memory, delta), delta);
  };
  return select(now != last, stored(last) - stored(now), T{});
}

/// Plastic work of a contact in a step [J] with this loss by growth.
template <class T>
EPDEM_INLINE T grown_work(T plastic_work_step, T loss) noexcept {
  return max(T{}, plastic_work_step) + loss;
}

}  // namespace epdem
