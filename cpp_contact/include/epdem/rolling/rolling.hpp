// SPDX-License-Identifier: BSD-3-Clause
// Input of a model of rolling friction. A model is a header beside this one and a line in
// sub_models.hpp:
//   name, id        of LIGGGHTS's rolling_friction; restart files keep the id
//   of_liggghts     LIGGGHTS has a class of the same model
//   has_history     a contact keeps a vector that changes its sign with the order of the bodies
//   torque<wall>(rolling, history)   torque on j [N m], its negative on i; history before and after
#pragma once

#include "../vec.hpp"

namespace epdem {

template <class T>
struct Rolling {
  Vec<T> normal;
  Vec<T> rotation;  // that it resists [rad/s]
  T R_star, overlap;
  T load;      // [N] that limits friction
  T k_n, k_t;  // [N/m]
  T friction;  // coefficient
  double dt;
  bool torsion;  // whether it resists torsion, too
};

/// rolling_friction off.
struct NoRolling {
  static constexpr const char* name = "off";
  static constexpr int id = 0;
  static constexpr bool of_liggghts = true, has_history = false;
  template <bool wall, class T>
  EPDEM_INLINE static Vec<T> torque(const Rolling<T>&, Vec<T>&) noexcept {
    return {};
  }
};

}  // namespace epdem
