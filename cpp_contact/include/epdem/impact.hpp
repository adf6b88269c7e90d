// SPDX-License-Identifier: BSD-3-Clause
// One normal impact of two bodies by velocity Verlet, as a DEM engine integrates it: the embedded engine.
#pragma once

#include <cstdint>

#include "contact.hpp"

namespace epdem {

/// One impact: the relative approach obeys m* alpha'' = -F.
template <class T>
struct ImpactInput {
  T R_star;            // [m]
  T m_star;            // [kg]
  T speed;             // approach speed [m/s]
  T time_step;         // [s]
  T gap;               // distance before first touch [m]; the phase of the impact is gap/(speed time_step);
                       // negative: they overlap already
  std::int64_t steps;  // largest number of steps
  T viscous;           // viscous_number of the pair, 0: no dashpot
};

template <class T>
struct ImpactOutput {
  T rebound_speed;           // [m/s]; 0 if bodies that adhere are still in contact at the end
  T force_max, overlap_max;  // largest sampled values [N], [m]
  T last_overlap;            // overlap at the last loaded sample [m]
  std::int64_t first, last;  // first and last step with a force
  std::int64_t steps;        // steps taken
};

/// Samples of the path, written if the pointers are set; room for steps + 1 values each.
template <class T>
struct Path {
  T* overlap = nullptr;   // [m], negative while apart
  T* force = nullptr;     // [N]
  T* velocity = nullptr;  // of approach [m/s]
};

/// Integrates until the bodies have parted (no force for two steps after contact) or `steps` is reached;
/// `state` is the history, before and after; the dashpot of `pair` is the dashpot of `in`. observer.step(normal
/// contact) is called in every step.
template <class Law, class Observer = NoObserver>
inline ImpactOutput<Number<Law>> impact(ContactConstants<Law> pair, const ImpactInput<Number<Law>>& in,
                                        const Path<Number<Law>>& path, State<Law>& state,
                                        Observer observer = {}) noexcept {
  using T = Number<Law>;
  const T half = 0.5 * in.time_step / in.m_star;
  pair.dashpot = in.viscous;
  T alpha = -in.gap, v = in.speed, force = 0.0;
  ImpactOutput<T> out{in.speed, 0.0, 0.0, 0.0, -1, -1, 0};
  std::int64_t n = 0;
  for (;; ++n) {
    // dashpot and adhesion see the speed of the middle of the last step, as in an engine that moves before it finds
    // contacts
    const NormalContact<Law> contact =
        normal_contact(pair, in.R_star, in.R_star, state, alpha, T(n > 0 ? v * in.time_step : 0.0), v, false,
                       in.viscous > 0.0, [&] { return in.m_star; });
    const Step<Law>& now = contact.step;
    force = contact.force;
    if (n > 0) v -= half * contact.force;
    observer.step(contact);
    state = now.after;
    if (path.overlap) path.overlap[n] = alpha;
    if (path.force) path.force[n] = force;
    if (path.velocity) path.velocity[n] = v;
    if (adheres<Law> ? now.radius > 0.0 : force > 0.0) {
      if (out.first < 0) out.first = n;
      out.last = n;
      out.last_overlap = alpha;
      if (force > out.force_max) out.force_max = force;
      if (alpha > out.overlap_max) out.overlap_max = alpha;
    } else if (out.last >= 0 && n > out.last + 1) {
      break;
    }
    if (n == in.steps) break;
    v -= half * force;
    alpha += in.time_step * v;
  }
  out.rebound_speed = adheres<Law> && out.last == n ? T{} : -v;
  out.steps = n;
  return out;
}

/// The first impact of a contact.
template <class Law>
inline ImpactOutput<Number<Law>> impact(const Law& law, const ImpactInput<Number<Law>>& in,
                                        const Path<Number<Law>>& path) noexcept {
  State<Law> state{};
  return impact(of_law(law), in, path, state);
}

/// The overlap [m] at which a contact with this memory takes force again.
template <class Law>
inline Number<Law> reforming_overlap(const Law& law, Number<Law> R_star, const State<Law>& state) noexcept {
  if constexpr (adheres<Law>) {
    return reforming_overlap(law, state);
  } else {
    if (!(state.delta_max > law.elastic_overlap(R_star))) return 0.0;
    return state.delta_max - recovered_overlap(law.E_star, law.load(R_star, state.delta_max));
  }
}

/// `count` impacts of one contact that keeps its memory, each at the rebound speed of the one before: as between two
/// walls without loss. Phases follow the golden ratio. `speeds` may be null, or takes the `count` rebound speeds.
/// Returns the last impact, whose `steps` count the steps of all impacts; the run ends early if a contact does not end.
template <class Law>
inline ImpactOutput<Number<Law>> bounces(const Law& law, const ImpactInput<Number<Law>>& first, std::int64_t count,
                                         Number<Law>* speeds) noexcept {
  using T = Number<Law>;
  State<Law> state{};
  ImpactInput<T> in = first;
  ImpactOutput<T> out{first.speed, 0.0, 0.0, 0.0, -1, -1, 0};
  std::int64_t steps = 0;
  T phase = 0.5;
  for (std::int64_t k = 0; k < count; ++k) {
    in.gap = phase * in.speed * in.time_step - reforming_overlap(law, in.R_star, state);
    out = impact(of_law(law), in, {}, state);
    steps += out.steps;
    if (speeds) speeds[k] = out.rebound_speed;
    if (!(out.rebound_speed > 0.0)) break;
    in.speed = out.rebound_speed;
    phase += 0.6180339887498949;
    if (phase >= 1.0) phase -= 1.0;
  }
  out.steps = steps;
  return out;
}

}  // namespace epdem
