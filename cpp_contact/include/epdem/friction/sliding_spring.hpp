// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sliding.hpp"

namespace epdem {

/// tangential history: a spring k_t = 8 G* a with a dashpot, cut off by Coulomb's limit (Cundall and Strack 1979).
struct SlidingSpring {
  static constexpr const char* name = "history";
  static constexpr int id = 2, even_values = 0;
  static constexpr bool of_liggghts = true, adds_work = false;
  template <class T>
  struct History {
    Vec<T> stretch;  // [m]
  };

  /// Whether a contact slides that is evaluated once more. A contact that slides is stored at its limit, so round-off
  /// of spring and overlap must not decide; a contact that sticks within 1e-6 of its limit lacks its dashpot then.
  template <class T>
  EPDEM_INLINE static auto still_slides(const T& pull, const T& most) noexcept {
    return pull >= (1.0 - 1e-6) * most;
  }

  template <bool flattens, class T, class Observer>
  EPDEM_INLINE static Vec<T> force(const Sliding<T>& s, History<T>& history, Observer&&) noexcept {
    Vec<T> stretch = history.stretch + s.slip;
    stretch = stretch - dot(stretch, s.normal) * s.normal;
    const Vec<T> spring = -(s.k_t * stretch);
    const T most = s.mu * fabs(s.pressed.load);
    Vec<T> force = s.damped ? spring - s.damping * s.velocity : spring;
    if (!s.keeps || near_limit(dot(spring, spring), most)) {
      const T pull = s.k_t * length(stretch);
      const auto slides = pull > most;
      const Vec<T> slipping = (most / pull) * spring;
      stretch = select(slides, (-slipping) / s.k_t, stretch);
      if (!s.keeps) force = select(still_slides(pull, most), spring, force);
      force = select(slides, slipping, force);
    }
    history.stretch = stretch;
    return force;
  }
};

}  // namespace epdem
