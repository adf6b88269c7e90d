// SPDX-License-Identifier: BSD-3-Clause
// A cohesion model is a header beside this one and a line in sub_models.hpp:
//   name, id        of LIGGGHTS's cohesion; restart files keep the id
//   of_liggghts     LIGGGHTS has a class of the same model
//   area_ratio      area on which it pulls two spheres, over the area of the overlap's lens
//   force<wall>(kinematics, density)   force along the normal [N], negative: attraction; density [Pa]
#pragma once

#include "../kinematics.hpp"

namespace epdem {

/// cohesion off.
struct NoCohesion {
  static constexpr const char* name = "off";
  static constexpr int id = 0;
  static constexpr bool of_liggghts = true;
  static constexpr double area_ratio = 0.0;
  template <bool wall, class T>
  EPDEM_INLINE static T force(const Kinematics<T>&, T) noexcept {
    return T{};
  }
};

}  // namespace epdem
