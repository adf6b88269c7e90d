// SPDX-License-Identifier: GPL-2.0-or-later
// The shared elastic branch below alpha_max: superposed rigid punches between the contact circle and a_max
// (Mossakovskii 1963; Mesarovic and Johnson 2000, eq. 8.82), in closed form for any flatness tau.
#pragma once

#include "backbone.hpp"

namespace epdem {

namespace detail {

/// [acos y - y sqrt(1-y^2)]/u^1.5 with u = 1 - y in [0, 1]: analytic there, so it keeps full relative accuracy
/// where the difference itself cancels. Minimax polynomial in t = 2u - 1, largest relative error 4e-16.
inline real segment(real u) noexcept {
  const real t = 2.0 * u - 1.0, t2 = t * t, t4 = t2 * t2, t8 = t4 * t4;
  const real c0 = (1.7371770873806556 - 0.15627588828780442 * t) + (-0.008779284872239073 - 0.0010977312731426958 * t) * t2;
  const real c1 = (-0.00018258110274334128 - 3.541558286543854e-05 * t) + (-7.571561566503503e-06 - 1.7315768282685705e-06 * t) * t2;
  const real c2 = (-4.1606712085594747e-07 - 1.0385134222493257e-07 * t) + (-2.6801506584044284e-08 - 7.066182450797425e-09 * t) * t2;
  const real c3 = (-1.7955643189145686e-09 - 4.897422784724471e-10 * t) + (-2.0040271807734243e-10 - 5.670711059879121e-11 * t) * t2;
  return (c0 + c1 * t4) + (c2 + c3 * t4) * t8;
}

}  // namespace detail

/// Force and contact radius at `delta` after unloading from `peak` at `delta_max` >= delta.
/// Flattens = false is the case tau = 0, compiled apart.
template <bool Flattens>
inline Point unload(real E_star, const Point& peak, real delta_max, real delta) noexcept {
  if constexpr (!Flattens) {
    // Share of the recovery still stored. The division waits neither for delta, which a loop over contacts has last, nor
    // for the root in the radius.
    const real x = std::max(real(0.0), 1.0 - (delta_max - delta) * (peak.radius * (E_star / (0.75 * peak.force))));
    const real root = std::sqrt(x);
    return {peak.force * x * root, peak.radius * root, 0.0};
  } else {
    const real w = (delta_max - delta) * (E_star * peak.radius / peak.force);
    const real tau = peak.flatness;
    if (tau == 1.0) {  // fully plastic: A = 0, the equation for y is linear
      const real u = 1.0 - 0.5 * pi * w;
      if (!(u > 0.0)) return {0.0, 0.0, tau};
      const real share = 2.0 / pi * u * std::sqrt(u) * detail::segment(u);
      return {peak.force * share, peak.radius * std::sqrt(u * (2.0 - u)), tau};
    }
    const real A = 0.75 * (1.0 - tau), B = 2.0 / pi * tau;
    const real S = B + std::sqrt(B * B + 4.0 * A * w), u = (S - 2.0 * w) / S;  // u = 1 - y
    if (!(u > 0.0)) return {0.0, 0.0, tau};
    const real disc = u * (2.0 - u), root = std::sqrt(disc);  // 1 - y^2
    const real share = (1.0 - tau) * disc * root + B * u * std::sqrt(u) * detail::segment(u);
    return {peak.force * share, peak.radius * root, tau};
  }
}

/// Overlap given back on full unloading [m]: delta_e = (A + B) F_max/(E* a_max).
inline real recovered_overlap(real E_star, const Point& peak) noexcept {
  return (0.75 * (1.0 - peak.flatness) + 2.0 / pi * peak.flatness) * peak.force / (E_star * peak.radius);
}

/// Energy given back on full unloading [J]: kappa F_max^2/(a_max E*).
inline real recovered_work(real E_star, const Point& peak) noexcept {
  const real t = peak.flatness, r = 1.0 - t;
  const real kappa = 0.3 * r * r + 0.5625 * t * r + 8.0 / (3.0 * pi * pi) * t * t;
  return kappa * peak.force * peak.force / (peak.radius * E_star);
}

/// Elastic energy [J] still stored at `delta` after unloading from `peak` at `delta_max`: the force integrated from here
/// to parting, F_max^2/(E* a_max) times the integral of f(y) (2 A y + B) from y to 1, in closed form with y = cos theta.
template <bool Flattens>
inline real stored_work(real E_star, const Point& peak, real delta_max, real delta) noexcept {
  const real scale = peak.force * peak.force / (E_star * peak.radius);
  const real w = (delta_max - delta) * (E_star * peak.radius / peak.force);
  if constexpr (!Flattens) {
    const real x = std::max(real(0.0), 1.0 - w / 0.75);
    return 0.3 * scale * x * x * std::sqrt(x);
  } else {
    const real tau = peak.flatness, A = 0.75 * (1.0 - tau), B = 2.0 / pi * tau;
    const real y = 2.0 * w / (B + std::sqrt(B * B + 4.0 * A * w));
    if (w > 0.0 && !(y < 1.0)) return 0.0;
    const real t = std::acos(w > 0.0 ? y : real(0.0)), s = std::sin(t), c = std::cos(t);
    const real s2 = std::sin(2.0 * t), s4 = std::sin(4.0 * t), cube = s * s * s;
    // integrals of (1-y^2)^1.5 and of g = acos y - y sqrt(1-y^2), each with weight 2y and with weight 1
    const real ellipse_2y = 0.4 * cube * s * s, ellipse = 0.375 * t - 0.25 * s2 + s4 / 32.0;
    const real g_2y = 0.25 * s2 - 0.5 * t * std::cos(2.0 * t) - 0.25 * t + s4 / 16.0, g = s - t * c - cube / 3.0;
    return scale * ((1.0 - tau) * (A * ellipse_2y + B * ellipse) + tau * (2.0 / pi) * (A * g_2y + B * g));
  }
}

}  // namespace epdem
