// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "backbone.hpp"

namespace epdem {

/// Elastic, perfectly plastic contact with a truncated Hertz pressure (Thornton 1997, J. Appl. Mech. 64, 383).
/// Hertz to alpha_y = a_y^2/R*, a_y = pi R* p_y/(2E*); then F = F_y + pi p_y R* (alpha - alpha_y), a^2 = R* alpha.
/// Its restitution is eq. 8.83, its yield speed eq. 8.84.
template <class T>
struct Thornton {
  using number = T;
  static constexpr const char* name = "thornton";
  static constexpr int id = 41;
  static constexpr const char* title = "elastic, perfectly plastic";
  static constexpr const char* sources = "Thornton 1997";
  static constexpr const char* condition = nullptr;
  using State = Maximum<T>;
  static constexpr bool yields = true;
  static constexpr bool flattens = false;
  static constexpr Parameter parameters[] = {{"yield_pressure", "yieldPressure", "p_y", "Pa", not_given}};
  static constexpr int n_parameters = 1;
  static constexpr int strength = 0;
  static constexpr double default_ratio = 2.8;
  static constexpr bool strength_by_ratio = true;

  T E_star{};
  T yield_ratio{};   // alpha_y/R*
  T slope_ratio{};   // pi p_y: slope of the plastic line over R*
  T offset_ratio{};  // (pi p_y alpha_y - F_y)/R*^2: F = (slope_ratio alpha - offset_ratio R*) R*

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const T*) noexcept { return true; }

  Thornton() = default;
  Thornton(T E_star_, const T* parameter) noexcept : E_star(E_star_) {
    const T p_y = parameter[0], q = pi * p_y / (2.0 * E_star_);
    yield_ratio = q * q;
    slope_ratio = pi * p_y;
    offset_ratio = slope_ratio * yield_ratio / 3.0;  // F_y = (2/3) pi p_y R* alpha_y
  }

  T elastic_overlap(T R_star) const noexcept { return yield_ratio * R_star; }

  Point<T> load(T R_star, T delta) const noexcept {
    return {(slope_ratio * delta - offset_ratio * R_star) * R_star, sqrt(R_star * delta), T{}};
  }

  T work(T R_star, T delta) const noexcept {
    const T delta_y = elastic_overlap(R_star), F_y = (slope_ratio - slope_ratio / 3.0) * delta_y * R_star;
    const T x = delta - delta_y, yielded = 0.4 * F_y * delta_y + (F_y + 0.5 * slope_ratio * R_star * x) * x;
    const auto elastic = x < 0.0;
    return any(elastic) ? select(elastic, hertz_work(E_star, R_star, delta), yielded) : yielded;
  }
};

}  // namespace epdem
