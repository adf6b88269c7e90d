// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cohesion.hpp"

namespace epdem {

/// cohesion sjkr2: energy density times 2 pi times the overlap times twice R*.
struct Sjkr2 {
  static constexpr const char* name = "sjkr2";
  static constexpr int id = 2;
  static constexpr bool of_liggghts = true;
  static constexpr double area_ratio = 2.0;

  template <bool wall, class T>
  EPDEM_INLINE static T force(const Kinematics<T>& c, T density) noexcept {
    const T &r = c.distance, &ri = c.radius_i, &rj = c.radius_j;
    if constexpr (wall) return -density * (pi * 2. * ri * (ri - r));
    return -density * (pi * 2. * (2. * ri * rj / (ri + rj)) * (ri + rj - r));
  }
};

}  // namespace epdem
