// SPDX-License-Identifier: GPL-2.0-or-later
// One step of a contact: a pure function of (law, R*, before, delta). The host keeps `after` only when the step counts.
//
// A law object holds the constants of a pair of materials (E* and the law's parameters); R* comes apart because it
// changes from contact to contact while the pairs of materials of a simulation are few.
#pragma once

#include "unloading.hpp"

namespace epdem {

/// The memory of a contact whose largest overlap is known.
template <class Law>
inline State<Law> remember(const Law& law, real R_star, real delta_max) noexcept {
  if constexpr (Law::flattens) {
    if (!(delta_max > law.elastic_overlap(R_star))) return {delta_max, {0.0, 0.0, 0.0}};
    return {delta_max, law.load(R_star, delta_max)};
  } else {
    (void)law;
    (void)R_star;
    return {delta_max};
  }
}

/// A stored overlap [m] of this size was never one, and is forgotten.
inline constexpr real no_overlap = 1e100;

/// Whether a stored peak can be one: a restart of a run with another law may have left other numbers there.
inline bool plausible(const Point& p) noexcept {
  constexpr real most = std::numeric_limits<double>::max();
  return p.force > 0.0 && p.force <= most && p.radius > 0.0 && p.radius <= most && p.flatness >= 0.0 && p.flatness <= 1.0;
}

template <class Law>
struct Step {
  real force;      // F [N], never negative
  real radius;     // contact radius a [m]; the stiffnesses are k_n = 2 E* a and k_t = 8 G* a
  State<Law> after;  // what the contact remembers if this step counts
};

/// Force and contact radius at overlap `delta` [m] of a contact that remembers `before`.
/// Never NaN for finite input; zero force for delta <= 0. The memory only grows: forgetting is the host's decision.
template <class Law>
inline Step<Law> step(const Law& law, real R_star, const State<Law>& before, real delta) noexcept {
  if (!(delta > 0.0)) return {0.0, 0.0, before};
  if constexpr (!Law::yields) {
    const Point p = hertz_point(law.E_star, R_star, delta);
    return {p.force, p.radius, {delta > before.delta_max ? delta : before.delta_max}};
  } else {
    const real delta_y = law.elastic_overlap(R_star);
    // also at equality: evaluating the same step twice then gives the same bits
    const bool grows = !(delta < before.delta_max && before.delta_max < no_overlap);
    const real delta_max = grows ? delta : before.delta_max;
    if (delta_max <= delta_y) {
      const Point p = hertz_point(law.E_star, R_star, delta);
      State<Law> after = before;
      after.delta_max = delta_max;
      return {p.force, p.radius, after};
    }
    if (grows) {
      const Point p = law.load(R_star, delta);
      if constexpr (Law::flattens)
        return {p.force, p.radius, {delta, p}};
      else
        return {p.force, p.radius, {delta}};
    }
    if constexpr (Law::flattens) {
      const State<Law> known = plausible(before.point) ? before : remember(law, R_star, before.delta_max);
      const Point p = unload<true>(law.E_star, known.point, known.delta_max, delta);
      return {p.force, p.radius, known};
    } else {
      const Point p = unload<false>(law.E_star, law.load(R_star, before.delta_max), before.delta_max, delta);
      return {p.force, p.radius, before};
    }
  }
}

/// Work lost for good by a contact that reached delta_max [J]: backbone work less the recoverable part.
template <class Law>
inline real plastic_work(const Law& law, real R_star, real delta_max) noexcept {
  if (!(delta_max > law.elastic_overlap(R_star))) return 0.0;
  return law.work(R_star, delta_max) - recovered_work(law.E_star, law.load(R_star, delta_max));
}

/// Elastic energy [J] of a contact at overlap `delta` that remembers `before`; it returns on separation.
template <class Law>
inline real elastic_energy(const Law& law, real R_star, const State<Law>& before, real delta) noexcept {
  if (!(delta > 0.0)) return 0.0;
  const real delta_max = std::max(delta, before.delta_max);
  if (!Law::yields || delta_max <= law.elastic_overlap(R_star)) return hertz_work(law.E_star, R_star, delta);
  return stored_work<Law::flattens>(law.E_star, law.load(R_star, delta_max), delta_max, delta);
}

}  // namespace epdem
