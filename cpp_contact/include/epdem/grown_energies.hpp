// SPDX-License-Identifier: BSD-3-Clause
// Energies of a step with compaction, of second order in the time step.
#pragma once

#include "compaction.hpp"

namespace epdem {

namespace detail {

/// What the bodies take of the energy [J] at the stationary Q: 3/7 N Q^(7/3) is the sum of 3/7 Q c d_e F.
template <class T>
EPDEM_INLINE T taken(const GrownEnd<T>& at) noexcept {
  return select(at.area > 0.0, 3.0 / 7.0 * at.force * ((1.0 - at.screening) * at.recovered - at.retreat), T{});
}

/// The middle of a step below the peak, where the overlap moves on a branch that the sums change.
template <class Law, class T = Number<Law>>
EPDEM_INLINE T middle_of(const GrownStep<Law>& s, T overlap, T closing) noexcept {
  const T below = s.reached + min(s.last.retreat, s.state.retreat);
  return min(overlap - 0.5 * closing, select(s.last.area > 0.0, below, overlap));
}

}  // namespace detail

/// Energies of a step that grows, of second order in the time step; closing: closing speed at the half step times the
/// time step [m]; holds: whether the elastic energy is requested. The plastic work of one contact may be negative: what
/// grows a contact is paid by the dents of others.
template <class Law, class T = Number<Law>>
[[gnu::noinline]] NormalEnergies<T> grown_energies(const Law& law, T R_star, const Point<T>& peak_before,
                                                   const GrownStep<Law>& s, T overlap, T closing, bool holds) noexcept {
  const auto known = s.last.screening > 0.0, was_dented = s.last.area > 0.0, dented = s.state.area > 0.0;
  const T one = constant<T>(1.0), zero{};
  const T v = s.state.added, v0 = select(known, s.last.added, v), b = s.delta_max + v, b0 = s.reached + v0;
  const T less = v - s.state.retreat, less0 = v0 - s.last.retreat;
  const Point<T>& peak = s.step.after.point;
  const Point<T> safe = select(dented, peak, Point<T>{one, one, zero});
  const Point<T> safe0 = select(was_dented, peak_before, safe);
  const auto stored = [&](auto yielded, const Point<T>& p, T delta_max, T delta) {
    const T at = max(zero, delta);
    if (!any(!yielded)) return stored_work(law.E_star, p, delta_max, at);
    return select(yielded, stored_work(law.E_star, p, delta_max, at), hertz_work(law.E_star, R_star, at));
  };
  const T middle = detail::middle_of(s, overlap, closing);
  const auto yields = dented & (overlap - s.state.retreat >= s.reached);
  T lost{}, held{};
  if (any(!yields)) {
    if (holds) held = stored(dented, safe, b, s.overlap);
    // a peak that stays: the sums move the overlap alone
    const auto stays = (was_dented & dented & (b == b0) & (safe.force == safe0.force)) | !(was_dented | dented);
    lost = 0.5 * (s.last.force + s.state.force) * (less0 - less);
    if (any(!(stays | yields)))
      lost =
          select(stays, lost, stored(was_dented, safe0, b0, middle + less0) - stored(dented, safe, b, middle + less));
  }
  if (any(yields)) {
    const T delta_Y = law.elastic_overlap(R_star);
    const T from = select(yields, max(delta_Y, select(known, b0, zero)), delta_Y), to = select(yields, b, delta_Y);
    const T F0 = select(was_dented, safe0.force, hertz_point(law.E_star, R_star, from).force);
    const T U0 = select(was_dented, recovered_work(law.E_star, safe0), hertz_work(law.E_star, R_star, from));
    const T U = recovered_work(law.E_star, safe);
    T work = 0.5 * (to - from) * (F0 + safe.force);
    const auto leaps = yields & (to > 1.1 * from);
    if (any(leaps)) work = select(leaps, detail::work_of_leap(law, R_star, from, to, F0, safe.force), work);
    lost = select(yields, work + U0 - U - 0.5 * (s.last.force + safe.force) * (less - less0), lost);
    held = select(yields, U, held);
  }
  const T taken = detail::taken(s.state), taken0 = detail::taken(s.last);
  return {lost + (taken - taken0) + s.bond_loss, held - taken + s.stretched, T{}};
}

/// The same with adhesion; before: the history before the step. Beside the work of Cavity growth takes from the punch
/// the integral of d (2 E* a d alpha_b - dF_b), here by the trapezoid of the step.
template <class T>
[[gnu::noinline]] NormalEnergies<T> grown_energies(const CavityAdhesive<T>& law, T R_star,
                                                   const State<CavityAdhesive<T>>& before,
                                                   const GrownStep<CavityAdhesive<T>>& s, T overlap, T closing,
                                                   bool holds) noexcept {
  using History = State<CavityAdhesive<T>>;
  const auto known = s.last.screening > 0.0, was_dented = s.last.area > 0.0, dented = s.state.area > 0.0;
  const T v = s.state.added, v0 = select(known, s.last.added, v), b0 = s.reached + v0;
  const T less = v - s.state.retreat, less0 = v0 - s.last.retreat;
  const History& after = s.step.after;
  const auto stands = after.root > 0.0, yields = dented & stands & (s.overlap >= s.reached_grown);
  const auto stays = (before.root > 0.0) & stands & !yields;
  T lost{}, held{};
  if (holds) held = stored_energy(law, R_star, after, s.overlap);
  if (any(stays)) {
    const T middle = detail::middle_of(s, overlap, closing);
    History earlier = before;
    earlier.delta_max = b0;
    const T change =
        stored_energy(law, R_star, earlier, middle + less0) - stored_energy(law, R_star, after, middle + less);
    lost = select(stays, change, lost);
  }
  if (any(yields)) {
    const T delta_Y = law.body.elastic_overlap(R_star);
    const Point<T> first = select(was_dented, before.point, hertz_point(law.E_star, R_star, delta_Y));
    const Point<T> last = select(yields, after.point, first);
    const T d0 = law.opening(first.radius), d = law.opening(last.radius);
    const T from = select(yields & was_dented, b0 + d0, delta_Y), to = select(yields, after.delta_max + d, delta_Y);
    const T way = to - from;
    T work = 0.5 * way * (first.force + last.force);
    const auto leaps = yields & (to > 1.1 * from);
    if (any(leaps))
      work = select(leaps, detail::work_of_leap(law.body, R_star, from, to, first.force, last.force), work);
    work = work + recovered_work(law.E_star, first) - recovered_work(law.E_star, last);
    const T stiff = law.E_star * (first.radius + last.radius) * way - (last.force - first.force);
    const T moved = 0.5 * (s.last.force + last.force - law.punch(last.radius)) * (less - less0);
    lost = select(yields, work - 0.5 * (d0 + d) * stiff - moved, lost);
  }
  const T taken = detail::taken(s.state), taken0 = detail::taken(s.last);
  return {lost + (taken - taken0), held - taken, jump_loss(law, R_star, s.first, after)};
}

}  // namespace epdem
