// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "adhesive.hpp"
#include "cavity.hpp"
#include "law.hpp"

namespace epdem {

/// The opening curve of a flattened adhesive contact below its peak (F0, a0, tau), by z = sqrt(a/a0) and v = 1 -
/// sqrt(1 - z^4): alpha_u = F0/(E* a0) (2 A + B - A v) v and F_u of `unload`, both from the dent; F = F_u - 2 E* a d,
/// alpha = alpha_u - d, d = c sqrt(a).
template <class T>
struct FlattenedOpening {
  T E_star, c;
  Point<T> peak;
  T A, B, way, y0, k;  // way: F0/(E* a0) [m]; y0: sqrt(a0); k: d(a0) in way

  FlattenedOpening(T E_star_, T c_, const Point<T>& peak_) noexcept : E_star(E_star_), c(c_), peak(peak_) {
    A = 0.75 * (1.0 - peak.flatness);
    B = 2.0 / pi * peak.flatness;
    way = peak.force / (E_star * peak.radius);
    y0 = sqrt(peak.radius);
    k = c * y0 / way;
  }

  static T depth(T z) noexcept {
    const T z4 = (z * z) * (z * z);
    return z4 / (1.0 + sqrt(max(T{}, 1.0 - z4)));
  }
  T overlap(T z) const noexcept {
    const T v = depth(z);
    return way * ((2.0 * A + B - A * v) * v - k * z);
  }
  T punch(T z) const noexcept { return 2.0 * E_star * c * (y0 * z) * (y0 * z) * (y0 * z); }
  /// F_u [N].
  T opened(T z) const noexcept {
    const T v = depth(z), s = z * z;
    return peak.force * ((1.0 - peak.flatness) * s * s * s + B * v * sqrt(v) * detail::segment(v));
  }
  T force(T z) const noexcept { return opened(z) - punch(z); }

  /// Elastic and surface energy [J]: F is its slope by alpha.
  T energy(T z) const noexcept {
    const T a = y0 * z * (y0 * z), d = c * y0 * z, v = depth(z);
    const T rest = way * (A * (1.0 - v) * (1.0 - v) + B * (1.0 - v));  // overlap below the peak
    return stored_work(E_star, peak, rest, T{}) - opened(z) * d + 0.5 * E_star * a * d * d;
  }

  /// The z at which a d alpha_u/da = factor d/2: the fold of factor 1, the pull-off of factor 3. The root of z^3 (2 A y
  /// + B) = factor k y/2, y = sqrt(1 - z^4), by Newton's method from the root at small z, which is above: in n with y =
  /// (1 - n^4)/(1 + n^4), of which all is smooth.
  T extreme(double factor) const noexcept {
    const T half = 0.5 * factor * k, first = min(cbrt(half / (2.0 * A + B)), T{} + 1.0);
    const T start = first * first * first * first;
    T n = first / sqrt(1.0 + sqrt(max(T{}, 1.0 - start)));
    for (int i = 0; i < 6; ++i) {
      const T n2 = n * n, r2 = 1.0 / (1.0 + n2 * n2), r = sqrt(r2), y = (1.0 - n2 * n2) * r2, z = root2 * n * r;
      const T dy = -8.0 * n2 * n * r2 * r2, dz = root2 * y * r, z2 = z * z, rim = 2.0 * A * y + B;
      const T slope = 3.0 * z2 * dz * rim + 2.0 * A * z2 * z * dy - half * dy;
      n = n - select(n > 0.0, (z2 * z * rim - half * y) / max(slope, T{} + tiny), T{});
    }
    const T n4 = (n * n) * (n * n);
    return min(root2 * n / sqrt(1.0 + n4), T{} + 1.0);
  }

  /// The largest z at `own` [m] from the dent, at most 1; z_f: its fold. Four steps of Newton's method on z =
  /// Z(alpha_u) from the curve of a small z with the same fold.
  T at(T own, T z_f) const noexcept {
    const T f2 = z_f * z_f, C = 2.0 * A + B, x = own / way;
    const T beyond = max(T{}, (own - overlap(z_f)) / way);
    T z = min(adhesive::curve(z_f, beyond / (A + 0.5 * B) - 3.0 * f2 * f2), T{} + 1.0);
    for (int i = 0; i < 4; ++i) {
      const T W = x + k * z, S = sqrt(max(C * C - 4.0 * A * W, T{} + tiny));
      const T v = min(max(T{}, 2.0 * W / (C + S)), T{} + 1.0), s = sqrt(v * (2.0 - v)), Z = sqrt(s);
      const T slope = 1.0 - 0.5 * k * (1.0 - v) / (max(s * Z, T{} + tiny) * S);
      z = min(max(z - (z - Z) / max(slope, T{} + 1e-7), z_f), T{} + 1.0);
    }
    return z;
  }

