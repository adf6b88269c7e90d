// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "backbone.hpp"
#include "power.hpp"

namespace epdem {

// Of Cavity's finite_strain: so large a number changes nothing; below the other the pressure loses its digits.
inline constexpr double no_finite_strain = 1e6, least_finite_strain = 1e-3;
/// Smallest area over that of small strain: from here on alpha k alpha^-0.35, F at large strain, would fall.
inline constexpr double least_area = 1.0 / 1.65;
/// Up to this ratio of overlaps Gauss's rule of six nodes gives the work of a phase to 2e-12.
inline constexpr double most_growth_of_phase = 2.0;

/// Three phases: elastic to p_0 = c_Y Y (eq. 8.78), expanding cavity (slope 2/3 of p_m/Y against ln a, eq. 8.81),
/// fully plastic with p_m = c_P Y (eq. 8.80) and a^2 = 2 R* alpha (eq. 8.85). This project's own composition:
///   s = alpha/alpha_Y;  1 < s < s_P:  a = a_Y s^((1+beta)/2),  p_m = Y [2 c_Y/3 + (1+beta)/3 ln s],
///   tau = ln s/ln s_P. Nothing is fitted.
/// Option finite_strain: p_m times f(s)/f(s_Y), s = l a/R*, f(s) = 1 - exp(-c s^-0.7), c = 0.82 (Jackson and Green
/// 2005, J. Tribol. 127, 343), l: curvature_share of both bodies; and on the area that a plane cuts from a sphere: a^2
/// times k = 1 - l^2 (alpha - alpha_Y)/(2 R*). The division keeps the force continuous at first yield; k >= 1/1.65
/// keeps it from falling.
template <class T>
struct Cavity {
  using number = T;
  static constexpr const char* name = "cavity";
  static constexpr int id = 43;
  static constexpr const char* title = "elastic, expanding cavity, fully plastic";
  static constexpr const char* sources = "Johnson 1985; Jackson and Green 2005; Mesarovic and Johnson 2000";
  static constexpr const char* condition =
      "plastic_ratio > first_yield_ratio, ln s_P > 0, no energy created at yield, finite_strain >= 1e-3";
  using State = Peak<T>;
  static constexpr bool yields = true;
  static constexpr bool flattens = true;
  static constexpr Parameter parameters[] = {{"yield_stress", "yieldStress", "Y", "Pa", not_given},
                                             {"first_yield_ratio", "firstYieldRatio", "c_Y", "1", 1.60},
                                             {"plastic_ratio", "plasticRatio", "c_P", "1", 2.8},
                                             {"finite_strain", "finiteStrain", "c_strain", "1", no_finite_strain}};
  static constexpr int n_parameters = 4;
  static constexpr int strength = 0;
  static constexpr double default_ratio = 1.0;
  static constexpr bool strength_by_ratio = false;

  T E_star{}, Y{}, c_Y{}, c_P{};
  T c_yield{};        // c (l a_Y/R*)^-0.7 of finite strain; infinite without
  T plastic_ratio{};  // alpha_P/R*
  T log_s_P{}, beta{};
  T a_ratio{};       // a_Y/R*, the root of alpha_Y/R*
  T yield_factor{};  // f(l a_Y/R*) of finite strain
  T cut{};           // l^2/2 of finite strain; 0 without

  static double hardening(const double* parameter) noexcept { return parameter[2] / parameter[1]; }

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const T* parameter) noexcept {
    const T c_Y = parameter[1], c_P = parameter[2];
    return c_P > c_Y && log_plastic(c_Y, c_P) > 0.0 && yield_excess(c_Y, c_P) <= 2.5 &&
           parameter[3] >= least_finite_strain;
  }

  Cavity() = default;
  /// Between bodies of equal strength, l = 1/2.
  Cavity(T E_star_, const T* parameter) noexcept
      : E_star(E_star_), Y(parameter[0]), c_Y(parameter[1]), c_P(parameter[2]) {
    a_ratio = pi * c_Y * Y / (2.0 * E_star);
    log_s_P = log_plastic(c_Y, c_P);
    plastic_ratio = yield_ratio() * exp(log_s_P);
    beta = log(T(2.0)) / log_s_P;
    const bool finite = parameter[3] < no_finite_strain;
    c_yield =
        finite ? parameter[3] * exponential<T>(-0.7 * logarithm(0.5 * a_ratio)) : std::numeric_limits<T>::infinity();
    cut = finite ? T(0.125) : T{};
    yield_factor = 1.0 - fallen(T{});
  }

  /// Gives the law of l = 1/2 another curvature_share.
  void confine(T share) noexcept {
    const T twice = max(constant<T>(1e-6), 2.0 * share);
    c_yield = c_yield * exponential<T>(-0.7 * logarithm(twice));
    cut = cut * (twice * twice);
    yield_factor = 1.0 - fallen(T{});
  }

