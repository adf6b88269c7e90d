// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sliding.hpp"

namespace epdem {

/// tangential history: a spring k_t = 8 G* a, cut off by Coulomb's limit (Cundall and Strack 1979), with a dashpot
/// inside the limit. The force is a continuous function of stretch, velocity and load, so that a contact that is looked
/// at without a step has the force of its step but for the change of these.
struct SlidingSpring {
  static constexpr const char* name = "history";
  static constexpr int id = 2, even_values = 0;
  static constexpr bool of_liggghts = true, adds_work = false;
  template <class T>
  struct History {
    Vec<T> stretch;  // [m]
  };

  template <bool flattens, class T, class Observer>
  EPDEM_INLINE static Vec<T> force(const Sliding<T>& s, History<T>& history, Observer&&) noexcept {
    Vec<T> stretch = history.stretch + s.slip;
    stretch = stretch - dot(stretch, s.normal) * s.normal;
    Vec<T> spring = -(s.k_t * stretch);
    const T most = s.mu * fabs(s.pressed.load);
    if (near_limit(dot(spring, spring), most)) {
      const T pull = s.k_t * length(stretch);
      const auto slides = pull > most;
      const Vec<T> slipping = (most / pull) * spring;
      stretch = select(slides, (-slipping) / s.k_t, stretch);
      spring = select(slides, slipping, spring);
    }
    history.stretch = stretch;
    return s.damped ? with_dashpot(spring, s.damping, s.velocity, most) : spring;
  }
};

}  // namespace epdem