  /// F = F_f - bend sqrt(alpha - alpha_f) near the fold: 2 E* d sqrt(2/alpha'') [N m^(-1/2)].
  T bend(T z_f) const noexcept {
    const T a = y0 * z_f * (y0 * z_f), y = max(1.0 - depth(z_f), T{} + 1e-8), d = c * y0 * z_f;
    const T second = way / (peak.radius * peak.radius) * (2.0 * A + B / (y * y * y)) + 0.25 * d / (a * a);
    return 2.0 * E_star * d * sqrt(2.0 / second);
  }

 private:
  static constexpr double root2 = 1.4142135623730951, tiny = 1e-150;
};

/// `cavity` with adhesion: a punch in tension superposed on each contact, F = F_b - 2 E* a d, alpha = alpha_b - d, d =
/// sqrt(2 pi Gamma a/E*), of Cavity's force F_b and overlap alpha_b while it grows and of eq. 8.82 below (this
/// project's own composition). JKR's contact before yield; a JKR contact of R' = 4 E* a0^3/(3 b F0), b = 1 - tau + 4
/// tau/(3 pi), near its end. Growth creates no energy up to largest_adhesion; hosts refuse more. Gamma = 0 is `cavity`,
/// finite_strain that of its F_b and a.
template <class T = double>
struct CavityAdhesive {
  using number = T;
  static constexpr const char* name = "cavity_adhesive";
  static constexpr int id = 47;  // of a LIGGGHTS model: restart files keep it, it never changes
  static constexpr const char* title = "elastic, expanding cavity, fully plastic, with adhesion";
  static constexpr const char* sources = "Johnson 1985; Mesarovic and Johnson 2000; Johnson, Kendall and Roberts 1971";
  static constexpr const char* condition = Cavity<T>::condition;
  static constexpr const char* without_adhesion = "cavity";  // the law of the same bodies with Gamma = 0
  static constexpr bool yields = true;
  static constexpr bool flattens = true;
  static constexpr Parameter parameters[] = {
      {"work_of_adhesion", "workOfAdhesion", "Gamma", "J/m^2", not_given, true, true},
      {"yield_stress", "yieldStress", "Y", "Pa", not_given},
      {"first_yield_ratio", "firstYieldRatio", "c_Y", "1", 1.60},
      {"plastic_ratio", "plasticRatio", "c_P", "1", 2.8},
      {"finite_strain", "finiteStrain", "c_strain", "1", no_finite_strain}};
  static constexpr int n_parameters = 5;
  static constexpr int strength = 1;
  static constexpr double default_ratio = 1.0;
  static constexpr bool strength_by_ratio = false;

  /// History of a contact: its opening curve. One that broke inside its dent keeps all but the root.
  struct State {
    static constexpr const char* slots[] = {"delta_max", "root",      "dent",       "R_open",
                                            "jump",      "force_max", "radius_max", "flatness_max"};
    T delta_max{};     // largest overlap [m]
    T root{};          // sqrt(a) at the fold over 4^(-1/3) while the bodies are attached [m^(1/2)], else 0
    T dent{};          // alpha_p [m], from which the opening curve counts its overlap; 0 before yield
    T R_open{};        // pull-off force over 3/2 pi Gamma [m] of a contact with a dent
    T jump{};          // what a crossing of touch or fold in the last step added to the force [N]
    Point<T> point{};  // of Cavity at the peak of a contact with a dent
  };

  T E_star{};
  T c{};     // sqrt(2 pi Gamma/E*): d = c sqrt(a)
  T pull{};  // pi Gamma
  Cavity<T> body{};

  static double hardening(const double* parameter) noexcept { return Cavity<T>::hardening(parameter + 1); }

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const T* parameter) noexcept { return Cavity<T>::valid(parameter + 1); }

