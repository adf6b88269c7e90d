// SPDX-License-Identifier: BSD-3-Clause
// One step of a contact: a pure function of (law, R*, before, delta). The host keeps `after` only when the step counts.
//
// A law object holds the constants of a pair of materials (E* and the law's parameters); R* comes apart because it
// changes from contact to contact while the pairs of materials of a simulation are few. All of it on the law's number
// type: the same text, and the same bits, for one contact and for lanes of contacts.
#pragma once

#include <utility>

#include "unloading.hpp"

namespace epdem {

namespace detail {

/// The backbone at delta_max as a contact stores it, and how it does.
template <class T>
EPDEM_INLINE Point<T> stored_peak(const Peak<T>& state, const T&) noexcept {
  return state.point;
}
template <class T>
EPDEM_INLINE Point<T> stored_peak(const PeakForce<T>& state, const T& R_star) noexcept {
  return {state.force, sqrt(R_star * state.delta_max), T{}};
}
template <class M, class T>
EPDEM_INLINE void store_peak(Peak<T>& state, M where, const Point<T>& peak) noexcept {
  state.point = select(where, peak, state.point);
}
template <class M, class T>
EPDEM_INLINE void store_peak(PeakForce<T>& state, M where, const Point<T>& peak) noexcept {
  state.force = select(where, peak.force, state.force);
}

}  // namespace detail

/// Whether contacts store values of the backbone at their largest overlap.
template <class Law>
inline constexpr bool stores_peak = !std::is_same_v<State<Law>, Maximum<Number<Law>>> && !adheres<Law>;

/// The history of a contact with a known largest overlap; with adhesion, of a contact that has rested since then.
template <class Law>
inline State<Law> remember(const Law& law, Number<Law> R_star, Number<Law> delta_max) noexcept {
  if constexpr (adheres<Law>) {
    return step(law, R_star, {}, delta_max, Number<Law>{}).after;
  } else if constexpr (stores_peak<Law>) {
    State<Law> state{delta_max, {}};
    if (delta_max > law.elastic_overlap(R_star)) detail::store_peak(state, true, law.load(R_star, delta_max));
    return state;
  } else {
    (void)law;
    (void)R_star;
    return {delta_max};
  }
}

/// Larger stored overlaps [m] are uninitialised history and are reset.
inline constexpr double no_overlap = 1e100;

/// Whether a stored peak can be one: a restart of a run with another law may have left other numbers there.
template <class T>
inline auto plausible(const Point<T>& p) noexcept {
  constexpr double most = std::numeric_limits<double>::max();
  return (p.force > 0.0) & (p.force <= most) & (p.radius > 0.0) & (p.radius <= most) & (p.flatness >= 0.0) &
         (p.flatness <= 1.0);
}

/// As `step`; kept: of the contacts below their largest overlap those whose stored peak belongs to it; load: the
/// backbone above the elastic overlap.
template <class Law, class Kept, class Load>
inline Step<Law> step_of_peak(const Law& law, Number<Law> R_star, const State<Law>& before, Number<Law> delta,
                              Kept kept, Load load) noexcept {
  using T = Number<Law>;
  (void)kept;
  (void)load;
  const auto touches = delta > 0.0;
  if (!any(touches)) return {T{}, T{}, before};
  Point<T> now{};
  State<Law> after = before;
  if constexpr (!Law::yields) {
    now = hertz_point(law.E_star, R_star, delta);
    after.delta_max = select(touches & (delta > before.delta_max), delta, before.delta_max);
  } else {
    // grows also at equality: evaluating the same step twice then gives the same bits
    const auto falls = (delta < before.delta_max) & (before.delta_max < no_overlap);
    const T delta_max = select(falls, before.delta_max, delta);
    const auto elastic = delta_max <= law.elastic_overlap(R_star);
    if (any(!elastic)) {
      Point<T> peak;
      if constexpr (stores_peak<Law>) {
        peak = detail::stored_peak(before, R_star);
        auto known = kept(falls);
        if (any(known)) known = known & plausible(peak);
        const auto unknown = !(elastic | known);
        if (any(unknown)) peak = select(unknown, load(only(unknown, delta_max)), peak);
        detail::store_peak(after, touches & unknown, peak);
      } else {
        peak = load(delta_max);
      }
      if (any(falls)) peak = select(falls, unload<Law::flattens>(law.E_star, peak, delta_max, delta), peak);
      now = peak;
    }
    if (any(elastic)) now = select(elastic, hertz_point(law.E_star, R_star, delta), now);
    after.delta_max = select(touches, delta_max, before.delta_max);
  }
  return {select(touches, now.force, T{}), select(touches, now.radius, T{}), after};
}

/// Force and contact radius at overlap `delta` [m] of a contact that remembers `before`.
/// Never NaN for finite input; zero force for delta <= 0. The memory only grows: forgetting is the host's decision.
template <class Law>
inline Step<Law> step(const Law& law, Number<Law> R_star, const State<Law>& before, Number<Law> delta) noexcept {
  const auto load = [&](Number<Law> b) __attribute__((always_inline)) {
    if constexpr (Law::yields)
      return law.load(R_star, b);
    else
      return Point<Number<Law>>{};
  };
  return step_of_peak(law, R_star, before, delta, [](auto falls) { return falls; }, load);
}

/// The same with a closing speed at the half step times the time step [m], which only laws with adhesion ask for.
template <class Law, class = std::enable_if_t<!adheres<Law>>>
inline Step<Law> step(const Law& law, Number<Law> R_star, const State<Law>& before, Number<Law> delta,
                      Number<Law>) noexcept {
  return step(law, R_star, before, delta);
}

/// Force at an overlap of a tenth of R* over 2 pi R* alpha, the area of the lens of the overlap [Pa]: half of p_y of
/// Thornton's law, p_m of Johnson's.
template <class Law>
inline double resistance(const Law& law) noexcept {
  constexpr double delta = 0.1;
  return step(law, 1.0, {}, delta, 0.0).force / (2.0 * pi * delta);
}

/// The normal force that limits friction: the contact's own; with adhesion F + 2 P_po, P_po = 3/2 pi Gamma R, while the
/// bodies are attached (Thornton 1991, J. Phys. D 24, 1942).
template <class Law>
inline Number<Law> sliding_load(const Law& law, Number<Law> R_star, const Step<Law>& now, Number<Law> force) noexcept {
  if constexpr (adheres<Law>) {
    using T = Number<Law>;
    const T limit = max(T{}, force + 3.0 * law.pull * opening_radius(law, R_star, now.after));
    return select(now.radius > 0.0, limit, T{});
  } else {
    (void)law;
    (void)R_star;
    (void)now;
    return force;
  }
}

/// Overlap [m] at which the force of a contact that reached delta_max returns to 0: its dent, 0 before yield.
template <class Law>
inline Number<Law> residual_overlap(const Law& law, Number<Law> R_star, Number<Law> delta_max) noexcept {
  using T = Number<Law>;
  const auto yielded = delta_max > law.elastic_overlap(R_star);
  if (!any(yielded)) return T{};
  const T reached = only(yielded, delta_max);
  return select(yielded, reached - recovered_overlap(law.E_star, law.load(R_star, reached)), T{});
}

/// Work lost for good by a contact that reached delta_max [J]: backbone work less the recoverable part.
template <class Law>
inline Number<Law> plastic_work(const Law& law, Number<Law> R_star, Number<Law> delta_max) noexcept {
  using T = Number<Law>;
  const auto yielded = delta_max > law.elastic_overlap(R_star);
  if (!any(yielded)) return T{};
  const T reached = only(yielded, delta_max);
  return select(yielded, law.work(R_star, reached) - recovered_work(law.E_star, law.load(R_star, reached)), T{});
}

/// Tangent stiffness 2 E* a [N/m] of a contact of this radius on its elastic branches.
template <class T>
inline T normal_stiffness(T E_star, T radius) noexcept {
  return 2.0 * E_star * radius;
}

/// Elastic energy [J] of a contact at overlap `delta` after a step; it returns on separation. With a half-ellipse of
/// pressure it is 0.3 F^2/(E* a) on any branch: 0.4 F times the overlap that is still to be recovered.
template <class Law>
inline Number<Law> elastic_energy(const Law& law, Number<Law> R_star, const Step<Law>& now,
                                  Number<Law> delta) noexcept {
  using T = Number<Law>;
  const auto loaded = now.force > 0.0;
  T energy = select(loaded, 0.3 * now.force * now.force / (law.E_star * now.radius), T{});
  if constexpr (Law::flattens) {
    const auto yielded = now.after.delta_max > law.elastic_overlap(R_star);
    if (any(yielded)) {
      const T stored = stored_work(law.E_star, now.after.point, now.after.delta_max, delta);
      energy = select(yielded & (delta > 0.0), stored, energy);
    }
  } else {
    (void)R_star;
    (void)delta;
  }
  return energy;
}

namespace detail {

/// Whether a law has its own work between two overlaps of known forces, because its work from zero on takes long.
template <class Law, class = void>
inline constexpr bool has_work_between = false;
template <class Law>
inline constexpr bool
    has_work_between<Law, std::void_t<decltype(std::declval<Law>().work(Number<Law>{}, Number<Law>{}, Number<Law>{},
                                                                        Number<Law>{}, Number<Law>{}))>> = true;

}  // namespace detail

/// Plastic work [J] of a step whose elastic energy is `stored`.
template <class Law>
inline Number<Law> plastic_growth(const Law& law, Number<Law> R_star, const State<Law>& before, const Step<Law>& now,
                                  Number<Law> stored) noexcept {
  using T = Number<Law>;
  const auto grows = now.after.delta_max > before.delta_max;
  const auto yields = grows & (now.after.delta_max > law.elastic_overlap(R_star));
  if (!any(yields)) return T{};
  if constexpr (detail::has_work_between<Law>) {
    const T yield = law.elastic_overlap(R_star);  // for lanes that do not yield
    const T from = select(yields, max(T{}, before.delta_max), yield), to = select(yields, now.after.delta_max, yield);
    const auto yielded = from > yield;
    // before the step
    T force = hertz_point(law.E_star, R_star, from).force, held = hertz_work(law.E_star, R_star, from);
    if (any(yielded)) {
      const Point<T> peak = law.load(R_star, max(from, yield));
      force = select(yielded, peak.force, force);
      held = select(yielded, recovered_work(law.E_star, peak), held);
    }
    return select(yields, law.work(R_star, from, to, force, now.force) + held - stored, T{});
  }
  const T work = law.work(R_star, only(yields, now.after.delta_max)) - stored;  // it is on the backbone
  return select(yields, work - plastic_work(law, R_star, only(yields, before.delta_max)), T{});
}

/// Energies of a step of a law [J]: plastic work of this step, elastic energy at its end (with adhesion less the
/// surface energy), and what adhesion lost in its jumps.
template <class T>
struct NormalEnergies {
  T plastic_work_step, stored, adhesion_loss;
};

}  // namespace epdem
