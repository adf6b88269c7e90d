// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../partial_slip.hpp"
#include "sliding.hpp"

namespace epdem {

/// tangential ep/partial_slip, ep/partial_slip_2: a contact circle with partial slip at 3 or 2 nodes.
template <int nodes>
struct PartialSlip {
  static constexpr const char* name = nodes == 3 ? "ep/partial_slip" : "ep/partial_slip_2";
  static constexpr int id = nodes == 3 ? 40 : 41, even_values = 1;
  static constexpr bool of_liggghts = false, adds_work = true;
  template <class T>
  using History = SlipState<nodes, T>;

  template <bool flattens, class T, class Observer>
  EPDEM_INLINE static Vec<T> force(const Sliding<T>& s, History<T>& history, Observer&& observer) noexcept {
    Vec<T> force;
    const auto advance = [&](auto damped) __attribute__((always_inline)) {
      const Shear<T> motion{s.normal, s.slip, s.turn, s.damping_per_step};
      if (!s.keeps) {
        force = present_friction<nodes, damped>(history, s.pressed.load, motion, s.stiffness, s.mu);
        return;
      }
      const auto now = partial_slip<nodes, flattens, damped>(history, s.pressed, motion, s.stiffness, s.mu);
      observer.friction([&]() __attribute__((always_inline)) {
        return FrictionWork<T>{slip_loss(history, now, s.slip, s.stiffness), slip_energy(now.after, s.stiffness)};
      });
      history = now.after;
      force = now.force;
    };
    if (s.damped)
      advance(std::true_type{});
    else
      advance(std::false_type{});
    return force;
  }
};

}  // namespace epdem
