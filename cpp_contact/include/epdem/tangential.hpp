// SPDX-License-Identifier: BSD-3-Clause
// Tangential spring and dashpot of a contact circle (Mindlin 1949; dashpot as in Tsuji, Tanaka and Ishida 1992).
#pragma once

#include "pair.hpp"

namespace epdem {

/// Spring k_t = 8 G* a [N/m] of a contact circle without slip.
template <class T>
inline T tangential_stiffness(T G_star, T radius) noexcept {
  return 8.0 * G_star * radius;
}

/// Damping number of a linear oscillator with restitution e in (0, 1]: beta = -ln e/sqrt(ln^2 e + pi^2).
inline double damping_number(double e) noexcept {
  const double log_e = std::log(e);
  return -log_e / std::sqrt(log_e * log_e + pi * pi);
}

/// Dashpot [N s/m] beside the spring k_t: 2 sqrt(5/6) beta sqrt(k_t m*).
template <class T>
inline T tangential_damping(T beta, T k_t, T m_star) noexcept {
  return hertz_damping * beta * sqrt(k_t * m_star);
}

}  // namespace epdem