  CavityAdhesive() = default;
  CavityAdhesive(T E_star_, const T* parameter) noexcept : E_star(E_star_), pull(pi * parameter[0]) {
    c = sqrt(2.0 * pull / E_star);
    body = Cavity<T>(E_star, parameter + 1);
  }

  const Cavity<T>& backbone() const noexcept { return body; }

  void confine(T share) noexcept { body.confine(share); }
  auto softens() const noexcept { return body.softens(); }

  /// d [m] of a radius.
  T opening(T radius) const noexcept { return c * sqrt(radius); }
  T punch(T radius) const noexcept { return 2.0 * E_star * radius * opening(radius); }

  /// Overlap [m] at which a contact yields; negative where its attraction makes it yield at touch.
  T yield_overlap(T R_star) const noexcept { return body.elastic_overlap(R_star) - opening(body.a_ratio * R_star); }

  /// alpha_b [m] of a growing contact at `delta` beyond yield: alpha_b - d = delta. Fully plastic it is JKR's curve of
  /// 2 R*, which bounds the overlap of the phase before from above: there three steps of Halley's method. Finite strain
  /// lowers alpha_b, by little: Newton's method on a concave d.
  T backbone_overlap(T R_star, T delta) const noexcept {
    T b = small_strain_overlap(R_star, delta);
    if (!any(softens())) return b;
    for (int i = 0; i < 5; ++i) {
      const T d = opening(body.load(R_star, b).radius);
      b = max(b - (b - d - delta) / (1.0 - 0.5 * d / b * body.widening(R_star, b)), body.elastic_overlap(R_star));
    }
    return b;
  }

  T small_strain_overlap(T R_star, T delta) const noexcept {
    const T R = 2.0 * R_star, y = adhesive::curve(adhesive::fold_share * cbrt(c * R), R * delta);
    const T wide = y * y * (y * y) / R, delta_P = body.plastic_ratio * R_star;
    const auto middle = delta < delta_P - opening(sqrt(R * delta_P));
    if (!any(middle)) return wide;
    const T delta_Y = body.elastic_overlap(R_star), p = 0.25 * (1.0 + body.beta);
    const T D = opening(body.a_ratio * R_star) / delta_Y, x = delta / delta_Y;
    T s = max(only(middle, wide) / delta_Y, T{} + 1.0);
    for (int i = 0; i < 3; ++i) {
      const T t = D * exponential<T>(p * logarithm(s)), f = s - t - x, slope = 1.0 - p * t / s;
      s = max(s - f * slope / (slope * slope - 0.5 * f * p * (1.0 - p) * t / (s * s)), T{} + 1.0);
    }
    return select(middle, s * delta_Y, wide);
  }

  /// The integral of d (2 E* a d alpha_b - dF_b) from yield to alpha_b >= alpha_Y [J].
  T mismatch(T R_star, T overlap) const noexcept {
    if (any(softens())) return mismatch_by_quadrature(R_star, overlap);
    const T q = 0.5 * (1.0 + body.beta), n = 2.5 * q, m = 1.5 * q + 1.0, A = 2.0 / 3.0 * body.c_Y, B = 2.0 / 3.0 * q;
    const T delta_Y = body.elastic_overlap(R_star), delta_P = body.plastic_ratio * R_star;
    const T a_Y = body.a_ratio * R_star, a_P = sqrt(2.0 * R_star * delta_P), y_Y = sqrt(a_Y);
    const T log_s = min(logarithm(overlap / delta_Y), body.log_s_P), grow = expm1(n * log_s);
    const T pressure = (2.0 * q * A + B) * grow / n + 2.0 * q * B * (log_s * (grow + 1.0) - grow / n) / n;
    const T middle = 2.0 * E_star * a_Y * delta_Y * expm1(m * log_s) / m - pi * a_Y * a_Y * body.Y * pressure;
    const T a = max(a_P, sqrt(2.0 * R_star * overlap)), y = sqrt(a), y_P = sqrt(a_P);
    const T stiff = 4.0 / 7.0 * E_star / R_star * (a * a * a * y - a_P * a_P * a_P * y_P);
    const T above = stiff - 0.8 * pi * body.c_P * body.Y * (a * a * y - a_P * a_P * y_P);
    return c * (y_Y * middle + select(overlap > delta_P, above, T{}));
  }

