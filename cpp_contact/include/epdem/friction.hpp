// SPDX-License-Identifier: GPL-2.0-or-later
// The tangential models beside a law as objects that remember: one spring, or partial slip.
#pragma once

#include "law.hpp"
#include "partial_slip.hpp"

namespace epdem {

/// What friction reads of a step of a law; `load` is the force that limits it.
template <class Law, class T>
EPDEM_INLINE Pressed<T> pressed_by(const Step<Law>& now, const T& load) noexcept {
  if constexpr (Law::flattens) return {load, now.radius, now.after.point.radius, now.after.point.flatness};
  return {load, now.radius, now.radius, T{}};
}

/// One spring, T = 8 G* a s, cut off at mu F: LIGGGHTS's `tangential history`, as sliding_spring in the pair loop.
template <class T>
struct OneSpring {
  Vec<T> stretch{};
  Vec<T> operator()(const Pressed<T>& now, const Shear<T>& motion, T stiffness, T mu) noexcept {
    stretch = stretch + motion.slip;
    stretch = stretch - dot(stretch, motion.normal) * motion.normal;
    const T k = stiffness * now.radius, most = mu * fabs(now.load), pull = k * sqrt(dot(stretch, stretch));
    if (pull > most) stretch = (most / pull) * stretch;
    return (-k) * stretch;
  }
};

/// Partial slip with so many nodes.
template <int nodes, bool flattens, class T>
struct Nodes {
  SlipState<nodes, T> state{};
  Vec<T> operator()(const Pressed<T>& now, const Shear<T>& motion, T stiffness, T mu) noexcept {
    const auto step = partial_slip<nodes, flattens, false>(state, now, motion, stiffness, mu);
    state = step.after;
    return step.force;
  }
};

/// nodes: of partial slip, 2 or 3; 0: one spring.
template <int nodes, class Law>
using Friction = std::conditional_t<nodes == 0, OneSpring<Number<Law>>, Nodes<nodes, Law::flattens, Number<Law>>>;

}  // namespace epdem
