// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cohesion.hpp"

namespace epdem {

/// cohesion sjkr: energy density times the area of the overlap's lens.
struct Sjkr {
  static constexpr const char* name = "sjkr";
  static constexpr int id = 1;
  static constexpr bool of_liggghts = true;
  static constexpr double area_ratio = 1.0;

  template <bool wall, class T>
  EPDEM_INLINE static T force(const Kinematics<T>& c, T density) noexcept {
    const T &r = c.distance, &ri = c.radius_i, &rj = c.radius_j;
    if constexpr (wall) return -density * ((ri * ri - r * r) * pi);
    const T area = -pi / 4 * ((r - ri - rj) * (r + ri - rj) * (r - ri + rj) * (r + ri + rj)) / (r * r);
    return -density * area;
  }
};

}  // namespace epdem
