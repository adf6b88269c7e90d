// SPDX-License-Identifier: BSD-3-Clause
// The common part of adhesive laws: the curve of an elastic contact (Johnson, Kendall and Roberts 1971) by y = sqrt(a),
// and the forces of the two steps in which a contact forms and ends.
//
// y^4/R - c y = alpha - alpha_p, c = sqrt(2 pi Gamma/E*); the fold, where the contact ends, lies at y_f^3 = c R/4.
#pragma once

#include "backbone.hpp"
#include "lanes.hpp"

namespace epdem {
namespace adhesive {

/// Energies [J] that a step took for good: by yield, and in the jumps of the force at touch and parting.
template <class T>
struct Losses {
  T plastic, adhesive;
};

inline constexpr double fold_share = 0.62996052494743658;  // y_f in (c R)^(1/3): 4^(-1/3)

/// Work of adhesion [J/m^2] of two surfaces of these energies [J/m^2].
inline double work_of_adhesion(double gamma_i, double gamma_j) noexcept { return 2.0 * sqrt(gamma_i * gamma_j); }

/// Root of an attached contact where Gamma = 0.
inline constexpr double no_root = std::numeric_limits<double>::min();

/// (c R)^(1/3), the root of a contact; `known` is it already unless R has changed, or 0. Of an R that grew a little
/// two steps of Halley's method (third order) give it to round-off; the library's cbrt takes one lane at a time.
template <class T>
inline T refreshed(T known, T cube) noexcept {
  const T off = fabs(known * known * known - cube);
  const auto stale = off > 1e-12 * cube;
  if (!any(stale)) return known;
  T root = known;
  for (int k = 0; k < 2; ++k) {
    const T power = root * root * root;
    root = root * ((power + 2.0 * cube) / (2.0 * power + cube));
  }
  const auto far = stale & !(off < 0.05 * cube);
  if (any(far)) root = select(far, cbrt(only(far, cube)), root);
  return select(stale, root, known);
}

/// y = sqrt(a) of the standing contact at X = R (alpha - alpha_p): the largest root of y^4 - 4 y_f^3 y = X >= -3 y_f^4.
/// With y = y_f + e it is e^2 (e^2 + 4 y_f e + 6 y_f^2) = X + 3 y_f^4 = t^2, where all terms are positive, also at the
/// fold, at which the root is double. e is t/sqrt(6 y_f^2 + t) times a polynomial of degree 9, to 4e-6, and one step of
/// Chebyshev's method (of third order, one division) to round-off.
template <class T>
inline T curve(T y_f, T X) noexcept {
  const T f2 = y_f * y_f, square = max(X + 3.0 * f2 * f2, T{}), t = sqrt(square), scale = sqrt(6.0 * f2 + t);
  const T v = t / (t + 4.0 * y_f * scale), v2 = v * v, v4 = v2 * v2;
  const T low = (0.99999845 - 0.5165725 * v) + (0.74336657 - 0.37540549 * v) * v2;
  const T high = (0.024705481 + 1.04825180 * v) + (-1.19390857 - 0.54810887 * v) * v2;
  const T e = t / scale * (low + (high + (1.29345746 - 0.47578761 * v) * v4) * v4);
  const T e2 = e * e, slope = 1.0 / (4.0 * e * (e2 + 3.0 * y_f * (e + y_f)));
  const T newton = (e2 * (e2 + y_f * (4.0 * e + 6.0 * y_f)) - square) * slope;
  const T more = 6.0 * newton * slope * (e + y_f) * (e + y_f);
  return y_f + select(square > 0.0, e - newton * (1.0 + more), T{});
}

/// F [N] of the elastic curve at y and `own` = alpha - alpha_p: 4 E* y^6/(3 R) - 2 E* c y^3, with y^4/R = own + c y.
template <class T>
inline T force(T E_star, T c, T own, T y) noexcept {
  return 2.0 / 3.0 * E_star * y * y * (2.0 * own - c * y);
}

/// Elastic and surface energy [J] of the elastic curve at y, 0 for bodies apart: F is its slope by alpha.
template <class T>
inline T energy(T E_star, T c, T R, T y) noexcept {
  const T a = y * y, d = c * y, shape = a * a / R;
  return E_star * a * ((8.0 / 15.0 * shape - 4.0 / 3.0 * d) * shape + 0.5 * d * d);
}

/// The energy at touch and at the fold of an elastic curve of radius R.
template <class T>
inline T energy_at_touch(T E_star, T c, T R) noexcept {
  return energy(E_star, c, R, refreshed(T{}, c * R));
}
template <class T>
inline T energy_at_fold(T E_star, T c, T R) noexcept {
  return energy(E_star, c, R, fold_share * refreshed(T{}, c * R));
}

/// Largest gap [m] across which bodies still pull: the gap of the elastic fold, also for a contact with a dent.
template <class T>
inline T largest_gap(T c, T R_star) noexcept {
  const T y_f = fold_share * refreshed(T{}, c * R_star);
  return 0.75 * c * y_f;
}

/// Correction of the force of the step of touch [N]. A force that jumps within a step leaves velocity Verlet of first
/// order: the sum over the steps takes the jump for a whole step, but it has lasted for the share beyond/closing, and
/// half a step belongs to the trapezoid that starts here. `beyond` is the overlap since touch, `closing` the closing
/// speed at the half step times the step [m]. Nothing for a contact that is there without a crossing.
template <class T>
inline T on_touch(T jump, T beyond, T closing) noexcept {
  return select(beyond < 2.0 * closing, jump * (min(beyond / closing, T{} + 1.0) - 0.5), T{});
}

/// The force of the step after the last one attached [N], in which the overlap is `beyond` the fold [m]: what the sum
/// over the steps lacks. Near the fold F = F_fold - bend sqrt((alpha - alpha_f)/scale). A sum of roots over steps of h
/// differs from their integral by h^(3/2) zeta(-1/2, share) (Hurwitz), share h being the distance of the last step from
/// the fold; zeta is sqrt(share) and a smooth rest, here to 2e-4.
template <class T>
inline T on_parting(T F_fold, T bend, T scale, T beyond, T closing) noexcept {
  const T h = max(-closing, T{} + std::numeric_limits<double>::min()), share = max(1.0 - beyond / h, T{});
  const T rest = -0.20768371 + share * (-0.73462635 + share * (-0.30379973 + share * 0.03838347));
  const T F = F_fold * (share - 0.5) + bend * sqrt(h / scale) * (sqrt(share) + rest);
  return select(beyond < 2.0 * h, F, T{});
}

/// Its bend in an elastic contact, with the scale R [N].
template <class T>
inline T bend_at_fold(T E_star, T y_f) noexcept {
  return 16.0 / sqrt(6.0) * E_star * y_f * y_f * y_f * y_f;
}

/// The same of an elastic curve of radius R.
template <class T>
inline T on_parting(T E_star, T pull, T R, T y_f, T beyond, T closing) noexcept {
  return on_parting(-5.0 / 6.0 * pull * R, bend_at_fold(E_star, y_f), R, beyond, closing);
}

/// Work lost by yield in a step that grows [J].
template <class Law, class T>
inline T plastic_work_of_step(const Law& law, T R_star, const typename Law::State& before,
                              const typename Law::State& after) noexcept {
  const auto grows = after.delta_max > before.delta_max;
  if (!any(grows)) return T{};
  return select(grows, plastic_work(law, R_star, after) - plastic_work(law, R_star, before), T{});
}

}  // namespace adhesive

/// The radius R [m] of the elastic curve with the pull-off force of a contact, 3/2 pi Gamma R.
template <class Law, class T>
inline T opening_radius(const Law&, T R_star, const typename Law::State& now) noexcept {
  return select(now.dent > 0.0, now.R_open, R_star);
}

/// The overlap [m] at which a contact that broke forms again.
template <class Law>
inline typename Law::number reforming_overlap(const Law&, const typename Law::State& now) noexcept {
  return now.dent;
}

/// Work of adhesion [J/m^2] of bodies of this R* up to which a law creates no energy.
template <class Law>
inline double largest_adhesion(const Law&, double) noexcept {
  return std::numeric_limits<double>::infinity();
}

}  // namespace epdem
