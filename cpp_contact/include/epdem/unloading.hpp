// SPDX-License-Identifier: BSD-3-Clause
// The shared elastic branch below alpha_max: superposed rigid punches between the contact circle and a_max
// (Mossakovskii 1963; Mesarovic and Johnson 2000, eq. 8.82), in closed form for any flatness tau.
#pragma once

#include "backbone.hpp"

namespace epdem {

namespace detail {

/// [acos y - y sqrt(1-y^2)]/u^1.5 with u = 1 - y in [0, 1]: analytic there, so it keeps full relative accuracy
/// where the difference itself cancels. Minimax polynomial in t = 2u - 1, largest relative error 4e-16.
template <class T>
inline T segment(T u) noexcept {
  const T t = 2.0 * u - 1.0, t2 = t * t, t4 = t2 * t2, t8 = t4 * t4;
  const T c0 =
      (1.7371770873806556 - 0.15627588828780442 * t) + (-0.008779284872239073 - 0.0010977312731426958 * t) * t2;
  const T c1 = (-0.00018258110274334128 - 3.541558286543854e-05 * t) +
               (-7.571561566503503e-06 - 1.7315768282685705e-06 * t) * t2;
  const T c2 = (-4.1606712085594747e-07 - 1.0385134222493257e-07 * t) +
               (-2.6801506584044284e-08 - 7.066182450797425e-09 * t) * t2;
  const T c3 = (-1.7955643189145686e-09 - 4.897422784724471e-10 * t) +
               (-2.0040271807734243e-10 - 5.670711059879121e-11 * t) * t2;
  return (c0 + c1 * t4) + (c2 + c3 * t4) * t8;
}

}  // namespace detail

/// Force and contact radius at `delta` after unloading from `peak` at `delta_max` >= delta.
/// Flattens = false is the case tau = 0, compiled apart.
template <bool Flattens, class T>
inline Point<T> unload(T E_star, const Point<T>& peak, T delta_max, T delta) noexcept {
  if constexpr (!Flattens) {
    // Share of the recovery still stored. The division waits neither for delta, which a loop over contacts has last,
    // nor for the root in the radius.
    const T x = max(T{}, 1.0 - (delta_max - delta) * (peak.radius * (E_star / (0.75 * peak.force))));
    const T root = sqrt(x);
    return {peak.force * x * root, peak.radius * root, T{}};
  } else {
    const T w = (delta_max - delta) * (E_star * peak.radius / peak.force);
    const T tau = peak.flatness;
    const auto flat = tau == 1.0;  // fully plastic: A = 0, the equation for y is linear
    T u{}, share{};
    if (any(flat)) {
      u = 1.0 - 0.5 * pi * w;
      share = 2.0 / pi * u * sqrt(u) * detail::segment(u);
    }
    if (any(!flat)) {
      const T A = 0.75 * (1.0 - tau), B = 2.0 / pi * tau;
      const T S = B + sqrt(B * B + 4.0 * A * w), v = (S - 2.0 * w) / S;
      const T disc = v * (2.0 - v);  // 1 - y^2 with v = 1 - y
      u = select(flat, u, v);
      share = select(flat, share, (1.0 - tau) * disc * sqrt(disc) + B * v * sqrt(v) * detail::segment(v));
    }
    const auto open = u > 0.0;  // not parted yet
    return {select(open, peak.force * share, T{}), select(open, peak.radius * sqrt(u * (2.0 - u)), T{}), tau};
  }
}

/// What full unloading gives back.
template <class T>
struct Recovery {
  T overlap;  // delta_e = (A + B) F_max/(E* a_max) [m]
  T work;     // kappa F_max^2/(E* a_max) [J], kappa = 0.3 (1-tau)^2 + 0.5625 tau (1-tau) + 8/(3 pi^2) tau^2
};

template <class T>
EPDEM_INLINE Recovery<T> recovery(T E_star, const Point<T>& peak) noexcept {
  const T t = peak.flatness, way = peak.force / (E_star * peak.radius);
  return {(0.75 + (2.0 / pi - 0.75) * t) * way,
          (0.3 + (-0.0375 + (8.0 / (3.0 * pi * pi) - 0.2625) * t) * t) * peak.force * way};
}

template <class T>
inline T recovered_overlap(T E_star, const Point<T>& peak) noexcept {
  return recovery(E_star, peak).overlap;
}

template <class T>
inline T recovered_work(T E_star, const Point<T>& peak) noexcept {
  return recovery(E_star, peak).work;
}

/// Elastic energy [J] still stored at `delta` after unloading from `peak` at `delta_max`: the force integrated from
/// here to parting, F_max^2/(E* a_max) times the integral of f(y) (2 A y + B) from y to 1, in closed form, y = cos t.
template <class T>
inline T stored_work(T E_star, const Point<T>& peak, T delta_max, T delta) noexcept {
  const T scale = peak.force * peak.force / (E_star * peak.radius);
  const T w = (delta_max - delta) * (E_star * peak.radius / peak.force);
  const T tau = peak.flatness, A = 0.75 * (1.0 - tau), B = 2.0 / pi * tau;
  const T y = select(w > 0.0, 2.0 * w / (B + sqrt(B * B + 4.0 * A * w)), T{});
  // y = cos t, and t itself without an arc cosine
  const T u = max(T{}, 1.0 - y), s = sqrt(u * (2.0 - u)), c = 1.0 - u, t = u * sqrt(u) * detail::segment(u) + c * s;
  const T cube = s * s * s, s2 = 2.0 * s * c, c2 = 1.0 - 2.0 * s * s, s4 = 2.0 * s2 * c2;
  // integrals of (1-y^2)^1.5 and of g = acos y - y sqrt(1-y^2), each with weight 2y and with weight 1
  const T ellipse_2y = 0.4 * cube * s * s, ellipse = 0.375 * t - 0.25 * s2 + s4 / 32.0;
  const T g_2y = 0.25 * s2 - 0.5 * t * c2 - 0.25 * t + s4 / 16.0, g = s - t * c - cube / 3.0;
  return scale * ((1.0 - tau) * (A * ellipse_2y + B * ellipse) + tau * (2.0 / pi) * (A * g_2y + B * g));
}

}  // namespace epdem
