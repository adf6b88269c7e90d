// SPDX-License-Identifier: GPL-2.0-or-later
// What two bodies in contact have in common: effective modulus, radius and mass (Johnson 1985, section 4.2).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

// Every host computes in double; the round-off batch of the C interface compiles the same laws in long double.
#ifndef EPDEM_REAL
#define EPDEM_REAL double
#endif

namespace epdem {

using real = EPDEM_REAL;

inline constexpr real pi = 3.14159265358979323846;

/// Elastic constants of one body; young_modulus may be infinite (a rigid body).
struct Elastic {
  real young_modulus;   // E [Pa]
  real poisson_ratio;   // nu [-]
};

/// Effective modulus E* of two bodies [Pa]: 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2.
inline real effective_modulus(Elastic i, Elastic j) noexcept {
  return 1.0 / ((1.0 - i.poisson_ratio * i.poisson_ratio) / i.young_modulus +
                (1.0 - j.poisson_ratio * j.poisson_ratio) / j.young_modulus);
}

/// Effective shear modulus G* [Pa]: 1/G* = (2-nu1)/G1 + (2-nu2)/G2 with G = E/(2(1+nu)).
inline real effective_shear_modulus(Elastic i, Elastic j) noexcept {
  const auto compliance = [](Elastic b) {
    return (2.0 - b.poisson_ratio) * 2.0 * (1.0 + b.poisson_ratio) / b.young_modulus;
  };
  return 1.0 / (compliance(i) + compliance(j));
}

/// 1/x = 1/a + 1/b for radii or masses; either may be infinite (a plane, a fixed body).
inline real reduced(real a, real b) noexcept {
  const real small = std::min(a, b), large = std::max(a, b);
  return small / (1.0 + small / large);
}

/// The same for two finite values, in a contact loop: a b/(a + b).
inline real reduced_finite(real a, real b) noexcept { return a * b / (a + b); }

}  // namespace epdem
