// SPDX-License-Identifier: GPL-2.0-or-later
// Oblique impact of solid spheres by velocity Verlet: the normal impact with friction beside it, of a plane motion.
#pragma once

#include "friction.hpp"
#include "impact.hpp"

namespace epdem {

/// What a plane oblique impact has beside a normal one.
template <class T>
struct ObliqueInput {
  T slip;       // velocity of the surfaces against each other before [m/s]
  T stiffness;  // 8 G* [Pa]
  T mu;
};

/// Velocity of the surfaces against each other [m/s] after an impact of solid spheres, or one on a plane: its reduced
/// mass is 2/7 m*. nodes: of partial slip, 2 or 3; 0: one spring.
template <int nodes, class Law>
inline Number<Law> slip_after(const Law& law, const ImpactInput<Number<Law>>& in,
                              const ObliqueInput<Number<Law>>& beside) noexcept {
  using T = Number<Law>;
  Friction<nodes, Law> friction;
  T u = beside.slip;
  State<Law> state{};
  impact(law, in, {}, state, [&](const Step<Law>& now, T force) noexcept {
    const Shear<T> motion{{T{}, T{}, T{} + 1.0}, {in.time_step * u, T{}, T{}}, T{}, T{}};
    const T kick = friction(pressed_by<Law>(now, force), motion, beside.stiffness, beside.mu).x;
    // the whole kick of this step's friction, half before and half after it is known: the slip is that of half a step
    u += 3.5 * in.time_step / in.m_star * kick;
  });
  return u;
}

}  // namespace epdem
