// SPDX-License-Identifier: BSD-3-Clause
// Friction of a contact circle with partial slip, for any history of load and shear: Cattaneo and Mindlin by springs
// along a contact line (Jaeger 1993; Popov and Hess 2015), of which 2 or 3 nodes of Gauss and Lobatto's rule are left.
//
// A contact remembers the stretch of the springs at its nodes and the radius at which they were stored. The stretches
// change their sign when the pair is stored from the other side, the radius does not.
#pragma once

#include "friction/sliding.hpp"
#include "pair.hpp"

namespace epdem {

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

/// History of a contact with partial slip, 3 N + 1 numbers; zeros: a new contact.
template <int N, class T>
struct SlipState {
  Vec<T> stretch[N];  // of the springs at the nodes [m]
  T radius;           // contact radius they belong to [m]
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
};

/// Elastic energy [J] of the springs: 4 G* a sum w s^2, stiffness = 8 G* [Pa].
template <int N, class T>
EPDEM_INLINE T slip_energy(const SlipState<N, T>& state, const T& stiffness) noexcept {
  T sum{};
  for (int i = 0; i < N; ++i) sum = sum + Lobatto<N>::weight[i] * dot(state.stretch[i], state.stretch[i]);
  return 0.5 * stiffness * state.radius * sum;
}

/// Friction [N] of the springs alone: -8 G* a sum w s.
template <int N, class T>
EPDEM_INLINE Vec<T> slip_force(const SlipState<N, T>& state, const T& stiffness) noexcept {
  Vec<T> sum{T{}, T{}, T{}};
  for (int i = 0; i < N; ++i) sum = sum - (T{} + Lobatto<N>::weight[i]) * state.stretch[i];
  return (stiffness * state.radius) * sum;
}

/// Work [J] lost in a step: work of the slip minus gain of elastic energy. The mean of both ends' forces does the
/// work, as in velocity Verlet; the force of the dashpot is known at this end only.
template <int N, class T>
EPDEM_INLINE T slip_loss(const SlipState<N, T>& before, const SlipStep<N, T>& now, const Vec<T>& slip,
                         const T& stiffness) noexcept {
  const Vec<T> twice = now.force + now.force - slip_force(now.after, stiffness) + slip_force(before, stiffness);
  return slip_energy(before, stiffness) - slip_energy(now.after, stiffness) - 0.5 * dot(twice, slip);
}

namespace detail {

inline constexpr double least = std::numeric_limits<double>::min();  // instead of a division by 0

/// Largest force of the springs at the nodes, as if all of them had it [N]: `most` in all where all nodes slide. They
/// share it like the load q of the line: Hertz's half-ellipse; Flattens: with tau of it uniform pressure, less the
/// rigid punches between radius_max and radius (Mesarovic and Johnson 2000, eq. 8.82).
template <int N, bool Flattens, class T>
EPDEM_INLINE void slip_limits(const Pressed<T>& now, const T& most, T* limit) noexcept {
  using Rule = Lobatto<N>;
  if constexpr (Flattens) {
    const T b = now.radius / max(max(now.radius_max, now.radius), T{} + least), rest = sqrt(1.0 - b * b);
    T depth[N], sum{};
    for (int i = 0; i < N; ++i) depth[i] = sqrt(1.0 - b * b * (Rule::node[i] * Rule::node[i])) + rest;
    for (int i = 0; i < N; ++i) {  // q over (1 - x^2), times all depths: none is divided by
      T q = 0.75 * (1.0 - now.flatness) * depth[i] + 2.0 / pi * now.flatness;
      for (int j = 0; j < N; ++j)
        if (j != i) q = q * depth[j];
      limit[i] = (1.0 - Rule::node[i] * Rule::node[i]) * q;
      sum = sum + Rule::weight[i] * limit[i];
    }
    const T share = most / sum;
    for (int i = 0; i < N; ++i) limit[i] = share * limit[i];
  } else {
    for (int i = 0; i < N; ++i) limit[i] = (1.5 * (1.0 - Rule::node[i] * Rule::node[i])) * most;
  }
}

/// Friction [N] of stretches within their limits, with the dashpot inside `most`, the limit of friction.
template <int N, bool Damped, class T>
EPDEM_INLINE Vec<T> friction(const SlipState<N, T>& state, const Shear<T>& motion, const T& most,
                             const T& stiffness) noexcept {
  const Vec<T> springs = slip_force(state, stiffness);
  if constexpr (Damped) return limited(springs - motion.damping * motion.slip, T{} + 1.0, most);
  return springs;
}

}  // namespace detail

/// One step of friction: a pure function of memory, normal contact and motion.
///
/// stiffness = 8 G* [Pa], mu the coefficient of friction. Flattens: the law has tau > 0; else the load of the line is
/// Hertz's. Damped: with a dashpot, inside the limit mu load. T is double or Lanes. Without load nothing is left. Its
/// energy never grows but by the work of the slip: the nodes' rule sums by parts, so that carrying the stretch to
/// another radius keeps a sum w s^2 (to second order of the change of radius), and the limit only takes.
template <int N, bool Flattens, bool Damped, class T>
EPDEM_INLINE SlipStep<N, T> partial_slip(const SlipState<N, T>& before, const Pressed<T>& now, const Shear<T>& motion,
                                         const T& stiffness, const T& mu) noexcept {
  using Rule = Lobatto<N>;
  const T one = T{} + 1.0, tiny = T{} + detail::least;
  const Vec<T>& n = motion.normal;
  // rotation about the normal by `turn` (Cayley: exactly orthogonal)
  const T half = 0.5 * motion.turn, share = 1.0 / (1.0 + half * half);
  const T cosine = (1.0 - half * half) * share;
  const Vec<T> spin = (motion.turn * share) * n;
  Vec<T> turned[N];
  for (int i = 0; i < N; ++i) {
    // the stretch turns with the contact and keeps its length; the series of 1/sqrt(1-e) stays below it
    const Vec<T>& s = before.stretch[i];
    const T out_of_plane = dot(n, s), e = out_of_plane * out_of_plane / max(dot(s, s), tiny);
    turned[i] = (1.0 + e * (0.5 + 0.375 * e)) * (cosine * (s - out_of_plane * n) + cross(spin, s));
  }
  Vec<T> c[N];  // of its profile
  for (int k = 0; k < N; ++k) {
    c[k] = (T{} + Rule::profile[k][0]) * turned[0];
    for (int j = 1; j < N; ++j) c[k] = c[k] + (T{} + Rule::profile[k][j]) * turned[j];
  }

  const auto pressed = min(now.load, now.radius) > 0.0;
  const T radius = select(pressed, now.radius, T{}), most = select(pressed, mu * now.load, T{});
  const T ratio = radius * (1.0 / max(before.radius, tiny)), square = ratio * ratio;
  const T unit = select(pressed, stiffness * radius, one);  // without load every stretch is above its limit, 0
  T limit[N];
  detail::slip_limits<N, Flattens>(now, most, limit);
  SlipStep<N, T> out;
  out.after.radius = radius;
  for (int i = 0; i < N; ++i) {
    // the stretch stays where the material is: the node takes the stretch at ratio xi of the old circle, 0 beyond its
    // rim
    const T z = min(square * (Rule::node[i] * Rule::node[i]), one);
    Vec<T> s = c[N - 1];
    for (int k = N - 2; k >= 0; --k) s = z * s + c[k];
    out.after.stretch[i] = limited((1.0 - z) * s + motion.slip, unit, limit[i]);
  }
  out.force = detail::friction<N, Damped>(out.after, motion, most, stiffness);
  return out;
}

/// Friction [N] where a contact is looked at and no step is taken: the springs as they are, which gives the bits of the
/// last step's force again, and the dashpot. A load that holds another dashpot than that of the step limits it anew;
/// the rounding of a sum of springs does not.
template <int N, bool Damped, class T>
EPDEM_INLINE Vec<T> present_friction(const SlipState<N, T>& state, const T& load, const Shear<T>& motion,
                                     const T& stiffness, const T& mu) noexcept {
  const auto holds = min(load, state.radius) > 0.0;
  const T most = select(holds, mu * load, T{});
  return limited(detail::friction<N, Damped>(state, motion, most, stiffness), T{} + (1.0 - 1e-12), most);
}

}  // namespace epdem
