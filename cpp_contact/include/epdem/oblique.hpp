// SPDX-License-Identifier: GPL-2.0-or-later
// Oblique impact of solid spheres by velocity Verlet: the normal impact with friction beside it, of a plane motion.
#pragma once

#include "impact.hpp"
#include "partial_slip.hpp"

namespace epdem {

/// What a plane oblique impact has beside a normal one.
template <class T>
struct ObliqueInput {
  T slip;       // velocity of the surfaces against each other before [m/s]
  T stiffness;  // 8 G* [Pa]
  T mu;
};

namespace detail {

/// One spring, T = 8 G* a s, cut off at mu F: LIGGGHTS's `tangential history`, as sliding_spring in the pair loop.
template <class T>
struct OneSpring {
  T stretch{};
  T operator()(const Pressed<T>& now, T slip, T stiffness, T mu) noexcept {
    const T k = stiffness * now.radius, most = mu * now.load;
    if (!(k > 0.0)) return stretch = 0.0;
    stretch += slip;
    if (fabs(k * stretch) > most) stretch = (stretch < 0.0 ? -most : most) / k;
    return -k * stretch;
  }
};

template <int nodes, bool flattens, class T>
struct Nodes {
  SlipState<nodes, T> state{};
  T operator()(const Pressed<T>& now, T slip, T stiffness, T mu) noexcept {
    const Shear<T> motion{{T{}, T{}, T{} + 1.0}, {slip, T{}, T{}}, T{}, T{}};
    const auto step = partial_slip<nodes, flattens, false>(state, now, motion, stiffness, mu);
    state = step.after;
    return step.force.x;
  }
};

}  // namespace detail

/// Velocity of the surfaces against each other [m/s] after an impact of solid spheres, or one on a plane: its reduced
/// mass is 2/7 m*. nodes: of partial slip, 2 or 3; 0: one spring.
template <int nodes, class Law>
inline Number<Law> slip_after(const Law& law, const ImpactInput<Number<Law>>& in,
                              const ObliqueInput<Number<Law>>& beside) noexcept {
  using T = Number<Law>;
  std::conditional_t<nodes == 0, detail::OneSpring<T>, detail::Nodes<nodes, Law::flattens, T>> friction;
  T u = beside.slip;
  State<Law> state{};
  impact(law, in, {}, state, [&](const Step<Law>& now, T force) noexcept {
    Pressed<T> pressed{force, now.radius, now.radius, T{}};
    if constexpr (Law::flattens) {
      pressed.radius_max = now.after.point.radius;
      pressed.flatness = now.after.point.flatness;
    }
    // the whole kick of this step's friction, half before and half after it is known: the slip is that of half a step
    u += 3.5 * in.time_step / in.m_star * friction(pressed, in.time_step * u, beside.stiffness, beside.mu);
  });
  return u;
}

}  // namespace epdem
