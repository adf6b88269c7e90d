// SPDX-License-Identifier: BSD-3-Clause
// Compaction: contacts of one body that feel each other. No number is fitted, and a lone contact keeps its law bit by
// bit.
// 1. Growth. A sphere that other contacts dent is thicker at this one, because the displaced volume moves to the free
//    surface. A dent of depth d in a sphere of radius R covers d/R, S1 = sum d/R, and displaces S2 = sum d^2/R^2; to
//    lowest order the sphere grows by g R, g = S2/(4 - 2 S1), at most 0.2. A contact sees u, the growth by the dents
//    of the others.
//    Dents are residual: what stays of the largest overlap, without growth, after full unloading. Between bodies of
//    unlike strength the weaker body has the volume.
// 2. Screening. The other contacts of a body, over whose circles A = sum a^2, shorten its elastic recovery by gamma:
//      gamma = (1-eps)^1.5 + A/(a R) (1-2nu)/(2 pi (1-nu^2)), eps = sqrt(A)/(2 R)
//    (constriction of a flux tube, Cooper, Mikic and Yovanovich 1969; compression of the body by the mean pressure).
//    of the side of each body, R - d in place of R for the compression, d: depth of the contact. Contacts are weighed
//    by yield, m = 1 - alpha_Y/b, b: peak overlap. Dents see the recovery G d_e, G = 1 - sum c, c = s (1-gamma) m of a
//    body with the part s of the compliance.
// 3. Energy. What a screened contact does not store is not taken from the walls: its overlap also grows by q,
//    F dq = d[(1-G) U], U: recoverable work of the law at the peak.
// 5. Retreat. Surfaces that other contacts have pressed up follow these when they part: the overlap falls by
//    e = sum c d_e (1-Q), with N Q^(4/3) = sum of c d_e F over the contacts of the body, N: largest sum of c d_e F_max.
//    Of all released alike, each contact recovers G d_e; of one released alone, the others lose force. The energies
//    stored at b and at overlaps below, less 3/7 N Q^(7/3) of each body, are a potential of all forces.
// 4. Pressure. What growth adds is not indented by its counterpart: it is the flowing body laid against it, and carries
//    2/3 Y + P, P: mean pressure of the body, sum F (R - d)/(3 V), the largest so far. Of the force of the law, what
//    growth adds to it by the hardness gives way to the area that growth adds times 2/3 Y + P, in the share m.
// 5. Bond, where a pair has a strength. Two spheres that have yielded hold together by the circle of radius a_m of
//    their largest overlap: below the overlap alpha_p at which the law has no force they pull as a punch of this
//    circle, 2 (E*/G) a_m (alpha_p - alpha). The bond breaks at strength times pi a_m^2, for as long as the contact
//    lasts, or ends with the contact.
// The law is that of the overlap alpha + v, v = u + q.
// With adhesion alpha + v - e = alpha_b - d: the backbone at alpha_b is that of growth, the punch opens the rim by d. F
// of 5 and P is the whole force, which makes the energies of all contacts a potential again; dents, 2 and 3 are those
// of the backbone.
#pragma once

#include "cavity_adhesive.hpp"

