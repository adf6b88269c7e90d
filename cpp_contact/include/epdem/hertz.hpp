// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "backbone.hpp"

namespace epdem {

/// Elastic contact (Hertz 1882): no yield, no memory.
struct Hertz {
  static constexpr const char* name = "hertz";
  static constexpr bool yields = false;  // remembers alpha_max
  static constexpr bool flattens = false;  // unloading needs the flatness tau
  static constexpr Parameter parameters[] = {{nullptr, nullptr, nullptr, 0.0}};
  static constexpr int n_parameters = 0;

  double E_star;

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const double*) noexcept { return true; }

  Hertz() noexcept : E_star(0.0) {}
  Hertz(double E_star_, const double*) noexcept : E_star(E_star_) {}

  /// Largest overlap of the elastic branch [m].
  double elastic_overlap(double) const noexcept { return std::numeric_limits<double>::infinity(); }
  /// The backbone at `delta` > elastic_overlap.
  Point load(double R_star, double delta) const noexcept { return hertz_point(E_star, R_star, delta); }
  /// Work along the backbone to `delta` [J].
  double work(double R_star, double delta) const noexcept { return hertz_work(E_star, R_star, delta); }
};

}  // namespace epdem
