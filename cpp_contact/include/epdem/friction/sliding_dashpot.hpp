// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sliding.hpp"

namespace epdem {

/// tangential no_history: a dashpot, cut off by Coulomb's limit.
struct SlidingDashpot {
  static constexpr const char* name = "no_history";
  static constexpr int id = 1, even_values = 0;
  static constexpr bool of_liggghts = true, adds_work = false;
  template <class T>
  struct History {};

  template <bool flattens, class T, class Observer>
  EPDEM_INLINE static Vec<T> force(const Sliding<T>& s, History<T>&, Observer&&) noexcept {
    const T v = length(s.velocity), limit = s.mu * fabs(s.pressed.load);
    return (-select(limit < s.damping * v, limit / v, s.damping)) * s.velocity;
  }
};

}  // namespace epdem