  /// ln s_P; a value <= 0 puts full plasticity before first yield.
  static T log_plastic(T c_Y, T c_P) noexcept { return 3.0 * (c_P - 2.0 * c_Y / 3.0) - log(T(2.0)); }

  /// Left side of the condition that no energy is created just above yield; it must not exceed 2.5.
  static T yield_excess(T c_Y, T c_P) noexcept {
    const T log_s = log_plastic(c_Y, c_P), b = log(T(2.0)) / log_s;
    return 2.0 * (1.0 + b) * (1.0 + 1.0 / (2.0 * c_Y)) - 0.5 * (1.0 + b) - 0.125 / log_s;
  }

  /// The law without adhesion.
  const Cavity& backbone() const noexcept { return *this; }

  T yield_ratio() const noexcept { return a_ratio * a_ratio; }  // alpha_Y/R*

  T elastic_overlap(T R_star) const noexcept { return yield_ratio() * R_star; }

  auto softens() const noexcept { return c_yield < std::numeric_limits<double>::infinity(); }

  Point<T> load(T R_star, T delta) const noexcept {
    auto [p, log_a] = small_strain(R_star, delta);
    if (any(softens())) {
      const T left = area_left(R_star, delta);
      p.force = p.force * (left * (1.0 - fallen(log_a)) / yield_factor);
      p.radius = p.radius * sqrt(left);
    }
    return p;
  }

  /// Area that a plane cuts from a sphere over the area of small strain, k.
  T area_left(T R_star, T delta) const noexcept {
    return max(constant<T>(least_area), 1.0 - cut * max(T{}, delta / R_star - yield_ratio()));
  }

  /// The overlap from which on the area is the least one; infinite without finite strain.
  T least_overlap(T R_star) const noexcept { return elastic_overlap(R_star) + (1.0 - least_area) * R_star / cut; }

  /// d ln a/d ln alpha beyond yield.
  T widening(T R_star, T delta) const noexcept {
    const T rate = select(delta < plastic_ratio * R_star, 0.5 * (1.0 + beta), T{} + 0.5);
    const T left = 1.0 - cut * (delta / R_star - yield_ratio());
    return rate - select(left > least_area, 0.5 * cut * delta / (R_star * max(left, T{} + least_area)), T{});
  }

  /// 1 - f(s) of finite strain, from ln a/a_Y; f stays above 0.
  T fallen(T log_a) const noexcept {
    const T power = -c_yield * exponential<T>(-0.7 * log_a);
    return exponential<T>(min(constant<T>(-1e-14), max(constant<T>(-700.0), power)));
  }

  /// The backbone without finite strain, and ln a/a_Y where it is needed.
  struct SmallStrain {
    Point<T> point;
    T log_a;
  };

  SmallStrain small_strain(T R_star, T delta) const noexcept {
    const auto middle = delta < plastic_ratio * R_star;
    SmallStrain now{{2.0 * pi * R_star * c_P * Y * delta, sqrt(2.0 * R_star * delta), constant<T>(1.0)}, T{}};
    if (!any(middle) && !any(softens())) return now;
    const T log_s = logarithm(delta / (yield_ratio() * R_star));
    now.log_a = 0.5 * (log_s + 0.6931471805599453);
    if (any(middle)) {
      now.log_a = select(middle, 0.5 * (1.0 + beta) * log_s, now.log_a);
      const T a = a_ratio * R_star * exponential(now.log_a);
      const T p_m = Y * (2.0 / 3.0 * c_Y + (1.0 + beta) / 3.0 * log_s);
      now.point = select(middle, Point<T>{pi * a * a * p_m, a, log_s / log_s_P}, now.point);
    }
    return now;
  }

  T work(T R_star, T delta) const noexcept {
    const T delta_Y = elastic_overlap(R_star), delta_P = plastic_ratio * R_star;
    const auto beyond = delta > delta_Y;
    T W = hertz_work(E_star, R_star, min(delta, delta_Y));
    if (any(beyond)) {
      const T a_Y = a_ratio * R_star, A = 2.0 / 3.0 * c_Y, B = (1.0 + beta) / 3.0, n = 2.0 + beta;
      const T log_s = min(logarithm(only(beyond, delta / delta_Y)), log_s_P);
      // (s^n - 1)/n and (s^n ln s)/n - (s^n - 1)/n^2, the first by expm1 to stay exact near yield
      const T grow = expm1(n * log_s), I0 = grow / n;
      const T I1 = ((grow + 1.0) * log_s - I0) / n;
      const T more = W + pi * a_Y * a_Y * delta_Y * Y * (A * I0 + B * I1), x = max(T{}, delta - delta_P);
      W = select(beyond, more + pi * R_star * c_P * Y * x * (delta + delta_P), W);
      if (any(softens())) {
        const T reached = only(beyond, delta), middle = min(reached, delta_P);
        const T lost = fallen_work(R_star, delta_Y, middle) + fallen_work(R_star, delta_P, max(reached, delta_P));
        const T W_Y = hertz_work(E_star, R_star, delta_Y);
        W = select(beyond, W_Y + (W - W_Y - lost) / yield_factor, W);
      }
    }
    return W;
  }

