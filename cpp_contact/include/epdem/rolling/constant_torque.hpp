// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rolling.hpp"

namespace epdem {

/// rolling_friction cdt: a torque of constant size against the rotation (Ai et al. 2011, model A).
struct ConstantTorque {
  static constexpr const char* name = "cdt";
  static constexpr int id = 1;
  static constexpr bool of_liggghts = true, has_history = false;

  template <bool wall, class T>
  EPDEM_INLINE static Vec<T> torque(const Rolling<T>& r, Vec<T>&) noexcept {
    const Vec<T>& w = r.rotation;
    const T speed = length(w);
    Vec<T> torque;
    if constexpr (wall)
      torque = r.R_star * (((r.friction * (r.overlap * r.k_n)) * w) / speed);
    else
      torque = (r.friction * r.k_n * r.overlap * r.R_star / speed) * w;
    if (!r.torsion) torque = torque - dot(torque, r.normal) * r.normal;
    return select(speed > 0.0, torque, Vec<T>{});
  }
};

}  // namespace epdem
