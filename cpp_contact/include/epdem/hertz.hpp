// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "backbone.hpp"

namespace epdem {

/// Elastic contact (Hertz 1882): no yield, no memory.
template <class T>
struct Hertz {
  using number = T;
  static constexpr const char* name = "hertz";
  static constexpr int id = 40;  // of the LIGGGHTS model ep/hertz; restart files keep it, it never changes
  static constexpr const char* title = "elastic";
  static constexpr const char* sources = "Hertz 1882";
  static constexpr const char* condition = nullptr;
  using State = Maximum<T>;                // what a contact remembers from step to step
  static constexpr bool yields = false;    // false: a host need not keep it
  static constexpr bool flattens = false;  // unloading needs the flatness tau
  static constexpr Parameter parameters[] = {{nullptr, nullptr, nullptr, nullptr, 0.0}};
  static constexpr int n_parameters = 0;
  static constexpr int strength = -1;                 // index of the parameter at which a body yields
  static constexpr double default_ratio = not_given;  // strength over the yield stress Y of the softer body
  static constexpr bool strength_by_ratio = false;    // a host may take Y and the ratio in place of the strength

  T E_star{};  // a law's data are numbers of type T only: a host fills lanes with them

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const T*) noexcept { return true; }

  Hertz() = default;
  Hertz(T E_star_, const T*) noexcept : E_star(E_star_) {}

  /// Largest overlap of the elastic branch [m].
  T elastic_overlap(T) const noexcept { return constant<T>(std::numeric_limits<double>::infinity()); }
  /// Valid for delta > elastic_overlap; unspecified below.
  Point<T> load(T R_star, T delta) const noexcept { return hertz_point(E_star, R_star, delta); }
  /// Work along the backbone to `delta` [J].
  T work(T R_star, T delta) const noexcept { return hertz_work(E_star, R_star, delta); }
};

}  // namespace epdem