  /// Work between two overlaps whose forces are known [J]. A step moves the overlap by little, and Simpson's rule has a
  /// relative error below 1e-10 where the overlap grows by less than 2 % within a phase.
  T work(T R_star, T from, T to, T F_from, T F_to) const noexcept {
    const T delta_Y = elastic_overlap(R_star), delta_P = plastic_ratio * R_star;
    const auto near = (to < 1.02 * from) & ((from >= delta_P) | ((from >= delta_Y) & (to <= delta_P)));
    T W{};
    if (any(near)) W = (to - from) / 6.0 * (F_from + 4.0 * load(R_star, 0.5 * (from + to)).force + F_to);
    if (any(!near)) W = select(near, W, work_of_phases(R_star, from, to));
    return W;
  }

  /// The same phase by phase; the closed form, which takes 64 nodes, only for a leap.
  [[gnu::noinline]] T work_of_phases(T R_star, T from, T to) const noexcept {
    const T delta_Y = elastic_overlap(R_star), delta_P = plastic_ratio * R_star;
    const T low = min(max(from, delta_Y), delta_P), middle = max(low, min(to, delta_P));
    const T above = max(from, delta_P), high = max(above, to);
    const auto leaps = (middle > most_growth_of_phase * low) | (high > most_growth_of_phase * above);
    T W = hertz_work(E_star, R_star, min(to, delta_Y)) - hertz_work(E_star, R_star, min(from, delta_Y));
    if (any(middle > low)) W = W + work_of_phase(R_star, low, middle);
    if (any(high > above)) W = W + work_of_phase(R_star, above, high);
    if (any(leaps)) W = select(leaps, work(R_star, to) - work(R_star, from), W);
    return W;
  }

  /// Work between two overlaps of one phase; Gauss's rule of six nodes.
  T work_of_phase(T R_star, T low, T high) const noexcept {
    constexpr double node[] = {0.2386191860831969, 0.6612093864662645, 0.932469514203152};
    constexpr double weight[] = {0.46791393457269104, 0.3607615730481386, 0.17132449237917036};
    const T middle = 0.5 * (low + high), half = 0.5 * (high - low);
    T sum{};
    for (int k = 0; k < 3; ++k) {
      const T way = node[k] * half;
      sum = sum + weight[k] * (load(R_star, middle - way).force + load(R_star, middle + way).force);
    }
    return half * sum;
  }

  /// What the fall of the pressure and of the area takes off the work between two overlaps of one phase.
  T fallen_work(T R_star, T low, T high) const noexcept {
    return sum_in_log(low, high, [&](T delta) {
      const SmallStrain now = small_strain(R_star, delta);
      return now.point.force * (1.0 - area_left(R_star, delta) * (1.0 - fallen(now.log_a))) * delta;
    });
  }

  /// The integral of f(alpha) d ln alpha; Gauss's rule.
  template <class F>
  static T sum_in_log(T low, T high, F f) noexcept {
    constexpr double node[] = {0.005299532504175031, 0.0277124884633837, 0.06718439880608412, 0.1222977958224985,
                               0.19106187779867811,  0.2709916111713863, 0.35919822461037054, 0.4524937450811813,
                               0.5475062549188188,   0.6408017753896295, 0.7290083888286136,  0.8089381222013219,
                               0.8777022041775016,   0.9328156011939159, 0.9722875115366163,  0.994700467495825};
    constexpr double weight[] = {
        0.013576229705877088, 0.031126761969323728, 0.0475792558412463,   0.062314485627767036,
        0.07479799440828835,  0.08457825969750132,  0.09130170752246182,  0.09472530522753432,
        0.09472530522753432,  0.09130170752246182,  0.08457825969750132,  0.07479799440828835,
        0.062314485627767036, 0.0475792558412463,   0.031126761969323728, 0.013576229705877088};
    const T range = logarithm(high / low);
    T sum{};
    for (int k = 0; k < 16; ++k) sum = sum + weight[k] * f(low * exponential<T>(node[k] * range));
    return range * sum;
  }
};

}  // namespace epdem
