// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "backbone.hpp"

namespace epdem {

/// Fully plastic contact, eq. 8.85 (Johnson 1985, section 11.5): F = 2 pi R* p_m alpha, a^2 = 2 R* alpha,
/// and Hertz while that is the smaller force, i.e. to alpha_c = R* (3 pi p_m/(2E*))^2.
/// Without this elastic guard the law gives back more energy than it took. The radius jumps by sqrt 2 at alpha_c.
struct Johnson {
  static constexpr const char* name = "johnson";
  static constexpr int id = 42;
  using State = Maximum;
  static constexpr bool yields = true;
  static constexpr bool flattens = false;
  static constexpr Parameter parameters[] = {
      {"yield_pressure", "yieldPressure", "Pa", not_given}};
  static constexpr int n_parameters = 1;
  static constexpr int strength = 0;
  static constexpr double default_ratio = 3.0;
  static constexpr bool strength_by_ratio = true;

  real E_star;
  real yield_ratio;  // alpha_c/R*
  real slope_ratio;  // 2 pi p_m

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const real*) noexcept { return true; }

  Johnson() noexcept : E_star(0.0), yield_ratio(0.0), slope_ratio(0.0) {}
  Johnson(real E_star_, const real* parameter) noexcept : E_star(E_star_) {
    const real p_m = parameter[0], q = 3.0 * pi * p_m / (2.0 * E_star_);
    yield_ratio = q * q;
    slope_ratio = 2.0 * pi * p_m;
  }

  real elastic_overlap(real R_star) const noexcept { return yield_ratio * R_star; }

  Point load(real R_star, real delta) const noexcept {
    return {slope_ratio * R_star * delta, std::sqrt(2.0 * R_star * delta), 0.0};
  }

  real work(real R_star, real delta) const noexcept {
    const real delta_c = elastic_overlap(R_star);
    if (!(delta > delta_c)) return hertz_work(E_star, R_star, delta);
    return hertz_work(E_star, R_star, delta_c) + 0.5 * slope_ratio * R_star * (delta - delta_c) * (delta + delta_c);
  }
};

}  // namespace epdem
