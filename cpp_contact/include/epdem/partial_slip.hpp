// SPDX-License-Identifier: GPL-2.0-or-later
// Friction of a contact circle with partial slip, for any history of load and shear: Cattaneo and Mindlin by springs
// along a contact line (Jaeger 1993; Popov and Hess 2015), of which 2 or 3 nodes of Gauss and Lobatto's rule are left.
//
// A contact remembers the stretch of the springs at its nodes and the radius at which they were stored. The stretches
// change their sign when the pair is stored from the other side, the radius does not.
#pragma once

#include <type_traits>

#include "pair.hpp"

namespace epdem {

/// A vector of numbers: one contact (double) or many lanes.
template <class T>
struct Vec {
  T x, y, z;
};

template <class T>
inline Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
inline Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
inline Vec<T> operator*(const T& c, const Vec<T>& a) noexcept {
  return {c * a.x, c * a.y, c * a.z};
}
template <class T>
inline T dot(const Vec<T>& a, const Vec<T>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
inline Vec<T> cross(const Vec<T>& a, const Vec<T>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Positive interior nodes xi = x/a of Gauss and Lobatto's rule of 2 N + 2 points, their weights, and the profile
/// s(xi) = (1 - xi^2) sum_k c_k xi^(2k), c_k = sum_j profile[k][j] s_j, which vanishes at the rim.
template <int N>
struct Lobatto;

template <>
struct Lobatto<2> {
  static constexpr double node[2] = {0.28523151648064510, 0.76505532392946469};
  static constexpr double weight[2] = {0.55485837703548635, 0.37847495629784698};
  static constexpr double profile[2][2] = {{1.2642972847076846, -0.38929728470768456},
                                           {-2.1600485957722752, 4.7850485957722752}};
  static constexpr double total = 14.0 / 15.0;  // of the weights
};

template <>
struct Lobatto<3> {
  static constexpr double node[3] = {0.20929921790247887, 0.59170018143314230, 0.87174014850960662};
  static constexpr double weight[3] = {0.41245879465870388, 0.34112269248350436, 0.21070422714350604};
  static constexpr double profile[3][3] = {{1.2685036601414938, -0.40805870693911218, 0.21768004679761836},
                                           {-5.2924022918641719, 9.8520663920355290, -5.5909141001713571},
                                           {4.7677582192262912, -12.257822881998599, 14.193189662772308}};
  static constexpr double total = 27.0 / 28.0;
};

/// What a contact with partial slip remembers; 3 N + 1 numbers. All zero: nothing.
template <int N, class T>
struct SlipState {
  Vec<T> stretch[N];  // of the springs at the nodes [m]
  T radius;           // contact radius they belong to [m]
};

/// What the normal law says of the contact in this step.
template <class T>
struct Pressed {
  T load;        // [N] friction is at most mu times it: F; F + 2 P_po for a law with pull-off force P_po
  T radius;      // contact radius a [m]
  T radius_max;  // the same at the largest overlap [m]; read by laws that flatten only
  T flatness;    // tau there
};

/// How the surfaces move in this step.
template <class T>
struct Shear {
  Vec<T> normal;  // unit vector of the contact
  Vec<T> slip;    // relative tangential displacement of the surfaces, v_t dt [m]
  T turn;         // rotation about the normal, mean of both bodies, w_n dt [rad]
  T damping;      // dashpot over the time step, gamma_t/dt [N/m]; read if Damped
};

template <int N, class T>
struct SlipStep {
  Vec<T> force;           // [N] against the slip; never above mu load
  SlipState<N, T> after;  // what the contact remembers if this step counts
  T dissipated;           // [J] in this step: work of the slip less the gain of elastic energy
};

/// Elastic energy [J] of the springs: 4 G* a sum w s^2, stiffness = 8 G* [Pa].
template <int N, class T>
inline T slip_energy(const SlipState<N, T>& state, const T& stiffness) noexcept {
  T sum(0.0);
  for (int i = 0; i < N; ++i) sum = sum + T(Lobatto<N>::weight[i]) * dot(state.stretch[i], state.stretch[i]);
  return T(0.5) * stiffness * state.radius * sum;
}

/// Friction [N] of the springs alone: -8 G* a sum w s.
template <int N, class T>
inline Vec<T> slip_force(const SlipState<N, T>& state, const T& stiffness) noexcept {
  Vec<T> sum{T(0.0), T(0.0), T(0.0)};
  for (int i = 0; i < N; ++i) sum = sum - T(Lobatto<N>::weight[i]) * state.stretch[i];
  return (stiffness * state.radius) * sum;
}

namespace detail {

template <class T>
inline std::enable_if_t<std::is_arithmetic_v<T>, T> select(bool condition, T yes, T no) noexcept {
  return condition ? yes : no;
}

/// Load of the line at the nodes, in units of load/(2 a sum w q): (1-tau) of Hertz's half-ellipse and tau of uniform
/// pressure, less the rigid punches between radius_max and radius (Mesarovic and Johnson 2000, eq. 8.82).
template <int N, class T>
inline void line_load(const Pressed<T>& now, const T& tiny, T* q) noexcept {
  using std::max;
  using std::sqrt;
  const T b = now.radius / max(max(now.radius_max, now.radius), tiny), rest = sqrt(T(1.0) - b * b);
  T sum(0.0);
  for (int i = 0; i < N; ++i) {
    const double xi = Lobatto<N>::node[i];
    const T flat = T(2.0 / pi) * now.flatness / (sqrt(T(1.0) - b * b * T(xi * xi)) + rest);
    q[i] = T(1.0 - xi * xi) * (T(0.75) * (T(1.0) - now.flatness) + flat);
    sum = sum + T(Lobatto<N>::weight[i]) * q[i];
  }
  for (int i = 0; i < N; ++i) q[i] = q[i] / sum;
}

}  // namespace detail

/// One step of friction: a pure function of memory, normal contact and motion.
///
/// stiffness = 8 G* [Pa], mu the coefficient of friction. Flattens: the law has tau > 0; else the load of the line is
/// Hertz's. Damped: with a dashpot, inside the limit mu load. T is a number or a vector of lanes with the operations of
/// one, select, sqrt, min and max. Without load nothing is left. Its energy never grows but by the work of the slip:
/// the nodes' rule sums by parts, so that carrying the stretch to another radius keeps a sum w s^2 (to second order of
/// the change of radius), and the limit only takes.
template <int N, bool Flattens, bool Damped, class T>
inline SlipStep<N, T> partial_slip(const SlipState<N, T>& before, const Pressed<T>& now, const Shear<T>& motion,
                                   const T& stiffness, const T& mu) noexcept {
  using detail::select;
  using std::max;
  using std::min;
  using std::sqrt;
  using Rule = Lobatto<N>;
  const T zero(0.0), one(1.0), tiny(std::numeric_limits<double>::min());
  const Vec<T>& n = motion.normal;
  const auto pressed = min(now.load, now.radius) > zero;
  const T radius = select(pressed, now.radius, zero), unit = stiffness * radius;  // [m], [N/m] of force per stretch

  T limit[N];  // of the stretch at the nodes; 0 without load, and then the stretch and the force are 0 as well
  const T scale = select(pressed, mu * now.load / unit, zero);
  if constexpr (Flattens) {
    detail::line_load<N>(now, tiny, limit);
    for (int i = 0; i < N; ++i) limit[i] = scale * limit[i];
  } else {
    for (int i = 0; i < N; ++i) limit[i] = scale * T(1.5 * (1.0 - Rule::node[i] * Rule::node[i]));
  }
  // rotation about the normal by `turn` (Cayley: exactly orthogonal)
  const T half = T(0.5) * motion.turn, share = one / (one + half * half);
  const T cosine = (one - half * half) * share, sine = motion.turn * share;
  const T ratio = radius / max(before.radius, tiny);
  T drag(0.0);
  if constexpr (Damped) drag = select(pressed, motion.damping / (unit * T(Rule::total)), zero);

  Vec<T> c[N];  // of the old profile
  for (int k = 0; k < N; ++k) {
    c[k] = T(Rule::profile[k][0]) * before.stretch[0];
    for (int j = 1; j < N; ++j) c[k] = c[k] + T(Rule::profile[k][j]) * before.stretch[j];
  }

  SlipStep<N, T> out{{zero, zero, zero}, {{}, radius}, zero};
  Vec<T> elastic{zero, zero, zero};
  for (int i = 0; i < N; ++i) {
    // the stretch stays where the material is: at the node it is that of ratio xi in the old circle, 0 beyond its rim
    const T old = ratio * T(Rule::node[i]), z = min(old * old, one);
    Vec<T> s = c[N - 1];
    for (int k = N - 2; k >= 0; --k) s = z * s + c[k];
    s = (one - z) * s;
    // it turns with the contact and keeps its length; the series of 1/sqrt(1-e) stays below it
    const T out_of_plane = dot(n, s), e = out_of_plane * out_of_plane / max(dot(s, s), tiny);
    const T length = one + e * (T(0.5) + T(0.375) * e);
    s = (length * cosine) * (s - out_of_plane * n) + (length * sine) * cross(n, s) + motion.slip;

    const T held = limit[i] / max(max(sqrt(dot(s, s)), limit[i]), tiny);
    const T weight = T(Rule::weight[i]) * unit;
    s = held * s;
    out.after.stretch[i] = s;
    elastic = elastic - weight * s;
    if constexpr (Damped) {
      const Vec<T> whole = s + drag * motion.slip;
      const T most = sqrt(dot(whole, whole));
      out.force = out.force - (weight * limit[i] / max(max(most, limit[i]), tiny)) * whole;
    }
  }
  if constexpr (!Damped) out.force = elastic;
  // the mean of both ends' forces does the work, as in velocity Verlet; that of the dashpot is known at this end only
  const Vec<T> mean = T(0.5) * (out.force + out.force - elastic + slip_force(before, stiffness));
  out.dissipated = slip_energy(before, stiffness) - slip_energy(out.after, stiffness) - dot(mean, motion.slip);
  return out;
}

}  // namespace epdem
