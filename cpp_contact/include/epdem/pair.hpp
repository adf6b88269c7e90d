// SPDX-License-Identifier: BSD-3-Clause
// Constants of two bodies in contact: effective modulus, radius and mass (Johnson 1985, section 4.2).
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

/// Whether body i is the softer of a pair, whose parameters a contact has: the body with the lower strength [Pa], at
/// equal strengths the first.
inline bool is_softer(double strength_i, double strength_j) noexcept { return !(strength_j < strength_i); }

/// Share of the strain of a contact that body i takes, from the strengths of both bodies [Pa]: 1/2 if they are equal, 1
/// if the strength of j is at least `hardening` times that of i, so that j never yields; both shares have the sum 1.
/// hardening: pressure of full plasticity over pressure of first yield, above 1.
inline double strain_share(double strength_i, double strength_j, double hardening) noexcept {
  const double low = strength_i < strength_j ? strength_i : strength_j;
  const double high = strength_i < strength_j ? strength_j : strength_i;
  const double t = high > low ? std::fmin(1.0, (high / low - 1.0) / (hardening - 1.0)) : 0.0;
  const double softer = 0.5 * (1.0 + t);
  return is_softer(strength_i, strength_j) ? softer : 1.0 - softer;
}

/// Shares of the two bodies of a contact.
template <class T>
struct BodyShares {
  T strain_i = T{} + 0.5;  // strain_share of i
  T compliance_i{};        // of i in the elastic compliance: E* (1-nu_i^2)/E_i; j has the rest
  T bulk_i{}, bulk_j{};    // compliance share times (1-2 nu)/(2 pi (1-nu^2))
};

inline BodyShares<double> body_shares(Elastic i, Elastic j, double strain_share_i) noexcept {
  const auto compliance = [](Elastic b) { return (1.0 - b.poisson_ratio * b.poisson_ratio) / b.young_modulus; };
  const auto bulk = [](Elastic b) {
    return (1.0 - 2.0 * b.poisson_ratio) / (2.0 * pi * (1.0 - b.poisson_ratio * b.poisson_ratio));
  };
  const double share = compliance(i) / (compliance(i) + compliance(j));
  return {strain_share_i, share, share * bulk(i), (1.0 - share) * bulk(j)};
}

/// The same when the bodies change places.
inline BodyShares<double> mirrored(const BodyShares<double>& b) noexcept {
  return {1.0 - b.strain_i, 1.0 - b.compliance_i, b.bulk_j, b.bulk_i};
}

/// Mean curvature of both bodies, weighted by their shares of the strain, times R*: R* (w_i/R_i + w_j/R_j), 1/2 between
/// bodies of equal strength, 1 for a sphere on a rigid plane, 0 for a rigid sphere on a plane.
template <class T>
EPDEM_INLINE T curvature_share(const BodyShares<T>& bodies, T R_star, T radius_i) noexcept {
  return 1.0 - bodies.strain_i + (2.0 * bodies.strain_i - 1.0) * (R_star / radius_i);
}

/// Share of the body that takes more of the strain: 1/2 to 1.
template <class T>
EPDEM_INLINE T larger_share(const BodyShares<T>& bodies) noexcept {
  return max(bodies.strain_i, 1.0 - bodies.strain_i);
}

/// 1/x = 1/a + 1/b of two finite radii or masses, as a b/(a + b).
template <class T>
EPDEM_INLINE T reduced_finite(T a, T b) noexcept {
  return a * b / (a + b);
}

}  // namespace epdem
