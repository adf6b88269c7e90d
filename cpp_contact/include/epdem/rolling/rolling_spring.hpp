// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../friction/sliding.hpp"
#include "rolling.hpp"

namespace epdem {

/// rolling_friction epsd2: a spring of stiffness k_t R*^2 (Iwashita and Oda 1998), cut off at mu_r F R*.
struct RollingSpring {
  static constexpr const char* name = "epsd2";
  static constexpr int id = 3;
  static constexpr bool of_liggghts = true, has_history = true;

  template <bool wall, class T>
  EPDEM_INLINE static Vec<T> torque(const Rolling<T>& r, Vec<T>& history) noexcept {
    Vec<T> w = r.rotation;
    if (!r.torsion) w = w - dot(w, r.normal) * r.normal;
    Vec<T> torque = history + (r.dt * (r.k_t * r.R_star * r.R_star)) * w;
    const T most = fabs(r.load) * r.R_star * r.friction;
    if (near_limit(dot(torque, torque), most)) {
      const T now = length(torque);
      torque = select(now > most, (most / now) * torque, torque);
    }
    history = torque;
    return torque;
  }
};

}  // namespace epdem
