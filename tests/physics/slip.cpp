// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of partial slip for arrays of contacts, one by one and in lanes: what the tests of the law call.
#include <epdem/partial_slip.hpp>

namespace {

using epdem::Lanes;

/// Rows of `width` numbers from `row` on as the members of one object of T.
void get(double& x, const double* rows, int, int member) { x = rows[member]; }
void get(Lanes& x, const double* rows, int width, int member) {
  for (int k = 0; k < epdem::lane_count; ++k) x[k] = rows[k * width + member];
}
void put(double x, double* rows, int, int member) { rows[member] = x; }
void put(const Lanes& x, double* rows, int width, int member) {
  for (int k = 0; k < epdem::lane_count; ++k) rows[k * width + member] = x[k];
}

template <int N, bool Flattens, bool Damped, class T>
void steps(long count, double stiffness, double mu, double* state, const double* now, const double* shear,
           double* out) {
  constexpr int lanes = sizeof(T) / sizeof(double), width = 3 * N + 1;  // NOLINT(bugprone-sizeof-expression)
  for (long i = 0; i + lanes <= count; i += lanes) {
    epdem::SlipState<N, T> before;
    epdem::Pressed<T> p;
    epdem::Shear<T> s;
    T* const members[] = {&p.load,     &p.radius, &p.radius_max, &p.flatness, &s.normal.x, &s.normal.y,
                          &s.normal.z, &s.slip.x, &s.slip.y,     &s.slip.z,   &s.turn,     &s.damping};
    for (int k = 0; k < 4; ++k) get(*members[k], now + 4 * i, 4, k);
    for (int k = 0; k < 8; ++k) get(*members[4 + k], shear + 8 * i, 8, k);
    for (int k = 0; k < width; ++k) get(reinterpret_cast<T*>(&before)[k], state + width * i, width, k);
    auto r = epdem::partial_slip<N, Flattens, Damped>(before, p, s, T{} + stiffness, T{} + mu);
    for (int k = 0; k < width; ++k) put(reinterpret_cast<T*>(&r.after)[k], state + width * i, width, k);
    const T found[] = {r.force.x, r.force.y, r.force.z, epdem::slip_loss(before, r, s.slip, T{} + stiffness),
                       epdem::slip_energy(r.after, T{} + stiffness)};
    for (int k = 0; k < 5; ++k) put(found[k], out + 5 * i, 5, k);
  }
}

template <int N, class T>
void choose(bool flattens, bool damped, long n, double k, double mu, double* s, const double* p, const double* d,
            double* out) {
  if (flattens)
    damped ? steps<N, true, true, T>(n, k, mu, s, p, d, out) : steps<N, true, false, T>(n, k, mu, s, p, d, out);
  else
    damped ? steps<N, false, true, T>(n, k, mu, s, p, d, out) : steps<N, false, false, T>(n, k, mu, s, p, d, out);
}

}  // namespace

/// `count` contacts, a multiple of the number of lanes if in_lanes. Rows: state 3 N + 1, now 4, shear 8, out 5 (force,
/// dissipated work, elastic energy); state is what was before and comes after.
extern "C" void slip_steps(int nodes, int flattens, int damped, int in_lanes, long count, double stiffness, double mu,
                           double* state, const double* now, const double* shear, double* out) {
  const auto one = nodes == 2 ? choose<2, double> : choose<3, double>;
  const auto many = nodes == 2 ? choose<2, Lanes> : choose<3, Lanes>;
  (in_lanes ? many : one)(flattens, damped, count, stiffness, mu, state, now, shear, out);
}

/// Nodes, weights and profile of the rule.
extern "C" void slip_rule(int nodes, double* node, double* weight, double* profile, double* total) {
  const auto copy = [&](auto rule, int n) {
    for (int i = 0; i < n; ++i) node[i] = rule.node[i], weight[i] = rule.weight[i];
    for (int i = 0; i < n * n; ++i) profile[i] = rule.profile[i / n][i % n];
    *total = rule.total;
  };
  nodes == 2 ? copy(epdem::Lobatto<2>{}, 2) : copy(epdem::Lobatto<3>{}, 3);
}
