// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "backbone.hpp"
#include "power.hpp"

namespace epdem {

/// Elastic contact that hardens: the pressure is Hertz's, cut at p = p_y (a/a_y)^x (Meyer 1908: p_m ~ a^(n-2), x =
/// n-2). Hertz to alpha_y = a_y^2/R*, a_y = pi R* p_y/(2E*); then dF = 2 pi a p da and a^2 = R* alpha:
///   F = 2/(2+x) pi p_y R* [alpha q^x - (1-x)/3 alpha_y],  q = a/a_y;  dF/d alpha is continuous at yield.
/// x = 0 is Thornton's law, bit by bit; x = 1 would be Hertz's.
template <class T>
struct Meyer {
  using number = T;
  static constexpr const char* name = "meyer";
  static constexpr int id = 46;
  static constexpr const char* title = "elastic, plastic with a power of hardening";
  static constexpr const char* sources = "Meyer 1908; Tabor 1951; Thornton 1997";
  static constexpr const char* condition = nullptr;
  using State = PeakForce<T>;
  static constexpr bool yields = true;
  static constexpr bool flattens = false;
  static constexpr Parameter parameters[] = {
      {"yield_pressure", "yieldPressure", "p_y", "Pa", not_given},
      {"hardening_exponent", "hardeningExponent", "x", "1", 0.0, true, false, 1.0}};
  static constexpr int n_parameters = 2;
  static constexpr int strength = 0;
  static constexpr double default_ratio = 2.8;
  static constexpr bool strength_by_ratio = true;

  T E_star{};
  T yield_ratio{};  // alpha_y/R*
  T half_x{};
  T slope_ratio{};   // 2/(2+x) pi p_y
  T offset_ratio{};  // F = (slope_ratio alpha q^x - offset_ratio R*) R*

  /// Whether values within their ranges also make sense together.
  static bool valid(const T*) noexcept { return true; }

  Meyer() = default;
  Meyer(T E_star_, const T* parameter) noexcept : E_star(E_star_) {
    const T p_y = parameter[0], x = parameter[1], q = pi * p_y / (2.0 * E_star_);
    yield_ratio = q * q;
    half_x = 0.5 * x;
    slope_ratio = pi * p_y * (2.0 / (2.0 + x));
    offset_ratio = slope_ratio * (1.0 - x) * yield_ratio / 3.0;
  }

  T elastic_overlap(T R_star) const noexcept { return yield_ratio * R_star; }

  Point<T> load(T R_star, T delta) const noexcept {
    T reached = delta;  // alpha q^x
    if (any(half_x > 0.0)) reached = delta * power(delta / (yield_ratio * R_star), half_x);
    return {(slope_ratio * reached - offset_ratio * R_star) * R_star, sqrt(R_star * delta), T{}};
  }

  /// Thornton's work with other factors, and share slope R* alpha^2 (q^x - 1).
  T work(T R_star, T delta) const noexcept {
    const T delta_y = elastic_overlap(R_star), past = delta - delta_y, share = 1.0 / (2.0 + half_x);
    const auto elastic = past < 0.0;
    const T third = slope_ratio * (1.0 - 2.0 * half_x) / 3.0;
    const T F_y = (slope_ratio - third) * delta_y * R_star;
    const T line = (2.0 * share * slope_ratio - third) * delta_y * R_star;
    T W = 0.4 * F_y * delta_y + (line + share * slope_ratio * R_star * past) * past;
    if (any(half_x > 0.0)) {
      const T hardened = expm1(half_x * logarithm(only(!elastic, delta / delta_y)));
      W = W + share * slope_ratio * R_star * (delta * delta * hardened);
    }
    return any(elastic) ? select(elastic, hertz_work(E_star, R_star, delta), W) : W;
  }
};

}  // namespace epdem