  /// 2 E* a d + F_b d' [N], which mismatch_by_quadrature sums.
  T mismatch_slope(T R_star, T overlap, const Point<T>& now) const noexcept {
    return opening(now.radius) *
           (2.0 * E_star * now.radius + 0.5 * now.force * body.widening(R_star, overlap) / overlap);
  }

  /// The mismatch in parts: -d F_b and the integral of mismatch_slope, by Gauss's rule in ln alpha_b between the kinks.
  T mismatch_by_quadrature(T R_star, T overlap) const noexcept {
    const T delta_Y = body.elastic_overlap(R_star), P = body.plastic_ratio * R_star, L = body.least_overlap(R_star);
    const auto slope = [&](T b) { return b * mismatch_slope(R_star, b, body.load(R_star, b)); };
    const T middle = min(overlap, min(P, L)), upper = max(middle, min(overlap, max(P, L)));
    T sum = body.sum_in_log(delta_Y, middle, slope);
    if (any(upper > middle)) sum = sum + body.sum_in_log(middle, upper, slope);
    if (any(overlap > upper)) sum = sum + body.sum_in_log(upper, max(overlap, upper), slope);
    const Point<T> first = body.load(R_star, delta_Y), last = body.load(R_star, overlap);
    return opening(first.radius) * first.force - opening(last.radius) * last.force + sum;
  }

  /// W_b - U - mismatch [J] of a peak at alpha_b: what its growth since yield has taken for good.
  T lost(T R_star, T overlap, const Point<T>& peak) const noexcept {
    return body.work(R_star, overlap) - recovered_work(E_star, peak) - mismatch(R_star, overlap);
  }

  /// The increase of lost between near peaks of one phase, by Simpson's rule.
  T lost_between(T R_star, T from, T to, const Point<T>& first, const Point<T>& last) const noexcept {
    const T middle = 0.5 * (from + to), sixth = (to - from) / 6.0;
    const Point<T> now = body.load(R_star, middle);
    const auto loss = [&](T b, const Point<T>& p) { return p.force - mismatch_slope(R_star, b, p); };
    const auto rest = [&](const Point<T>& p) { return opening(p.radius) * p.force - recovered_work(E_star, p); };
    return sixth * (loss(from, first) + 4.0 * loss(middle, now) + loss(to, last)) + rest(last) - rest(first);
  }

  /// Elastic and surface energy [J] at a peak.
  T energy_at_peak(const Point<T>& peak) const noexcept {
    const T d = opening(peak.radius);
    return recovered_work(E_star, peak) + (0.5 * E_star * peak.radius * d - peak.force) * d;
  }

  /// Work from touch to `delta` [J] while the contact grows.
  T work(T R_star, T delta) const noexcept {
    const auto potential = [&](T at) {
      const T root = adhesive::refreshed(T{}, c * R_star);
      const T y = adhesive::curve(adhesive::fold_share * root, R_star * at);
      T W = adhesive::energy(E_star, c, R_star, y);
      const auto beyond = at > yield_overlap(R_star);
      if (any(beyond)) {
        const T b = backbone_overlap(R_star, select(beyond, at, T{} + fabs(yield_overlap(R_star))));
        const Point<T> peak = body.load(R_star, b);
        W = select(beyond, lost(R_star, b, peak) + energy_at_peak(peak), W);
      }
      return W;
    };
    return potential(delta) - potential(T{});
  }
};

template <class T>
inline constexpr bool adheres<CavityAdhesive<T>> = true;

namespace detail {

/// The opening curve of the contacts that have a dent; of others one without meaning.
template <class T, class M>
inline FlattenedOpening<T> opening_curve(const CavityAdhesive<T>& law, const Point<T>& point, M dented) noexcept {
  const T one = T{} + 1.0;
  return {law.E_star, law.c, select(dented, point, Point<T>{one, one, T{}})};
}

/// Whether a memory holds a dent: else it is another law's, whose numbers do not fit together.
template <class T>
inline auto has_dent(const CavityAdhesive<T>& law, const typename CavityAdhesive<T>::State& s) noexcept {
  const auto there = (s.dent > 0.0) & (s.delta_max < no_overlap) & (s.delta_max > -no_overlap) & plausible(s.point);
  if (!any(there)) return there;
  const Point<T> peak = opening_curve(law, s.point, there).peak;
  const T top = s.delta_max + law.opening(peak.radius), back = recovered_overlap(law.E_star, peak);
  return there & (back > 1e-10 * top) & (fabs(top - back - s.dent) <= 1e-9 * top);
}

}  // namespace detail

