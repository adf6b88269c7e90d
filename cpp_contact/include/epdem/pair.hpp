// SPDX-License-Identifier: GPL-2.0-or-later
// What two bodies in contact have in common: effective modulus, radius and mass (Johnson 1985, section 4.2).
#pragma once

#include <cmath>
#include <limits>

#include "lanes.hpp"

namespace epdem {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double hertz_damping = 1.8257418583505538;  // 2 sqrt(5/6), of dashpots beside Hertz's springs

/// Elastic constants of one body; young_modulus may be infinite (a rigid body).
struct Elastic {
  double young_modulus;  // E [Pa]
  double poisson_ratio;  // nu [-]
};

/// Effective modulus E* of two bodies [Pa]: 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2.
inline double effective_modulus(Elastic i, Elastic j) noexcept {
  return 1.0 / ((1.0 - i.poisson_ratio * i.poisson_ratio) / i.young_modulus +
                (1.0 - j.poisson_ratio * j.poisson_ratio) / j.young_modulus);
}

/// Effective shear modulus G* [Pa]: 1/G* = (2-nu1)/G1 + (2-nu2)/G2 with G = E/(2(1+nu)).
inline double effective_shear_modulus(Elastic i, Elastic j) noexcept {
  const auto compliance = [](Elastic b) {
    return (2.0 - b.poisson_ratio) * 2.0 * (1.0 + b.poisson_ratio) / b.young_modulus;
  };
  return 1.0 / (compliance(i) + compliance(j));
}

/// 1/x = 1/a + 1/b of two finite radii or masses, as a b/(a + b).
template <class T>
EPDEM_INLINE T reduced_finite(T a, T b) noexcept {
  return a * b / (a + b);
}

}  // namespace epdem
