// SPDX-License-Identifier: BSD-3-Clause
// Geometry and motion of one contact in one step, by the operations of LIGGGHTS's surface model, so that the bits
// agree.
#pragma once

#include "pair.hpp"
#include "vec.hpp"

namespace epdem {

template <class T>
struct Kinematics {
  T radius_i, radius_j;  // [m]; radius_j of two spheres only
  T R_star;              // [m]
  T distance, overlap;   // of the centres, or of a centre and the wall [m]
  T arm_i, arm_j;        // from the centres to the middle of the overlap [m]
  T normal_velocity;     // of i against j along the normal [m/s], negative while they approach
  Vec<T> normal;         // unit vector from j, or the wall, to i
  Vec<T> slip_velocity;  // of the surfaces against each other [m/s]
  Vec<T> spin;           // sum of both spins [rad/s]
  Vec<T> rolling;        // rotation that rolling friction resists [rad/s]
};

namespace detail {

/// Slip velocity; `roll` is the sum of arm times spin over the distance.
template <class T>
EPDEM_INLINE Vec<T> slip_velocity(const Kinematics<T>& c, const Vec<T>& d, const Vec<T>& v,
                                  const Vec<T>& roll) noexcept {
  const Vec<T> vt = v - c.normal_velocity * c.normal;
  return {vt.x - (d.z * roll.y - d.y * roll.z), vt.y - (d.x * roll.z - d.z * roll.x),
          vt.z - (d.y * roll.x - d.x * roll.y)};
}

}  // namespace detail

/// Two spheres; d and v: centre and velocity of i minus centre and velocity of j.
template <class T>
EPDEM_INLINE Kinematics<T> between_spheres(T radius_i, T radius_j, const Vec<T>& d, const Vec<T>& v,
                                           const Vec<T>& spin_i, const Vec<T>& spin_j) noexcept {
  Kinematics<T> c;
  c.radius_i = radius_i;
  c.radius_j = radius_j;
  c.distance = length(d);
  const T inverse = 1.0 / c.distance;
  c.normal = inverse * d;
  c.normal_velocity = dot(v, c.normal);
  c.overlap = radius_i + radius_j - c.distance;
  c.arm_i = radius_i - 0.5 * c.overlap;
  c.arm_j = radius_j - 0.5 * c.overlap;
  c.R_star = reduced_finite(radius_i, radius_j);
  c.slip_velocity = detail::slip_velocity(c, d, v, inverse * (c.arm_i * spin_i + c.arm_j * spin_j));
  c.spin = spin_i + spin_j;
  c.rolling = spin_i - spin_j;
  return c;
}

/// A sphere at a wall whose overlap is known; d: from the wall to the centre, v: velocity minus velocity of the wall.
template <class T>
EPDEM_INLINE Kinematics<T> at_wall(T radius, T overlap, const Vec<T>& d, const Vec<T>& v, const Vec<T>& spin) noexcept {
  Kinematics<T> c;
  c.radius_i = radius;
  c.radius_j = c.arm_j = T{};
  c.distance = radius - overlap;
  const T inverse = 1.0 / c.distance;
  c.normal = inverse * d;
  c.normal_velocity = dot(v, c.normal);
  c.overlap = radius - c.distance;
  c.arm_i = radius - 0.5 * overlap;
  c.R_star = radius;
  c.rolling = inverse * (c.arm_i * spin);
  c.slip_velocity = detail::slip_velocity(c, d, v, c.rolling);
  c.spin = spin;
  return c;
}

/// From the point of a wall next to the centre of a sphere to the middle of the overlap, where the arm of the sphere
/// ends: the velocity of a wall that turns is the velocity there. d: from the wall to the centre.
inline Vec<double> to_middle(double overlap, const Vec<double>& d) noexcept {
  const double distance = length(d);
  return distance > 0.0 ? (-0.5 * overlap / distance) * d : Vec<double>{};
}

/// Spin [rad/s] of a rigid triangle from two of its edges and their rates.
inline Vec<double> spin_of_triangle(const Vec<double>& a, const Vec<double>& b, const Vec<double>& rate_a,
                                    const Vec<double>& rate_b) noexcept {
  const Vec<double> area = cross(a, b);
  const double square = dot(area, area);
  const Vec<double> rate_of_area =
      (-1.0 / square) * (dot(area, rate_a) * cross(b, area) + dot(area, rate_b) * cross(area, a));
  const double about_normal = dot(cross(area, a), rate_a) / (square * dot(a, a));
  return (1.0 / square) * cross(area, rate_of_area) + about_normal * area;
}

}  // namespace epdem