namespace detail {

/// What a contact keeps of its opening curve.
template <class T>
struct Opened {
  T dent, root, R_open;
};

/// at: overlap of the backbone at this peak.
template <class T>
inline Opened<T> opened_from(const CavityAdhesive<T>& law, T at, const Point<T>& peak) noexcept {
  const FlattenedOpening<T> curve(law.E_star, law.c, peak);
  const T least = T{} + adhesive::no_root, dent = max(at - curve.way * (curve.A + curve.B), least);
  T R_open{};
  if (any(law.pull > 0.0)) R_open = -curve.force(curve.extreme(3.0)) / (1.5 * law.pull);
  return {dent, curve.extreme(1.0) * curve.y0 / adhesive::fold_share, R_open};
}

}  // namespace detail

/// As the step of `Jkr`; load: the backbone beyond yield. Growth moves the opening curve; at its peak the force is the
/// force of growth, so that the same step taken again gives the same bits. A contact that broke inside its dent forms
/// again where the curve begins; the history is cleared when separated and delta <= 0.
template <class T, class Load>
inline Step<CavityAdhesive<T>> step(const CavityAdhesive<T>& law, T R_star,
                                    const typename CavityAdhesive<T>::State& before, T delta, T closing,
                                    Load load) noexcept {
  using namespace adhesive;
  const T zero{};
  const auto stood = before.root > 0.0;
  const auto dented = detail::has_dent(law, before);
  const T dent = select(dented, before.dent, zero), own = delta - dent;
  const auto forms = (before.root <= 0.0) & (delta > 0.0) & (own > 0.0);
  const auto opening = detail::opening_curve(law, before.point, dented);

  T root = before.root;
  if (any((stood | forms) & !dented)) root = select(dented, root, refreshed(before.root, law.c * R_star));
  if (any(forms & dented)) root = select(forms & dented, opening.extreme(1.0) * opening.y0 / fold_share, root);
  const T y_f = fold_share * root, z_f = min(y_f / opening.y0, zero + 1.0);
  T fold = -3.0 * y_f * y_f * y_f * y_f / R_star;
  if (any(dented)) fold = select(dented, opening.overlap(z_f), fold);
  const auto ends = stood & (own < fold), stands = (stood & (own >= fold)) | forms;
  const auto grows = stands & (delta > before.delta_max);
  const T yield = law.yield_overlap(R_star);
  const auto flows = grows & (dented | (delta > yield)), opens = stands & dented & !flows, elastic = stands & !dented;

  T a{}, F{}, R_open = select(dented, before.R_open, zero), now_dent = dent, at_touch = -4.0 / 3.0 * law.pull * R_star;
  Point<T> point = select(dented, before.point, Point<T>{});
  if (any(elastic)) {
    const T y = curve(y_f, R_star * delta);
    a = select(elastic, y * y, a);
    F = select(elastic, force(law.E_star, law.c, delta, y), F);
  }
  if (any(opens)) {
    const auto below = delta < before.delta_max;
    const T z = opening.at(own, z_f), y = opening.y0 * z;
    a = select(opens, select(below, y * y, point.radius), a);
    F = select(opens, select(below, opening.force(z), point.force - law.punch(point.radius)), F);
  }
  if (any(forms & dented)) {
    const T z = opening.at(zero, z_f);
    at_touch = select(dented, opening.force(z), at_touch);
  }
  if (any(flows)) {
    const auto at_once = forms & flows & !dented & (yield <= 0.0);
    if (any(at_once)) {
      const Point<T> first = law.body.load(R_star, law.backbone_overlap(R_star, zero));
      at_touch = select(at_once, first.force - law.punch(first.radius), at_touch);
    }
    const T at = law.backbone_overlap(R_star, select(flows, delta, R_star));
    const Point<T> peak = load(at);
    const auto opened = detail::opened_from(law, at, peak);
    point = select(flows, peak, point);
    a = select(flows, peak.radius, a);
    F = select(flows, peak.force - law.punch(peak.radius), F);
    now_dent = select(flows, opened.dent, now_dent);
    root = select(flows, opened.root, root);
    R_open = select(flows, opened.R_open, R_open);
  }
  T jump{};
  if (any(forms)) jump = select(forms, on_touch(at_touch, own, closing), zero);
  if (any(ends)) {
    T F_f = -5.0 / 6.0 * law.pull * R_star, bend = bend_at_fold(law.E_star, y_f), scale = R_star;
    if (any(ends & dented)) {
      F_f = select(dented, opening.force(z_f), F_f);
      bend = select(dented, opening.bend(z_f), bend);
      scale = select(dented, zero + 1.0, scale);
    }
    jump = select(ends & (law.pull > 0.0), on_parting(F_f, bend, scale, fold - own, closing), jump);
  }
  const auto keeps = stands | (delta > 0.0);
  return {select(stands, F, zero) + jump,
          select(stands, a, zero),
          {select(keeps, select(grows, delta, before.delta_max), zero), select(stands, max(root, zero + no_root), zero),
           select(keeps, now_dent, zero), select(keeps, R_open, zero), jump, select(keeps, point, Point<T>{})}};
}

