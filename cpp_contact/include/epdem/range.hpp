// SPDX-License-Identifier: BSD-3-Clause
// The range of a number that a user gives, and its text in messages.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "adhesive.hpp"

namespace epdem {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// A number in messages.
inline std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

/// Values between low and high; the ends belong to the range if they are included.
struct Range {
  double low, high;
  bool low_included = false, high_included = false;

  bool holds(double x) const noexcept {
    return (low_included ? x >= low : x > low) && (high_included ? x <= high : x < high);
  }
  std::string text() const {
    if (std::isinf(high)) return (low_included ? "must be >= " : "must be > ") + number(low);
    return std::string("must lie in ") + (low_included ? "[" : "(") + number(low) + ", " + number(high) +
           (high_included ? "]" : ")");
  }
};

/// Values of a law's parameter.
inline Range range_of(const Parameter& p) noexcept { return {0.0, p.below, p.may_vanish}; }

/// The least R* of bodies between which the law's work of adhesion creates no energy; 0: any R*. The largest work is in
/// proportion to R*.
template <class Law>
double least_R_star(const Law& law) {
  if constexpr (adheres<Law>)
    if (law.pull > 0.0) return law.pull / pi / largest_adhesion(law, 1.0);
  return 0.0;
}

/// The sentence on a work of adhesion with which a law would create energy between bodies of this R*, else empty.
template <class Law>
std::string refused_adhesion(const Law& law, double R_star) {
  const double least = least_R_star(law);
  if constexpr (adheres<Law>)
    if (R_star < least) {
      const double given = law.pull / pi;
      return "the work of adhesion " + number(given) + " creates energy while a contact of R* = " + number(R_star) +
             " yields; law " + Law::name + " holds up to " + number(given * R_star / least) +
             " there, in proportion to R* and to the cube of the yield stress; lower it, or take law thornton_ning";
    }
  return {};
}

}  // namespace epdem
