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

/// The sentence on a work of adhesion with which a law would create energy between bodies of this R*, else empty.
template <class Law>
std::string refused_adhesion(const Law& law, double R_star) {
  if constexpr (adheres<Law>) {
    const double given = law.pull / pi;
    const double most = given > 0.0 && std::isfinite(R_star) ? largest_adhesion(law, R_star) : unlimited;
    if (given > most)
      return "the work of adhesion " + number(given) + " creates energy while a contact of R* = " + number(R_star) +
             " yields; law " + Law::name + " holds up to " + number(most) +
             " there, in proportion to R* and to the cube of the yield stress; lower it, or take law thornton_ning";
  }
  return {};
}

}  // namespace epdem
