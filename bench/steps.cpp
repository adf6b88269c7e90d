// SPDX-License-Identifier: GPL-2.0-or-later
// ns per step of every law, and of the choices behind `cavity`: built and run by bench/steps.py.
//
// prescribed: overlaps of 4096 contacts that rise to a peak and go back and forth below it, nine steps of ten elastic,
//             as in a packing; steps of different contacts do not wait for each other.
// impact:     one two-body impact after the other, where every step waits for the force of the one before.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "epdem/impact.hpp"
#include "epdem/laws.hpp"

using namespace epdem;

namespace {

constexpr double E_star = 1.14e11, R_star = 0.01, m_star = 0.033;
constexpr int contacts = 4096, rounds = 40;
double sink = 0.0;

double now() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Overlap of contact k in a round: over the first tenth of the rounds new ground, then below the peak.
double overlap(int k, int round) {
  const double peak = 2e-6 * (1.0 + 400.0 * double(k) / contacts);
  const double x = round < rounds / 10 ? double(round + 1) / (rounds / 10) : 1.0 - 0.02 * ((round * 7 + k) % 10);
  return peak * x;
}

/// ns per step of `advance(state, delta) -> force` with one state per contact: the fastest of many passes.
template <class Memory, class Advance>
double prescribed(const Advance& advance) {
  std::vector<double> delta(contacts * rounds);
  for (int r = 0; r < rounds; ++r)
    for (int k = 0; k < contacts; ++k) delta[r * contacts + k] = overlap(k, r);
  double best = 1e300;
  for (int pass = 0; pass < 12; ++pass) {
    std::vector<Memory> memory(contacts);
    const double start = now();
    for (int r = 0; r < rounds; ++r)
      for (int k = 0; k < contacts; ++k) sink += advance(memory[k], delta[r * contacts + k]);
    best = std::min(best, (now() - start) / (double(contacts) * rounds));
  }
  return best;
}

template <class Law>
double impacts(const Law& law) {
  double best = 1e300;
  for (int pass = 0; pass < 12; ++pass) {
    std::int64_t steps = 0;
    const double start = now();
    for (int k = 0; k < 200; ++k) {
      const auto out = impact(law, {R_star, m_star, 0.5 + 0.1 * k, 2e-7, 1e-9, 100000, 0.0}, {});
      steps += out.steps;
      sink += out.rebound_speed;
    }
    best = std::min(best, (now() - start) / double(steps));
  }
  return best;
}

template <class Law>
void measure(const char* name, const double* parameter) {
  const Law law(E_star, parameter);
  const double p = prescribed<State<Law>>([&](State<Law>& s, double delta) {
    const auto step_now = step(law, R_star, s, delta);
    s = step_now.after;
    return step_now.force;
  });
  std::printf("law %s %.2f %.2f\n", name, p, impacts(law));
}

/// As unload<true>, with the segment function as libm has it.
Point<double> unload_by_libm(const Point<double>& peak, double delta_max, double delta) {
  const double w = (delta_max - delta) * (E_star * peak.radius / peak.force);
  const double tau = peak.flatness, A = 0.75 * (1.0 - tau), B = 2.0 / pi * tau;
  const double S = B + std::sqrt(B * B + 4.0 * A * w), u = (S - 2.0 * w) / S;
  if (!(u > 0.0)) return {0.0, 0.0, tau};
  const double y = 1.0 - u, disc = u * (2.0 - u), root = std::sqrt(disc);
  return {peak.force * ((1.0 - tau) * disc * root + B * (std::acos(y) - y * root)), peak.radius * root, tau};
}

Point<double> unload_by_polynomial(const Point<double>& peak, double delta_max, double delta) {
  return unload<true>(E_star, peak, delta_max, delta);
}

/// One step of `cavity` with or without the values at the peak in memory; the rest is the same.
template <bool keeps, Point<double> (*below)(const Point<double>&, double, double)>
double choice(const Cavity<double>& law) {
  return prescribed<Peak<double>>([&](Peak<double>& s, double delta) {
    if (delta >= s.delta_max || s.delta_max <= law.elastic_overlap(R_star)) {
      const auto at = step(law, R_star, s, delta);
      s.delta_max = at.after.delta_max;
      if (keeps) s.point = at.after.point;
      return at.force;
    }
    return below(keeps ? s.point : law.load(R_star, s.delta_max), s.delta_max, delta).force;
  });
}

void choices(const double* parameter) {
  const Cavity<double> law(E_star, parameter);
  std::printf("choice keep+polynomial %.2f\n", choice<true, unload_by_polynomial>(law));
  std::printf("choice keep+acos %.2f\n", choice<true, unload_by_libm>(law));
  std::printf("choice recompute+polynomial %.2f\n", choice<false, unload_by_polynomial>(law));
  std::printf("choice recompute+acos %.2f\n", choice<false, unload_by_libm>(law));
}

/// [acos y - y sqrt(1-y^2)]/u^1.5 as a quotient of polynomials of degree 5: approximation error 8e-16.
double quotient(double u) {
  const double u2 = u * u, u4 = u2 * u2;
  const double n0 = 1.8856180831641252 - 2.4416344415410567 * u, n2 = 1.1650787427499454 - 0.24874773060948246 * u;
  const double n4 = 0.022527795932343123 - 0.0006124201124364862 * u;
  const double d0 = 1.0 - 1.1448722030943796 * u, d2 = 0.4595383363942893 - 0.07571659813021332 * u;
  const double d4 = 0.00442860989371509 - 4.2950637949419176e-05 * u;
  return ((n0 + n2 * u2) + n4 * u4) / ((d0 + d2 * u2) + d4 * u4);
}

/// The segment function, u = 1 - y: ns per value when values do not wait for each other, ns when they do, and the
/// largest relative error over u from 1e-6 to 1 against the half angle in long double.
template <class F>
void segment_choice(const char* name, const F& f) {
  double many = 1e300, chain = 1e300;
  for (int pass = 0; pass < 12; ++pass) {
    double start = now(), sum = 0.0;
    for (int i = 0; i < 200000; ++i) sum += f((i + 0.5) / 200000.0);
    many = std::min(many, (now() - start) / 200000.0);
    start = now();
    double x = 0.3;
    for (int i = 0; i < 200000; ++i) x = f(0.2 * x + 0.1);
    chain = std::min(chain, (now() - start) / 200000.0);
    sink += sum + x;
  }
  double worst = 0.0;
  for (int i = 0; i <= 100000; ++i) {
    const double u = std::pow(10.0, -6.0 * i / 100000.0);
    const long double phi = 4.0L * asinl(sqrtl(u / 2.0L));
    // (phi - sin phi)/2, by its series where that cancels
    const long double q = phi * phi;
    const long double inner = 1.0L - q / 72.0L * (1.0L - q / 110.0L * (1.0L - q / 156.0L));
    const long double series = phi * q / 12.0L * (1.0L - q / 20.0L * (1.0L - q / 42.0L * inner));
    const long double exact = phi > 0.3L ? 0.5L * (phi - sinl(phi)) : series;
    worst = std::max(worst, std::fabs(double(f(u) / exact - 1.0L)));
  }
  std::printf("segment %s %.2f %.2f %.1e\n", name, many, chain, worst);
}

}  // namespace

int main() {
  const double pressure[] = {2.8e9}, cavity[] = {1e9, 1.6, 2.8, no_finite_strain}, meyer[] = {2.8e9, 0.25},
               none[] = {0.0};
  measure<Hertz<double>>("hertz", none);
  measure<Thornton<double>>("thornton", pressure);
  measure<Johnson<double>>("johnson", pressure);
  measure<Cavity<double>>("cavity", cavity);
  measure<Meyer<double>>("meyer", meyer);
  choices(cavity);
  segment_choice("polynomial", [](double u) { return u * std::sqrt(u) * detail::segment(u); });
  segment_choice("quotient", [](double u) { return u * std::sqrt(u) * quotient(u); });
  segment_choice("acos", [](double u) { return std::acos(1.0 - u) - (1.0 - u) * std::sqrt(u * (2.0 - u)); });
  return sink == 1.0;  // the sums are used
}
