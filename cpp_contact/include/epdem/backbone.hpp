// SPDX-License-Identifier: GPL-2.0-or-later
// What every law's loading backbone returns and declares. A law is one header beside this one.
#pragma once

#include "pair.hpp"

namespace epdem {

/// A point of the loading backbone (or of an elastic branch).
struct Point {
  real force;     // F [N]
  real radius;    // contact radius a [m]
  real flatness;  // tau of the contact pressure: 0 Hertz's half-ellipse, 1 uniform
};

/// A material parameter of a law, as a host names and checks it.
struct Parameter {
  const char* name;      // in case files and in the C ABI
  const char* property;  // LIGGGHTS property/global
  const char* unit;
  real fallback;       // NaN: the host must give it
};

/// Hertz (1882): F = 4/3 E* sqrt(R*) alpha^1.5, a^2 = R* alpha. The elastic start of every law.
inline Point hertz_point(real E_star, real R_star, real delta) noexcept {
  const real a = std::sqrt(R_star * delta);
  return {4.0 / 3.0 * E_star * a * delta, a, 0.0};
}

/// Work to bring a Hertz contact to `delta` [J]: W = 8/15 E* sqrt(R*) alpha^2.5.
inline real hertz_work(real E_star, real R_star, real delta) noexcept {
  return 8.0 / 15.0 * E_star * std::sqrt(R_star * delta) * delta * delta;
}

}  // namespace epdem
