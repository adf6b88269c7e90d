// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "backbone.hpp"

namespace epdem {

/// Fully plastic contact, eq. 8.85 (Johnson 1985, section 11.5): F = 2 pi R* p_m alpha, a^2 = 2 R* alpha,
/// and Hertz while that is the smaller force, i.e. to alpha_c = R* (3 pi p_m/(2E*))^2.
/// Without this elastic guard the law gives back more energy than it took. The radius jumps by sqrt 2 at alpha_c.
template <class T>
struct Johnson {
  using number = T;
  static constexpr const char* name = "johnson";
  static constexpr int id = 42;
  static constexpr const char* title = "elastic, then fully plastic";
  static constexpr const char* sources = "Johnson 1985";
  static constexpr const char* condition = nullptr;
  using State = Maximum<T>;
  static constexpr bool yields = true;
  static constexpr bool flattens = false;
  static constexpr Parameter parameters[] = {{"yield_pressure", "yieldPressure", "p_m", "Pa", not_given}};
  static constexpr int n_parameters = 1;
  static constexpr int strength = 0;
  static constexpr double default_ratio = 3.0;
  static constexpr bool strength_by_ratio = true;

  T E_star{};
  T yield_ratio{};  // alpha_c/R*
  T slope_ratio{};  // 2 pi p_m

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const T*) noexcept { return true; }

  Johnson() = default;
  Johnson(T E_star_, const T* parameter) noexcept : E_star(E_star_) {
    const T p_m = parameter[0], q = 3.0 * pi * p_m / (2.0 * E_star_);
    yield_ratio = q * q;
    slope_ratio = 2.0 * pi * p_m;
  }

  T elastic_overlap(T R_star) const noexcept { return yield_ratio * R_star; }

  Point<T> load(T R_star, T delta) const noexcept {
    return {slope_ratio * R_star * delta, sqrt(2.0 * R_star * delta), T{}};
  }

  T work(T R_star, T delta) const noexcept {
    const T delta_c = elastic_overlap(R_star), slope = slope_ratio * R_star, x = delta - delta_c;
    const T yielded = 0.4 * slope * delta_c * delta_c + 0.5 * slope * x * (delta + delta_c);
    const auto elastic = x < 0.0;
    return any(elastic) ? select(elastic, hertz_work(E_star, R_star, delta), yielded) : yielded;
  }
};

}  // namespace epdem