template <class T>
inline Step<CavityAdhesive<T>> step(const CavityAdhesive<T>& law, T R_star,
                                    const typename CavityAdhesive<T>::State& before, T delta, T closing) noexcept {
  return step(law, R_star, before, delta, closing, [&](T b) { return law.body.load(R_star, b); });
}

/// Work lost by yield [J] of a contact with this memory; what touch took of a contact that yields at once is
/// adhesion's.
template <class T>
inline T plastic_work(const CavityAdhesive<T>& law, T R_star, const typename CavityAdhesive<T>::State& now) noexcept {
  const auto dented = detail::has_dent(law, now);
  if (!any(dented)) return T{};
  const Point<T> peak = select(dented, now.point, law.body.load(R_star, R_star));
  const T b = select(dented, now.delta_max + law.opening(peak.radius), R_star);
  T lost = law.lost(R_star, b, peak);
  const auto at_once = law.yield_overlap(R_star) <= 0.0;
  if (any(at_once)) {
    const T touch = law.backbone_overlap(R_star, T{});
    lost = select(at_once, lost - law.lost(R_star, touch, law.body.load(R_star, touch)), lost);
  }
  return select(dented, max(lost, T{}), T{});
}

/// Work lost by yield in a step that grows [J].
template <class T>
inline T plastic_work_of_step(const CavityAdhesive<T>& law, T R_star, const typename CavityAdhesive<T>::State& before,
                              const typename CavityAdhesive<T>::State& after) noexcept {
  const auto grows = after.delta_max > before.delta_max;
  if (!any(law.softens()) || !any(grows)) return adhesive::plastic_work_of_step(law, R_star, before, after);
  const auto dented = grows & detail::has_dent(law, before);
  const Point<T> safe = law.body.load(R_star, R_star), first = select(dented, before.point, safe);
  const Point<T> last = select(dented, after.point, safe);
  const T from = select(dented, before.delta_max + law.opening(first.radius), R_star);
  const T to = select(dented, after.delta_max + law.opening(last.radius), R_star);
  const T P = law.body.plastic_ratio * R_star, L = law.body.least_overlap(R_star);
  const auto near = dented & (to < 1.02 * from) & ((from >= P) | (to <= P)) & ((from >= L) | (to <= L));
  T lost{};
  if (any(near)) lost = select(near, law.lost_between(R_star, from, to, first, last), lost);
  if (any(grows & !near)) lost = select(near, lost, adhesive::plastic_work_of_step(law, R_star, before, after));
  return lost;
}

/// What adhesion lost in the jumps of a step [J].
template <class T>
inline T jump_loss(const CavityAdhesive<T>& law, T R_star, const typename CavityAdhesive<T>::State& before,
                   const typename CavityAdhesive<T>::State& after) noexcept {
  using namespace adhesive;
  const auto stood = before.root > 0.0, stands = after.root > 0.0;
  const auto dented = detail::has_dent(law, before);
  T adhesive{};
  const auto forms = stands & (before.root <= 0.0), ends = stood & (after.root <= 0.0);
  if (any(forms)) {
    T E = energy_at_touch(law.E_star, law.c, R_star);
    const auto at_once = (after.dent > 0.0) & (law.yield_overlap(R_star) <= 0.0) & !dented;
    if (any(at_once))
      E = select(at_once, law.energy_at_peak(law.body.load(R_star, law.backbone_overlap(R_star, T{}))), E);
    if (any(forms & dented)) {
      const auto opening = detail::opening_curve(law, before.point, dented);
      E = select(dented, opening.energy(opening.at(T{}, opening.extreme(1.0))), E);
    }
    adhesive = select(forms, -E, adhesive);
  }
  if (any(ends)) {
    T E = energy_at_fold(law.E_star, law.c, R_star);
    if (any(ends & dented)) {
      const auto opening = detail::opening_curve(law, before.point, dented);
      E = select(dented, opening.energy(min(fold_share * before.root / opening.y0, T{} + 1.0)), E);
    }
    adhesive = select(ends, E, adhesive);
  }
  return adhesive;
}

