// SPDX-License-Identifier: BSD-3-Clause
// The range of a number that a user gives, and its text in messages.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "backbone.hpp"

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

}  // namespace epdem
