// SPDX-License-Identifier: BSD-3-Clause
// Optional viscous part of the elastic branches, for bodies that must come to rest: the restitution at low speed.
#pragma once

#include "law.hpp"

namespace epdem {

/// Smallest restitution that the dashpot can give: its limit is exp(-2) = 0.135.
inline constexpr double viscous_restitution_min = 0.14;

/// Dashpot number 2 sqrt(5/6) zeta of a Hertz contact with restitution e in [0.14, 1] (Tsuji, Tanaka and Ishida 1992,
/// with the force cut off at 0): zeta = sin phi, e = exp(-(pi - 2 phi) tan phi), phi by bisection.
inline double viscous_number(double e) noexcept {
  if (!(e < 1.0)) return 0.0;
  double low = 0.0, high = 0.5 * pi;
  for (int k = 0; k < 120; ++k) {
    const double phi = 0.5 * (low + high);
    (std::exp(-(pi - 2.0 * phi) * std::tan(phi)) > e ? low : high) = phi;
  }
  return hertz_damping * std::sin(low);
}

/// Whether a contact with this memory has yielded.
template <class Law>
inline auto has_yielded(const Law& law, Number<Law> R_star, const State<Law>& now) noexcept {
  if constexpr (adheres<Law>) {
    (void)law;
    (void)R_star;
    return now.dent > 0.0;
  } else {
    return now.delta_max > law.elastic_overlap(R_star);
  }
}

/// The step's force with the dashpot: 2 sqrt(5/6) zeta sqrt(k_n m*) times the approach speed [m/s], k_n = 2 E* a.
/// It acts where the force is below the backbone or on its elastic start, not while the contact yields; never attracts
/// more than the law does. reached: largest overlap before the step [m]; repeats: the last step is evaluated once more,
/// whose overlap is the largest if it yielded.
template <class Law>
inline Number<Law> damped_force(const Law& law, Number<Law> R_star, Number<Law> reached, const Step<Law>& now,
                                Number<Law> number, Number<Law> m_star, Number<Law> approach_speed, Number<Law> overlap,
                                bool repeats) noexcept {
  using T = Number<Law>;
  const T force = now.force + number * sqrt(2.0 * law.E_star * now.radius * m_star) * approach_speed;
  const T damped = adheres<Law> ? force : max(min(T{}, now.force), force);
  if constexpr (!Law::yields) {
    (void)R_star;
    (void)reached;
    (void)overlap;
    (void)repeats;
    return damped;
  } else {
    const auto grows = repeats ? overlap >= reached : now.after.delta_max > reached;
    return select(grows & has_yielded(law, R_star, now.after), now.force, damped);
  }
}

}  // namespace epdem