/// Energies that a step took for good.
template <class T>
inline adhesive::Losses<T> losses(const CavityAdhesive<T>& law, T R_star,
                                  const typename CavityAdhesive<T>::State& before,
                                  const typename CavityAdhesive<T>::State& after) noexcept {
  return {epdem::plastic_work_of_step(law, R_star, before, after), jump_loss(law, R_star, before, after)};
}

/// Elastic and surface energy [J] of a contact at overlap `delta` <= delta_max, 0 for bodies apart.
template <class T>
inline T stored_energy(const CavityAdhesive<T>& law, T R_star, const typename CavityAdhesive<T>::State& now,
                       T delta) noexcept {
  using namespace adhesive;
  const auto dented = detail::has_dent(law, now);
  const T own = delta - select(dented, now.dent, T{}), y_f = fold_share * now.root;
  T E = energy(law.E_star, law.c, R_star, curve(y_f, R_star * own));
  if (any(dented)) {
    const auto opening = detail::opening_curve(law, now.point, dented);
    const T z_f = min(select(now.root > 0.0, y_f / opening.y0, opening.extreme(1.0)), T{} + 1.0);
    E = select(dented, opening.energy(select(delta < now.delta_max, opening.at(own, z_f), T{} + 1.0)), E);
  }
  return select((now.root > 0.0) | (own > 0.0), E, T{});
}

/// Of `cavity_adhesive`: d (2 E* a - dF_b/d alpha_b) must not exceed d(W_b - U)/d alpha_b at any overlap beyond yield.
/// Found in each phase apart, finer and finer around the least value, with central differences. Finite strain is that
/// of a sphere on a rigid plane, the largest one, up to its least area.
inline double largest_adhesion(const CavityAdhesive<double>& law, double R_star) noexcept {
  constexpr int parts = 16, rounds = 8;
  constexpr double h = 1e-5;  // of ln alpha_b
  Cavity<double> body = law.body;
  if (body.softens()) body.confine(0.5 * sqrt(0.5 / body.cut));
  const double delta_Y = body.elastic_overlap(R_star), infinite = std::numeric_limits<double>::infinity();
  const double end = std::fmin(body.log_s_P + 10.0, std::log(body.least_overlap(R_star) / delta_Y));
  const auto at = [&](double log_s) {
    const double b = delta_Y * exp(log_s), left = b * exp(-h), right = b * exp(h);
    const Point<double> now = body.load(R_star, b), low = body.load(R_star, left), high = body.load(R_star, right);
    const double dF = (high.force - low.force) / (right - left);
    const double dU = (recovered_work(law.E_star, high) - recovered_work(law.E_star, low)) / (right - left);
    const double stiff = 2.0 * law.E_star * now.radius - dF, spare = max(0.0, now.force - dU);
    return stiff > 0.0 ? spare * spare / (stiff * stiff) * law.E_star / (2.0 * pi * now.radius) : infinite;
  };
  double least = infinite;
  for (int phase = 0; phase < 2; ++phase) {
    const double first = h + (phase ? body.log_s_P : 0.0), last = phase ? end : std::fmin(body.log_s_P, end) - h;
    if (last < first) continue;
    double low = first, high = last;
    for (int round = 0; round < rounds; ++round) {
      const double width = (high - low) / parts;
      double found = infinite, best = low;
      for (int k = 0; k <= parts; ++k) {
        const double log_s = low + width * k, value = at(log_s);
        if (value < found) best = log_s;
        found = min(found, value);
      }
      least = min(least, found);
      low = max(first, best - 2.0 * width);
      high = min(last, best + 2.0 * width);
    }
  }
  return least;
}

}  // namespace epdem
