// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cohesion.hpp"

namespace epdem {

/// cohesion bond: spheres that have dented each other hold together until a pull over the contact area reaches the
/// strength [Pa]. It belongs to compaction (`grown_step`), which has the area; no force beside the law.
struct Bond {
  static constexpr const char* name = "ep/bond";
  static constexpr int id = 40;
  static constexpr bool of_liggghts = false;
  static constexpr double area_ratio = 0.0;

  template <bool wall, class T>
  EPDEM_INLINE static T force(const Kinematics<T>&, T) noexcept {
    return T{};
  }
};

}  // namespace epdem
