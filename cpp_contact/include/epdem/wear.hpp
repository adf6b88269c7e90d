// SPDX-License-Identifier: BSD-3-Clause
// Wear of a wall by spheres: the law of Finnie (1960), Wear 3, 87.
#pragma once

#include <cmath>

#include "kinematics.hpp"

namespace epdem {

/// Volume [m^3] that a sphere wears off a wall in a step. constant [m^2/N]; force, size [N]; velocity of the sphere
/// beside that of the wall [m/s]; from_wall: towards the centre; normal: unit normal of the surface, of either side.
/// A sphere that departs wears nothing.
inline double worn_volume(double constant, double force, const Vec<double>& velocity, const Vec<double>& from_wall,
                          const Vec<double>& normal, double dt) {
  const double speed = length(velocity);
  if (!(speed > 0.0) || dot(velocity, from_wall) > 0.0) return 0.0;
  const double sine = std::fabs(dot(velocity, normal)) / speed, cosine = length(cross(velocity, normal)) / speed;
  constexpr double third = 0.33333;  // the digits of LIGGGHTS, so that walls wear alike
  const double share = 3.0 * sine > cosine ? third * cosine * cosine : 2.0 * sine * cosine - 3.0 * sine * sine;
  return 2.0 * constant * share * force * speed * dt;
}

}  // namespace epdem
