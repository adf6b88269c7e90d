// SPDX-License-Identifier: GPL-2.0-or-later
// What a step does with spheres beside their contacts, as lanes: half a step of their motion, and which of them are
// near a sphere or a triangle. Each number has the bits of a loop over single spheres.
#pragma once

namespace epdem::kernels {

/// Half a step of the motion of n spheres; x, v, omega, force and torque are rows of three.
struct HalfStep {
  int n;
  double *x, *v, *omega;  // x may be null: positions stay
  const double *force, *torque, *mass, *radius;
  double dt, dt_force, dt_torque;  // of positions; half; half over the factor of the moment of inertia
  double mass_factor;              // of added mass
};

/// What is nearer to a sphere than radius * factor + skin is near; of two spheres, with the sum of their radii.
struct NearTest {
  const double* spheres;  // rows of position and radius
  double factor, skin;
};

/// The plane of a triangle and those through its edges, normal to it and outward: a point and the unit normal of each.
/// A point beyond an edge by at most `precision` can count as inside.
struct TrianglePlanes {
  const double *point[4], *normal[4];
  double precision;
};

struct SphereKernels {
  /// v += dt_force F / (mass_factor m) and omega += dt_torque T / (R^2 m), then x += dt v.
  void (*half_step)(const HalfStep&);
  /// Whether one of n positions is farther than the root of `square` from where it was.
  bool (*any_moved)(const double* now, const double* before, int n, double square);
  /// Writes those of n candidates that are near, in their order, and returns their number: candidates above sphere
  /// `of`; those that LIGGGHTS lists at a triangle, each plane tested alone; those near a triangle by their distance,
  /// and few more at its corners. `found` may be the candidates and has room for one more.
  int (*near_sphere)(const NearTest&, int of, const int* candidates, int n, int* found);
  int (*listed_at_triangle)(const NearTest&, const TrianglePlanes&, const int* candidates, int n, int* found);
  int (*near_triangle)(const NearTest&, const TrianglePlanes&, const int* candidates, int n, int* found);
};

}  // namespace epdem::kernels
