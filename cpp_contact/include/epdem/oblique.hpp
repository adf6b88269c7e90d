// SPDX-License-Identifier: BSD-3-Clause
// Oblique impact of solid spheres by velocity Verlet: the normal impact with friction beside it, of a plane motion.
#pragma once

#include "impact.hpp"

namespace epdem {

/// Input of a plane oblique impact beside that of a normal one.
template <class T>
struct ObliqueInput {
  T slip;    // velocity of the surfaces against each other before [m/s]
  T G_star;  // [Pa]
  T mu;
};

/// Slip of a plane impact, moved on by the friction of each step.
template <class Friction, class Law>
struct ObliqueSlip {
  using T = Number<Law>;
  ContactConstants<Law> pair;
  double time_step, m_star;
  T& slip;  // [m/s]
  typename Friction::template History<T>& history;

  void step(const NormalContact<Law>& now) const noexcept {
    const auto sliding = sliding_of<Law>(pair, now, {T{}, T{}, T{} + 1.0}, {slip, T{}, T{}}, T{}, time_step, false);
    const T F = Friction::template force<Law::flattens>(sliding, history, NoObserver{}).x;
    // the whole kick of this step's friction, half before and half after it is known: the slip is the slip at half a
    // step
    slip += 3.5 * time_step / m_star * F;
  }
};

/// Velocity of the surfaces against each other [m/s] after an impact of solid spheres, or one on a plane: its reduced
/// mass is 2/7 m*.
template <class Friction, class Law>
inline Number<Law> slip_after(const Law& law, const ImpactInput<Number<Law>>& in,
                              const ObliqueInput<Number<Law>>& beside) noexcept {
  ContactConstants<Law> pair = of_law(law);
  pair.shear_modulus = beside.G_star;
  pair.friction = beside.mu;
  Number<Law> slip = beside.slip;
  typename Friction::template History<Number<Law>> history{};
  State<Law> state{};
  impact(pair, in, {}, state, ObliqueSlip<Friction, Law>{pair, in.time_step, in.m_star, slip, history});
  return slip;
}

}  // namespace epdem
