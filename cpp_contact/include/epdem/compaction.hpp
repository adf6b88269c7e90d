// SPDX-License-Identifier: GPL-2.0-or-later
// Compaction: contacts of one body that feel each other. No number is fitted, and a lone contact keeps its law bit by
// bit.
// 1. Growth. A sphere that other contacts dent is thicker at this one, because the displaced volume moves to the free
//    surface. A dent of depth d in a sphere of radius R covers d/R, S1 = sum d/R, and displaces S2 = sum d^2/R^2; to
//    lowest order the sphere grows by g R, g = S2/(4 - 2 S1). A contact sees u, the growth by the dents of the others.
//    Dents are residual: what stays of the largest overlap, without growth, after full unloading. Between bodies of
//    unlike strength the weaker body has the volume.
// 2. Screening. The other contacts of a body, over whose circles A = sum a^2, shorten its elastic recovery by gamma:
//      gamma = (1-eps)^1.5 + A/(a R) (1-2nu)/(2 pi (1-nu^2)), eps = sqrt(A)/(2 R)
//    (constriction of a flux tube, Cooper, Mikic and Yovanovich 1969; compression of the body by the mean pressure).
//    A contact unloads with E*/G, G = 1 - (1-gamma) m; m = 1 - alpha_Y/b weighs contacts by yield, b: peak overlap.
// 3. Energy. What a screened contact does not store is not taken from the walls: its overlap also grows by q,
//    F dq = d[(1-G) U], U: recoverable work of the law at the peak.
// The law is that of the overlap alpha + v, v = u + q.
#pragma once

#include "law.hpp"