namespace epdem {

/// Whether hosts offer compaction with a law.
template <class Law>
inline constexpr bool compacts = false;
template <class T>
inline constexpr bool compacts<Cavity<T>> = true;
template <class T>
inline constexpr bool compacts<CavityAdhesive<T>> = true;

/// Growth closes gaps of two spheres up to this share of the sum of their radii.
inline constexpr double growth_reach = 0.25;
/// Smallest gamma.
inline constexpr double least_screening = 0.05;

/// Smallest loss that is above round-off; the smallest area of other contacts loses 2e-5.
inline constexpr double least_loss = 1e-12;

/// Other contacts screen a contact from this share of its own area on.
inline constexpr double least_others = 1e-9;

/// Sums that would move the overlap of a contact by less than this share of R*, and the pressure by less than this
/// share of Y, leave its peak as it is, which needs no backbone then; the force has errors of 1e-8.
inline constexpr double at_rest = 1e-10;

/// Largest growth of a sphere over its radius; lattices have 0.06 at a relative density of 0.95. A sphere that grows
/// more, a soft one among hard ones, would touch spheres that no host has listed.
inline constexpr double most_growth = 0.2;

/// Growth of a sphere over its radius from the sums of its dents.
template <class T>
EPDEM_INLINE T growth(T cover, T volume) noexcept {
  return min(constant<T>(most_growth), volume / (4.0 - 2.0 * min(cover, constant<T>(1.6))));
}

/// What the contacts of a body did to it in the step before.
template <class T>
struct BodySums {
  T growth;    // g [-]
  T area;      // A [m^2]
  T pressure;  // P [Pa]
  T parted;    // 1 - Q, extrapolated to the step
};

inline constexpr int body_values = sizeof(BodySums<double>) / sizeof(double);

/// What a body keeps beside BodySums. Zeros: a new body.
template <class T>
struct BodyMemory {
  T pressure;           // largest P so far [Pa]
  T full;               // N [J]
  T parted, last, old;  // 1 - Q of the sums of the last three steps
};

inline constexpr int memory_values = sizeof(BodyMemory<double>) / sizeof(double);

/// What a contact adds to the sums of a body.
template <class T>
struct Dent {
  T cover;     // depth over radius
  T volume;    // to S2
  T area;      // m a^2 [m^2]
  T pressure;  // F (R - d)/(3 V) [Pa]
  T full;      // c d_e F_max [J]
  T held;      // c d_e F [J]
};

inline constexpr int dent_sums = sizeof(Dent<double>) / sizeof(double);

/// What a contact adds to the sums of its bodies.
template <class T>
struct Dents {
  Dent<T> i, j;
};

/// Adds to the sums of a body, which a host stores as numbers.
inline void add_dent(double* sums, const Dent<double>& dent) noexcept {
  for (int k = 0; k < dent_sums; ++k) sums[k] += number_at<double>(dent, k);
}

/// Values of a contact beside the history of its law, whose largest overlap is that without growth. Zeros: a new
/// contact.
template <class T>
struct GrowthState {
  static constexpr const char* slots[] = {
      "step_overlap", "added_overlap",  "screened_overlap", "raw_loss",      "raw_lean",
      "screening",    "lean",           "own_growth",       "dented_area",   "unstored_work",
      "step_growth",  "grown_overlap",  "step_pressure",    "body_pressure", "retreat",
      "recovered",    "last_recovered", "normal_force",     "broken"};
  /// Whether a value changes its sign where the bodies change places.
  static constexpr bool turns(int slot) noexcept { return slot == 4 || slot == 6; }

  T last;            // u + q of the sums of the step before [m]
  T added;           // v [m]: u + q extrapolated to the step
  T shift;           // q [m]
  T raw, raw_lean;   // largest s (1 - gamma) of the sums so far: of both bodies, of i less that of j
  T screening;       // gamma extrapolated to the step, which the force uses: 1 less that of both, above 0
  T lean;            // of i less that of j, extrapolated as well
  T own;             // growth of both bodies by the dents of this contact alone [m]
  T area;            // m a^2 [m^2]
  T unstored;        // (1-G) U [J]
  T last_grown;      // u of the sums of the step before [m]
  T grown;           // u extrapolated to the step [m], in `added`
  T last_pressure;   // P of the sums of the step before [Pa]
  T pressure;        // the same extrapolated to the step, which the force uses
  T retreat;         // e [m]
  T recovered;       // m d_e of the peak [m]
  T last_recovered;  // the same in the step before
  T force;           // F of the step [N]
  T broken;          // 1: the bond of this contact has broken
};

inline constexpr int growth_values = sizeof(GrowthState<double>) / sizeof(double);

/// v [m] of the values of a GrowthState.
inline double added_overlap_of(const double* state) noexcept { return state[1]; }
/// gamma of the same; 0: a new contact.
inline double screening_of(const double* state) noexcept { return state[5]; }
/// u [m], in v, of the same.
inline double grown_overlap_of(const double* state) noexcept { return state[11]; }
/// P [Pa] of the same.
inline double body_pressure_of(const double* state) noexcept { return state[13]; }
/// e [m] of the same.
inline double retreat_of(const double* state) noexcept { return state[14]; }
/// Whether the bond of the same has broken.
inline bool broken_of(const double* state) noexcept { return state[18] > 0.0; }

/// A contact that grows, in one step.
template <bool wall, class T>
struct Growing {
  T radius_i, radius_j;        // [m]; of j between two spheres only
  T curvature_i, curvature_j;  // 1/radius
  BodySums<T> i, j;
  GrowthState<T> state;  // before the step, then after it
  Dents<T> dents;        // after the step
  T bond{};              // strength of the bond of two spheres [Pa], 0: none

