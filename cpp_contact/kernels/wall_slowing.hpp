// SPDX-License-Identifier: BSD-3-Clause
// How a wall slows near the force at which it shall come to rest: it has a share of its speed.
#pragma once

#include <algorithm>

namespace epdem::kernels {

struct WallSlowing {
  double limit;  // [force]
  bool rises;    // the force rises to the limit; else it falls
  double near;   // part of the limit: so far from it the wall begins to slow
  double lag;    // steps within which the share follows, so that dashpots do not make it swing
  double share;

  /// After a step with a force: the share goes to what is left to the limit, beyond it back ten times slower.
  void follow(double force) {
    const double left = (rises ? 1.0 - force / limit : force / limit - 1.0) / near;
    share += (std::max(std::min(left, 1.0), std::max(0.1 * std::min(left, 0.0), -0.1)) - share) / lag;
  }
};

}  // namespace epdem::kernels
