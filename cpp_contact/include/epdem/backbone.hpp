// SPDX-License-Identifier: BSD-3-Clause
// Result and declaration of every law's loading backbone. A law is one header beside this one.
#pragma once

#include <iterator>
#include <type_traits>
#include <utility>

#include "pair.hpp"

namespace epdem {

/// A point of the loading backbone (or of an elastic branch).
template <class T>
struct Point {
  T force;     // F [N]
  T radius;    // contact radius a [m]
  T flatness;  // tau of the contact pressure: 0 Hertz's half-ellipse, 1 uniform
};

template <class M, class T>
EPDEM_INLINE Point<T> select(M mask, const Point<T>& a, const Point<T>& b) noexcept {
  return {select(mask, a.force, b.force), select(mask, a.radius, b.radius), select(mask, a.flatness, b.flatness)};
}

/// A material parameter of a law, as hosts, theory and pages name and check it. Its range is (0, below).
struct Parameter {
  const char* name;      // in case files
  const char* property;  // LIGGGHTS property/global
  const char* symbol;    // in formulas, and of the theory's constructor
  const char* unit;
  double fallback;          // NaN: the host must give it
  bool may_vanish = false;  // the range is [0, below)
  bool of_pair = false;     // a value of two surfaces, not of a body
  double below = std::numeric_limits<double>::infinity();
};

inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

/// A contact's memory: the largest overlap so far [m]. `slots` names the values for a host that stores them.
template <class T>
struct Maximum {
  static constexpr const char* slots[] = {"delta_max"};
  T delta_max{};
};

/// The same for a law with an expensive backbone, which keeps the backbone's values at delta_max beside it.
template <class T>
struct Peak {
  static constexpr const char* slots[] = {"delta_max", "force_max", "radius_max", "flatness_max"};
  T delta_max{};
  Point<T> point{};
};

/// The same for a law of Thornton's radius, a^2 = R* alpha: the force alone is expensive.
template <class T>
struct PeakForce {
  static constexpr const char* slots[] = {"delta_max", "force_max"};
  T delta_max{};
  T force{};
};

template <class Law>
using Number = typename Law::number;
template <class Law>
using State = typename Law::State;

/// Whether bodies attract each other: the law's step then takes the closing speed as well, and a contact may stand
/// across a gap. True for the laws that say so.
template <class Law>
inline constexpr bool adheres = false;

/// How many values a host must keep from step to step.
template <class Law>
inline constexpr int history_size = Law::yields || adheres<Law> ? static_cast<int>(std::size(State<Law>::slots)) : 0;

namespace detail {

template <class Law, class = void>
inline constexpr bool declares_hardening = false;
template <class Law>
inline constexpr bool declares_hardening<Law, std::void_t<decltype(Law::hardening(std::declval<const double*>()))>> =
    true;

}  // namespace detail

/// Pressure of full plasticity over pressure of first yield: of metals, unless the law says otherwise.
template <class Law>
double hardening(const double* parameter) noexcept {
  (void)parameter;
  if constexpr (detail::declares_hardening<Law>) return Law::hardening(parameter);
  return 1.75;
}

/// Whether a law knows finite strain, which depends on the curvature_share of a contact.
template <class Law, class = void>
inline constexpr bool is_confined = false;
template <class Law>
inline constexpr bool is_confined<Law, std::void_t<decltype(&Law::confine)>> = true;

/// The law of a contact of this curvature_share, 1/2 for bodies of equal strength.
template <class Law>
Law law_of(Number<Law> E_star, const Number<Law>* parameters, Number<Law> share) noexcept {
  Law law(E_star, parameters);
  if constexpr (is_confined<Law>) law.confine(share);
  return law;
}

/// Result of a step of a law.
template <class Law>
struct Step {
  Number<Law> force;   // F [N], negative only with adhesion
  Number<Law> radius;  // contact radius a [m]; the stiffnesses are k_n = 2 E* a and k_t = 8 G* a
  State<Law> after;    // what the contact remembers if this step counts
};

/// A strength [Pa] that is given by the softer body's yield stress [Pa].
inline double strength_from(double yield_stress, double ratio) noexcept { return yield_stress * ratio; }

/// Hertz (1882): F = 4/3 E* sqrt(R*) alpha^1.5, a^2 = R* alpha. The elastic start of every law.
template <class T>
EPDEM_INLINE Point<T> hertz_point(T E_star, T R_star, T delta) noexcept {
  const T a = sqrt(R_star * delta);
  return {4.0 / 3.0 * E_star * a * delta, a, T{}};
}

/// Work to bring a Hertz contact to `delta` [J]: W = 8/15 E* sqrt(R*) alpha^2.5.
template <class T>
EPDEM_INLINE T hertz_work(T E_star, T R_star, T delta) noexcept {
  return 8.0 / 15.0 * E_star * sqrt(R_star * delta) * delta * delta;
}

}  // namespace epdem