  /// A host may write state and dents here, as soon as they are known.
  void keep() const noexcept {}
};

/// What follows from the sums of a body in a step. A body without contacts forgets its memory.
template <class T>
EPDEM_INLINE BodySums<T> sums_of_step(const Dent<T>& sums, BodyMemory<T>& memory) noexcept {
  const T zero{}, one = constant<T>(1.0), full = max(memory.full, sums.full);
  const auto falls = full > max(zero, sums.held);  // pulls alone have no Q
  const T root = sqrt(max(zero, select(falls, sums.held, one) / select(falls, full, one)));
  memory = {max(memory.pressure, sums.pressure), full, 1.0 - root * sqrt(root), memory.parted, memory.last};
  const T parted = 2.5 * memory.parted - 2.0 * memory.last + 0.5 * memory.old;
  BodySums<T> now{growth(sums.cover, sums.volume), sums.area, memory.pressure, min(one, max(zero, parted))};
  const auto touches = (sums.cover > 0.0) | (sums.area > 0.0) | (sums.pressure > 0.0);
  keep_where<T>(touches, memory);
  keep_where<T>(touches, now);
  return now;
}

/// The sums of one body, from the array in which a host stores the sums of all bodies; null: without compaction.
inline BodySums<double> sums_of(const double* all, long body) noexcept {
  if (!all) return {};
  const double* const of_body = all + body_values * body;
  return {of_body[0], of_body[1], of_body[2], of_body[3]};
}

/// A contact as a host stores it: radii [m], sums of the bodies, values of its GrowthState; null: a new contact.
inline Growing<false, double> growing_pair(double radius_i, double radius_j, BodySums<double> i, BodySums<double> j,
                                           const double* state) noexcept {
  Growing<false, double> c{radius_i, radius_j, 1.0 / radius_i, 1.0 / radius_j, i, j, {}, {}};
  if (state) ::memcpy(static_cast<void*>(&c.state), state, sizeof c.state);
  return c;
}
inline Growing<true, double> growing_at_wall(double radius, BodySums<double> i, const double* state) noexcept {
  Growing<true, double> c{radius, 0.0, 1.0 / radius, 0.0, i, {}, {}, {}};
  if (state) ::memcpy(static_cast<void*>(&c.state), state, sizeof c.state);
  return c;
}

namespace detail {

/// m of a contact of peak overlap b.
template <class Law, class T = Number<Law>>
EPDEM_INLINE T yielded_share(const Law& law, T R_star, T b) noexcept {
  const T delta_Y = law.elastic_overlap(R_star);
  return select(b > delta_Y, 1.0 - delta_Y / b, T{});
}

/// Growth of both bodies [m] over growth g_i, g_j.
template <bool wall, class T>
EPDEM_INLINE T grown(const Growing<wall, T>& c, T g_i, T g_j) noexcept {
  if constexpr (wall) return c.radius_i * g_i;
  return c.radius_i * g_i + c.radius_j * g_j;
}

/// Depths in both bodies, over their radii, to the plane where the spheres of an overlap intersect.
template <class T>
struct Depths {
  T i, j;
};

template <bool wall, class T>
EPDEM_INLINE Depths<T> depths_of(const Growing<wall, T>& c, T overlap) noexcept {
  if constexpr (wall) return {overlap * c.curvature_i, T{}};
  const T half = 0.5 * overlap / (c.radius_i + c.radius_j - overlap);
  const T d_i = half * (2.0 * c.radius_j - overlap), d_j = half * (2.0 * c.radius_i - overlap);
  return {d_i * c.curvature_i, d_j * c.curvature_j};
}

/// Parts of a contact in the sums of its bodies; overlap: without growth; area: m a^2; way_i, way_j: c d_e; top: F_max.
template <bool wall, class T>
EPDEM_INLINE Dents<T> dents_of(const Growing<wall, T>& c, T strain_i, T residual, T area, T overlap, T force, T way_i,
                               T way_j, T top) noexcept {
  const T more = 2.0 * strain_i - 1.0, one = constant<T>(1.0);
  const Depths<T> x = depths_of(c, residual), now = depths_of(c, overlap);
  T S_i = x.i * x.i, S_j = x.j * x.j;  // volume R d^2 of each dent over R^3
  if constexpr (wall) {
    S_i = min(one, 1.0 + more) * S_i;
  } else if (any(more != 0.0)) {  // the weaker body has of the other's dent what it has more than half of the strain
    const T ratio = c.radius_j * c.curvature_i, cube = ratio * ratio * ratio;
    const T to_i = max(T{}, more) * cube * S_j, to_j = max(T{}, -more) * S_i / cube;
    S_i = min(one, 1.0 + more) * S_i + to_i;
    S_j = min(one, 1.0 - more) * S_j + to_j;
  }
  const T share = force / (4.0 * pi);
  const auto pressure = [&](T curvature, T depth) { return share * (curvature * curvature) * (1.0 - depth); };
  Dents<T> d{{x.i, S_i, area, pressure(c.curvature_i, now.i), way_i * top, way_i * force}, {}};
  if constexpr (!wall) d.j = {x.j, S_j, area, pressure(c.curvature_j, now.j), way_j * top, way_j * force};
  return d;
}

/// Pressure of the bodies [Pa], weighted by their growth.
template <bool wall, class T>
EPDEM_INLINE T body_pressure(const Growing<wall, T>& c) noexcept {
  const T w_i = c.radius_i * c.i.growth;
  if constexpr (wall) return select(w_i > 0.0, c.i.pressure, T{});
  const T w_j = c.radius_j * c.j.growth, sum = w_i + w_j;
  return select(sum > 0.0, (w_i * c.i.pressure + w_j * c.j.pressure) / only(sum > 0.0, sum), T{});
}

/// The backbone at the overlap b where growth has added `grown` to it; valid where b is above the elastic overlap.
template <class Law, class T = Number<Law>>
EPDEM_INLINE Point<T> grown_point(const Law& law, T R_star, T b, T grown, T pressure) noexcept {
  Point<T> p = law.load(R_star, b);
  const auto grows = grown > 0.0;
  if (!any(grows)) return p;
  const T alone = b - grown;
  const auto yielded = alone > law.elastic_overlap(R_star);
  const Point<T> elastic = hertz_point(law.E_star, R_star, max(T{}, alone));
  T force = elastic.force, radius = elastic.radius;
  if (any(yielded)) {
    const Point<T> q = law.load(R_star, select(yielded, alone, b));
    force = select(yielded, q.force, force);
    radius = select(yielded, q.radius, radius);
  }
  const T area = pi * (p.radius * p.radius - radius * radius);
  const T excess = p.force - force - area * (2.0 / 3.0 * law.Y + pressure);
  p.force = select(grows, p.force - yielded_share(law, R_star, b) * excess, p.force);
  return p;
}

/// s (1 - gamma) of both sides of a contact of this own area [m^2] in the sums, where it is above 0; x: its depths.
template <bool wall, class T>
EPDEM_INLINE Depths<T> screened(const Growing<wall, T>& c, const BodyShares<T>& bodies, T own, Depths<T> x) noexcept {
  const T root = sqrt(own);
  const auto side = [&](T all, T curvature, T compliance, T bulk, T depth) {
    // the root has no finite slope at 0, and the sums of an only contact may differ from its own area by round-off
    const T apart = all - own, others = select(apart > least_others * own, apart, T{});
    const T free = max(T{}, 1.0 - 0.5 * sqrt(others) * curvature);  // of 1 by the constriction
    const T loss = compliance * (1.0 - free * sqrt(free)) - bulk * others * curvature * (1.0 - depth) / root;
    return min((1.0 - least_screening) * compliance, max(T{}, loss));
  };
  const T s_i = bodies.compliance_i;
  if constexpr (wall) return {side(c.i.area, c.curvature_i, s_i, bodies.bulk_i, x.i), T{}};
  return {side(c.i.area, c.curvature_i, s_i, bodies.bulk_i, x.i),
          side(c.j.area, c.curvature_j, 1.0 - s_i, bodies.bulk_j, x.j)};
}

/// Work of the backbone with growth [J] between two overlaps apart, whose forces are known: beside the force of the law
/// alone the force of growth is smooth.
template <class Law, class T = Number<Law>>
[[gnu::noinline]] T work_of_leap(const Law& law, T R_star, T from, T to, T F_from, T F_to) noexcept {
  const T F0 = law.load(R_star, from).force, F1 = law.load(R_star, to).force;
  return law.work(R_star, from, to, F0, F1) + 0.5 * (to - from) * ((F_from - F0) + (F_to - F1));
}

/// A bond after a step; zeros where it is broken.
template <class T>
struct Held {
  T pull, grip;       // its pull and the largest one [N]
  T stretched, loss;  // its elastic energy, and what it lost as it broke [J]
};

/// stretch: overlap [m] below that at which the law has no force; whole: the bond had not broken; parts: the contact
/// ends.
template <class T, class M, class N>
[[gnu::noinline]] Held<T> hold(T strength, T modulus, T radius, T stretch, M whole, N parts) noexcept {
  const T most = strength * pi * radius * radius, k = 2.0 * modulus * radius;
  const T pull = k * max(T{}, stretch), reached = min(pull, most);
  const auto holds = whole & !parts & (pull <= most);
  const T energy = select(whole & (stretch > 0.0), 0.5 * reached * reached / k, T{});
  return {select(holds, pull, T{}), select(holds, most, T{}), select(holds, energy, T{}), select(holds, T{}, energy)};
}

}  // namespace detail

/// The overlap v [m] of a step, and u + q that it follows from; the extrapolation makes the error one of second order
/// in the time step. A step that is repeated keeps v.
template <class T>
struct Added {
  T now, extrapolated;
  T now_grown, grown;  // u of both
};

template <bool wall, class T>
EPDEM_INLINE Added<T> added_overlap(const Growing<wall, T>& c, bool repeats) noexcept {
  const GrowthState<T>& s = c.state;
  if (repeats) return {s.last, s.added, s.last_grown, s.grown};
  const T u = max(T{}, detail::grown(c, c.i.growth, c.j.growth) - s.own), now = u + s.shift;
  const auto known = s.screening > 0.0;
  const T added = select(known, max(now, 2.0 * now - s.last), now);
  // where a dent ends, u falls at once: no further fall follows from it
  return {now, added, u, min(added, select(known, max(u, 2.0 * u - s.last_grown), u))};
}

/// Grown spheres whose growth over the radius is at most `largest` touch below this factor of the squared sum of their
/// radii; half as much more is for the extrapolation, and 0.02 for q, which does not vanish with the growth.
inline double touch_factor(double largest) noexcept {
  const double reach = 1.0 + std::fmin(1.5 * largest + 0.02, growth_reach);
  return reach * reach;
}

/// What the energies of a step read of a GrowthState.
template <class T>
struct GrownEnd {
  T added, grown, screening, area, retreat, recovered, force;
};

template <class T>
EPDEM_INLINE GrownEnd<T> end_of(const GrowthState<T>& s) noexcept {
  return {s.added, s.grown, s.screening, s.area, s.retreat, s.recovered, s.force};
}

namespace detail {

/// d [m] and P_t [N] at a peak.
template <class T>
struct Punch {
  T opening, force;
};

template <class Law, class T = Number<Law>>
EPDEM_INLINE Punch<T> punch_at(const Law& law, const Point<T>& peak) noexcept {
  if constexpr (adheres<Law>) return {law.opening(peak.radius), law.punch(peak.radius)};
  return {T{}, T{}};
}

/// The history at another added overlap, where it is renewed: its opening curve begins at the grown peak.
template <class T, class M, class Load>
inline State<CavityAdhesive<T>> grown_history(const CavityAdhesive<T>& law, T R_star, State<CavityAdhesive<T>> now,
                                              M renewed, Load load) noexcept {
  if (!any(renewed)) return now;
  const auto dented = renewed & (now.delta_max > law.yield_overlap(R_star));
  now.dent = select(renewed, T{}, now.dent);
  if (any(dented)) {
    const T b = law.backbone_overlap(R_star, select(dented, now.delta_max, R_star));
    const Point<T> peak = load(b);
    const Opened<T> opened = opened_from(law, b, peak);
    now.point = select(dented, peak, now.point);
    now.dent = select(dented, opened.dent, now.dent);
    now.R_open = select(dented, opened.R_open, now.R_open);
    now.root = select(dented & (now.root > 0.0), max(opened.root, T{} + adhesive::no_root), now.root);
  }
  return now;
}

}  // namespace detail

/// With adhesion: the history before the step, at the overlap that is added in it.
template <class Law, bool = adheres<Law>>
struct GrownBefore {};
template <class Law>
struct GrownBefore<Law, true> {
  State<Law> first;
};

/// A step of a contact that grows.
template <class Law>
struct GrownStep : GrownBefore<Law> {
  Step<Law> step;                     // of the overlap with growth
  Number<Law> overlap;                // with growth and retreat [m]
  Number<Law> reached;                // largest overlap without growth, less the retreat, before the step [m]
  Number<Law> reached_grown;          // the same with growth
  Number<Law> delta_max;              // largest overlap without growth after the step [m]
  Number<Law> grip;                   // pull at which the bond breaks [N], 0: none or broken
  Number<Law> stretched, bond_loss;   // elastic energy of the bond; what it lost for good in this step [J]
  GrownEnd<Number<Law>> last, state;  // before and after the step
};

/// As `step`, for a contact whose law's history is `before`, with the largest overlap without growth. Writes the state
/// after the step and the dents to `c`.
template <bool wall, class Law, class T = Number<Law>>
EPDEM_INLINE GrownStep<Law> grown_step(const Law& law, const BodyShares<T>& bodies, T R_star, const State<Law>& before,
                                       T overlap, [[maybe_unused]] T closing, Growing<wall, T>& c,
                                       bool repeats) noexcept {
  const T zero{};
  const auto& body = law.backbone();
  Unset<GrownStep<Law>> room;  // zeros in all of it take 5 % of the step
  GrownStep<Law>& s = room.numbers;
  s.grip = s.stretched = s.bond_loss = zero;
  GrowthState<T> last;
  copy_numbers<T, growth_values>(c.state, last);
  s.last = end_of(last);
  const auto known = last.screening > 0.0;
  s.reached = select(known, before.delta_max, min(overlap, zero));
  Added<T> v = added_overlap(c, repeats);
  T pressure_now = last.last_pressure, pressure = last.pressure;
  if (!repeats) {
    pressure_now = detail::body_pressure(c);
    pressure = max(pressure_now, 2.0 * pressure_now - select(known, last.last_pressure, pressure_now));
  }
  const auto rests = known & (fabs(v.extrapolated - last.added) < at_rest * R_star) &
                     (fabs(v.grown - last.grown) < at_rest * R_star) &
                     (fabs(pressure - last.pressure) < at_rest * body.Y);
  v.extrapolated = select(rests, last.added, v.extrapolated);
  v.grown = select(rests, last.grown, v.grown);
  pressure = select(rests, last.pressure, pressure);
  // an only contact of a body has exactly no loss there: round-off would give the body a Q without sense
  const auto side = [](T twice) { return select(twice > 2.0 * least_loss, 0.5 * twice, T{}); };
  const auto sides = [&](T both, T lean) { return detail::Depths<T>{side(both + lean), side(both - lean)}; };
  const T lost = select(known, 1.0 - last.screening, zero);
  detail::Depths<T> raw = sides(last.raw, last.raw_lean), loss = sides(lost, last.lean);
  T retreat = last.retreat;
  if (!repeats) {
    const auto dented = last.area > 0.0;
    if (any(dented)) {
      const detail::Depths<T> x = detail::depths_of(c, max(zero, s.reached));
      const detail::Depths<T> found = detail::screened(c, bodies, only(dented, last.area), x);
      const auto follow = [&](T now, T share, T& raw_loss, T& used) {
        const T rises = max(raw_loss, now);
        used = select(dented, max(used, min((1.0 - least_screening) * share, 2.0 * rises - raw_loss)), used);
        raw_loss = select(dented, rises, raw_loss);
      };
      follow(found.i, bodies.compliance_i, raw.i, loss.i);
      T parted = loss.i * c.i.parted;
      if constexpr (!wall) {
        follow(found.j, 1.0 - bodies.compliance_i, raw.j, loss.j);
        parted = parted + loss.j * c.j.parted;
      }
      retreat = zero;
      if (any(parted > 0.0))
        retreat = select(dented, parted * max(zero, 2.0 * last.recovered - last.last_recovered), zero);
    }
  }
  T level = overlap - retreat;  // a step that is repeated finds contacts at their largest overlap
  if (repeats) level = select(fabs(level - s.reached) < 1e-9 * fabs(s.reached), s.reached, level);
  s.delta_max = select((level < s.reached) & (s.reached < no_overlap), s.reached, level);
  s.overlap = level + v.extrapolated;
  s.reached_grown = s.reached + v.extrapolated;
  State<Law> grown_before = before;
  grown_before.delta_max = s.reached_grown;
  const auto kept = [&](auto falls) __attribute__((always_inline)) { return falls & rests; };
  const auto load = [&](T b) __attribute__((always_inline)) {
    return detail::grown_point(body, R_star, b, v.grown, pressure);
  };
  auto parts = !(overlap + v.extrapolated > 0.0);
  T force;  // without a jump
  if constexpr (adheres<Law>) {
    grown_before.delta_max = select(known, s.reached_grown, zero);  // a new contact grows, across a gap, too
    const auto has_curve = (before.dent > 0.0) | (s.reached_grown <= law.yield_overlap(R_star));
    s.first = detail::grown_history(law, R_star, grown_before, known & !(kept(known) & has_curve), load);
    s.step = step(law, R_star, s.first, s.overlap, closing, load);
    parts = parts & !(s.step.after.root > 0.0);
    const auto forgot = (s.first.dent > 0.0) & !parts & (s.step.after.dent <= 0.0);  // the retreat alone opened it
    if (any(forgot)) {
      s.step.after.dent = select(forgot, s.first.dent, s.step.after.dent);
      s.step.after.R_open = select(forgot, s.first.R_open, s.step.after.R_open);
      s.step.after.point = select(forgot, s.first.point, s.step.after.point);
    }
    force = s.step.force - s.step.after.jump;
  } else {
    s.step = step_of_peak(law, R_star, grown_before, s.overlap, kept, load);
    force = s.step.force;
  }

  const Point<T>& peak = s.step.after.point;
  const detail::Punch<T> punch = detail::punch_at(law, peak);
  const T m = detail::yielded_share(body, R_star, s.delta_max + v.extrapolated + punch.opening);
  const T soft = (loss.i + loss.j) * m;
  const auto dented = (m > 0.0) & (peak.radius > 0.0);
  const Recovery<T> back = recovery(law.E_star, peak);
  const T residual = max(zero, s.delta_max + punch.opening) - (1.0 - soft) * back.overlap;
  const T area = select(dented, m * (peak.radius * peak.radius), zero);
  const T recovered = select(dented, m * back.overlap, zero);
  c.dents = detail::dents_of(c, bodies.strain_i, select(dented & (residual > 0.0), residual, zero), area, overlap,
                             force, loss.i * recovered, loss.j * recovered, peak.force - punch.force);
  if (!repeats) {
    const T own =
        detail::grown(c, growth(c.dents.i.cover, c.dents.i.volume), growth(c.dents.j.cover, c.dents.j.volume));
    const T unstored = select(dented, soft * back.work, zero);
    const T before_force = select(c.state.area > 0.0, before.point.force, peak.force);
    const T shift = select(dented, (unstored - c.state.unstored) / (0.5 * (peak.force + before_force)), zero);
    c.state = {v.now,
               v.extrapolated,
               last.shift + shift,
               raw.i + raw.j,
               raw.i - raw.j,
               1.0 - (loss.i + loss.j),
               loss.i - loss.j,
               own,
               area,
               unstored,
               v.now_grown,
               v.grown,
               pressure_now,
               pressure,
               retreat,
               recovered,
               select(last.area > 0.0, last.recovered, recovered),
               force,
               c.state.broken};
  }
  if constexpr (!wall && !adheres<Law>)
    if (rarely(any(c.bond > 0.0))) {
      const T stretch = s.step.after.delta_max - back.overlap - s.overlap;
      const auto whole = (c.bond > 0.0) & dented & (c.state.broken == 0.0);
      const auto bond = detail::hold(c.bond, law.E_star, peak.radius, stretch, whole, parts);
      s.step.force = s.step.force - bond.pull;
      s.step.radius = select(bond.grip > 0.0, peak.radius, s.step.radius);
      s.grip = bond.grip, s.stretched = bond.stretched, s.bond_loss = bond.loss;
      if (!repeats) c.state.broken = select(whole & !(bond.grip > 0.0), constant<T>(1.0), c.state.broken);
    }
  // a new contact that is looked at before a step has no growth of its own yet that it could take from its sums
  if (const auto undented = repeats ? parts | !known : parts; any(undented)) keep_where<T>(!undented, c.dents);
  if (any(parts)) {
    s.delta_max = select(parts, zero, s.delta_max);
    keep_where<T>(!parts, c.state);
  }
  s.state = end_of(c.state);
  return s;
}

}  // namespace epdem