namespace epdem {

template <class T>
struct Cavity;

/// Whether hosts offer compaction with a law.
template <class Law>
inline constexpr bool compacts = false;
template <class T>
inline constexpr bool compacts<Cavity<T>> = true;

/// Growth closes gaps of two spheres up to this share of the sum of their radii.
inline constexpr double growth_reach = 0.25;
/// Smallest gamma.
inline constexpr double least_screening = 0.05;

/// Growth of a sphere over its radius from the sums of its dents; finite for any sums.
template <class T>
EPDEM_INLINE T growth(T cover, T volume) noexcept {
  return volume / (4.0 - 2.0 * min(cover, constant<T>(1.6)));
}

/// What the contacts of a body did to it in the step before.
template <class T>
struct BodySums {
  T growth;  // g [-]
  T area;    // A [m^2]
};

/// What a contact adds to the sums of its bodies.
template <class T>
struct Dents {
  T cover_i, cover_j;    // depth over radius
  T volume_i, volume_j;  // to S2
  T area;                // m a^2 [m^2], to A of both
};

/// Values of a contact beside the history of its law, whose largest overlap is that without growth. Zeros: a new
/// contact.
template <class T>
struct GrowthState {
  static constexpr const char* slots[] = {"step_overlap", "added_overlap", "screened_overlap", "raw_screening",
                                          "screening"};
  T last;   // u + q of the sums of the step before [m]
  T added;  // v [m]: u + q extrapolated to the step
  T shift;  // q [m]
  T raw;    // least gamma of the sums so far
  T gamma;  // the same extrapolated to the step, which the force uses
};

inline constexpr int growth_values = sizeof(GrowthState<double>) / sizeof(double);

/// v [m] of the values of a GrowthState.
inline double added_overlap_of(const double* state) noexcept { return state[1]; }
/// gamma of the same; 0: a new contact.
inline double screening_of(const double* state) noexcept { return state[4]; }

/// A contact that grows, in one step.
template <bool wall, class T>
struct Growing {
  static constexpr bool at_wall = wall;
  T radius_i, radius_j;  // [m]; radius_j of two spheres only
  BodySums<T> i, j;
  GrowthState<T> state;  // before the step, then after it
  Dents<T> dents;        // after the step
};

namespace detail {

/// A contact at its peak.
template <class T>
struct Indent {
  T yielded;   // m
  T softness;  // G
  T residual;  // overlap, without growth, at which the force returns to 0 [m]
  T area;      // m a^2 [m^2]
  T unstored;  // (1-G) U [J]
};

template <class Law, class T = Number<Law>>
EPDEM_INLINE Indent<T> indent_of(const Law& law, T R_star, T delta_max, const Point<T>& peak, T added,
                                 T gamma) noexcept {
  const T b = delta_max + added, delta_Y = law.elastic_overlap(R_star);
  const auto dented = (b > delta_Y) & (peak.force > 0.0);
  const T m = select(dented, 1.0 - delta_Y / b, T{}), soft = (1.0 - gamma) * m, G = 1.0 - soft;
  const T one = constant<T>(1.0);
  const Point<T> p = select(dented, peak, Point<T>{one, one, T{}});
  const T residual = max(T{}, max(T{}, delta_max) - G * recovered_overlap(law.E_star, p));
  return {m, G, select(dented, residual, T{}), m * (p.radius * p.radius), soft * recovered_work(law.E_star, p)};
}

/// Depths of a residual overlap in both bodies, to the plane where the spheres intersect, as parts of their sums.
template <bool wall, class T>
EPDEM_INLINE Dents<T> dents_of(T radius_i, T radius_j, T strain_i, T residual, T area) noexcept {
  const auto twice = min(constant<T>(1.0), 2.0 * strain_i);
  if constexpr (wall) {
    (void)radius_j;
    const T depth = residual / radius_i;
    return {depth, T{}, twice * (depth * depth), T{}, area};
  } else {
    // volume R d^2 of each dent; the weaker body takes of the other's what this body's share is short of 1/2
    const T half = 0.5 * residual / (radius_i + radius_j - residual);
    const T d_i = half * (2.0 * radius_j - residual), d_j = half * (2.0 * radius_i - residual);
    const T x_i = d_i / radius_i, x_j = d_j / radius_j, V_i = radius_i * d_i * d_i, V_j = radius_j * d_j * d_j;
    const T more = 2.0 * strain_i - 1.0, to_i = max(T{}, more) * V_j, to_j = max(T{}, -more) * V_i;
    return {x_i, x_j, twice * (x_i * x_i) + to_i / (radius_i * radius_i * radius_i),
            min(constant<T>(1.0), 1.0 - more) * (x_j * x_j) + to_j / (radius_j * radius_j * radius_j), area};
  }
}

/// u [m] that the sums of the bodies add to a contact with these dents.
template <bool wall, class T>
EPDEM_INLINE T grown_by_others(const Growing<wall, T>& c, const Dents<T>& own) noexcept {
  const T u_i = c.radius_i * max(T{}, c.i.growth - growth(own.cover_i, own.volume_i));
  if constexpr (wall) return u_i;
  return u_i + c.radius_j * max(T{}, c.j.growth - growth(own.cover_j, own.volume_j));
}

/// gamma of a contact of this own area > 0 [m^2] in the sums.
template <bool wall, class T>
EPDEM_INLINE T screening(const Growing<wall, T>& c, const BodyShares<T>& bodies, T own) noexcept {
  const T root_own = sqrt(own);
  const auto lost = [](T others, T radius) {  // of 1 by the constriction
    const T free = max(T{}, 1.0 - sqrt(others) / (2.0 * radius));
    return 1.0 - free * sqrt(free);
  };
  const T others_i = max(T{}, c.i.area - own);
  T gamma = 1.0 - bodies.compliance_i * lost(others_i, c.radius_i);
  T bulk = bodies.bulk_i * others_i / c.radius_i;
  if constexpr (!wall) {
    const T others_j = max(T{}, c.j.area - own);
    gamma = gamma - (1.0 - bodies.compliance_i) * lost(others_j, c.radius_j);
    bulk = bulk + bodies.bulk_j * others_j / c.radius_j;
  }
  return max(constant<T>(least_screening), min(constant<T>(1.0), gamma + bulk / root_own));
}

}  // namespace detail

/// The overlap v [m] of a step, and u + q that it follows from; the extrapolation makes the error one of second order
/// in the time step. A step that is repeated keeps v.
template <class T>
struct Added {
  T now, extrapolated;
};

template <bool wall, class T>
EPDEM_INLINE Added<T> added_overlap(const Growing<wall, T>& c, const BodyShares<T>& bodies,
                                    const detail::Indent<T>& old, bool repeats) noexcept {
  if (repeats) return {c.state.last, c.state.added};
  const auto own = detail::dents_of<wall>(c.radius_i, c.radius_j, bodies.strain_i, old.residual, old.area);
  const T now = detail::grown_by_others(c, own) + c.state.shift;
  return {now, select(c.state.raw > 0.0, max(now, 2.0 * now - c.state.last), now)};
}

/// Whether growth closes the gap of a contact of overlap < 0.
template <bool wall, class Law>
inline bool closes_gap(const Law& law, const BodyShares<double>& bodies, double R_star, const State<Law>& before,
                       const Growing<wall, double>& c, double overlap, bool repeats) noexcept {
  const double gamma = c.state.raw > 0.0 ? c.state.gamma : 1.0;
  const auto old = detail::indent_of(law, R_star, before.delta_max, before.point, c.state.added, gamma);
  return overlap + added_overlap(c, bodies, old, repeats).extrapolated > 0.0;
}

/// Grown spheres whose growth over the radius is at most `largest` touch below this factor of the squared sum of their
/// radii; half as much more is for q and for the extrapolation.
inline double touch_factor(double largest) noexcept {
  const double reach = 1.0 + std::fmin(1.5 * largest, growth_reach);
  return reach * reach;
}

/// A step of a contact that grows.
template <class Law>
struct GrownStep {
  Law law;                // with E*/G
  State<Law> before;      // of the overlap with growth
  Step<Law> step;         // the same
  Number<Law> overlap;    // with growth [m]
  Number<Law> reached;    // largest overlap without growth before the step [m]
  Number<Law> delta_max;  // the same after the step
  Point<Number<Law>> peak_before;
  detail::Indent<Number<Law>> old, now;
  GrowthState<Number<Law>> last;  // before the step
  Number<Law> added;              // v of the step
};

/// As `step`, for a contact whose law's history is `before`, with the largest overlap without growth. Writes the state
/// after the step and the dents to `c`.
template <bool wall, class Law, class T = Number<Law>>
EPDEM_INLINE GrownStep<Law> grown_step(const Law& law, const BodyShares<T>& bodies, T R_star, const State<Law>& before,
                                       T overlap, Growing<wall, T>& c, bool repeats) noexcept {
  const T zero{}, one = constant<T>(1.0), least = constant<T>(least_screening);
  GrownStep<Law> s;
  s.last = c.state;
  s.peak_before = before.point;
  const auto known = c.state.raw > 0.0;
  const T raw_before = select(known, c.state.raw, one), gamma_before = select(known, c.state.gamma, one);
  s.reached = select(known, before.delta_max, min(overlap, zero));
  s.old = detail::indent_of(law, R_star, s.reached, before.point, c.state.added, gamma_before);
  const Added<T> v = added_overlap(c, bodies, s.old, repeats);
  s.added = v.extrapolated;
  s.overlap = overlap + s.added;
  s.delta_max = select((overlap < s.reached) & (s.reached < no_overlap), s.reached, overlap);
  const T b = s.delta_max + s.added, delta_Y = law.elastic_overlap(R_star);
  const auto beyond = b > delta_Y;

  T raw = raw_before, gamma = gamma_before;
  if (!repeats) {
    const auto screened = beyond & (s.old.area > 0.0);
    if (any(screened))
      raw = select(screened, min(raw, detail::screening(c, bodies, select(screened, s.old.area, one))), raw);
    gamma = min(gamma, max(least, min(raw, 2.0 * raw - raw_before)));
  }
  s.law = law;
  s.law.E_star = law.E_star / (1.0 - (1.0 - gamma) * select(beyond, 1.0 - delta_Y / b, zero));

  // a stored peak of another overlap is not plausible, and the step computes a new one
  s.before = before;
  s.before.delta_max = s.reached + s.added;
  s.before.point.force = select(known & (s.added == c.state.added), before.point.force, zero);
  s.step = step(s.law, R_star, s.before, s.overlap);

  const auto stands = s.overlap > 0.0;
  const Point<T>& peak = s.step.after.point;
  s.now = detail::indent_of(law, R_star, s.delta_max, peak, s.added, gamma);
  c.dents = detail::dents_of<wall>(c.radius_i, c.radius_j, bodies.strain_i, select(stands, s.now.residual, zero),
                                   select(stands, s.now.area, zero));
  s.delta_max = select(stands, s.delta_max, zero);
  if (repeats) return s;
  const T before_force = select(known, before.point.force, zero);
  const T mean = select(before_force > 0.0, 0.5 * (peak.force + before_force), peak.force);
  const T shift = c.state.shift + select(s.now.yielded > 0.0, (s.now.unstored - s.old.unstored) / mean, zero);
  c.state = {select(stands, v.now, zero), select(stands, s.added, zero), select(stands, shift, zero),
             select(stands, raw, zero), select(stands, gamma, zero)};
  return s;
}

/// Energies of a step that grows, of second order in the time step; closing: closing speed at the half step times the
/// time step [m]. The plastic work of one contact may be negative: what grows a contact is paid by the dents of others.
template <class Law, class T = Number<Law>>
[[gnu::noinline]] NormalEnergies<T> grown_energies(const Law& law, T R_star, const GrownStep<Law>& s, T overlap,
                                                   T closing) noexcept {
  const T delta_Y = law.elastic_overlap(R_star);
  const auto known = s.last.raw > 0.0;
  const T v0 = select(known, s.last.added, s.added), b0 = max(T{}, select(known, s.reached + v0, T{}));
  const T b = s.delta_max + s.added;
  const Point<T>& peak = s.step.after.point;
  const auto was_dented = s.old.yielded > 0.0, dented = s.now.yielded > 0.0;
  const auto stored = [&](auto yielded, const Point<T>& p, T softness, T delta_max, T delta) {
    const T at = max(T{}, delta), one = constant<T>(1.0);
    const Point<T> safe = select(yielded, p, Point<T>{one, one, T{}});
    return select(yielded, stored_work(law.E_star / softness, safe, delta_max, at), hertz_work(law.E_star, R_star, at));
  };
  // below the peak the overlap moves on a branch, which the sums change: the change at the middle of the step
  const T middle = min(overlap - 0.5 * closing, select(was_dented, s.reached, overlap));
  T lost = stored(was_dented, s.peak_before, s.old.softness, s.reached + v0, middle + v0) -
           stored(dented, peak, s.now.softness, b, middle + s.added);
  const auto yields = dented & (overlap >= s.reached);
  if (any(yields)) {
    const T from = select(yields, b0, delta_Y), to = select(yields, b, delta_Y);
    T F0 = hertz_point(law.E_star, R_star, from).force, U0 = hertz_work(law.E_star, R_star, from);
    if (any(was_dented)) {
      const Point<T> safe = select(was_dented, s.peak_before, peak);
      F0 = select(was_dented, safe.force, F0);
      U0 = select(was_dented, recovered_work(law.E_star, safe), U0);
    }
    const T U = stored_work(law.E_star, select(yields, peak, s.peak_before), to, to);
    const T work = law.work(R_star, from, to) + U0 - U;
    const T paid = 0.5 * (F0 + peak.force) * (s.added - v0);
    lost = select(yields, work - paid + (s.now.unstored - s.old.unstored), lost);
  }
  return {lost, stored(dented, peak, s.now.softness, b, s.overlap), T{}};
}

}  // namespace epdem
