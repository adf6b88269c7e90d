// SPDX-License-Identifier: GPL-2.0-or-later
// The adhesive laws behind a pipe: one line in, one line out. Built and run by adhesive.py beside this file.
//
// impact LAW E* R* Gamma p_y c_strain m* V dt gap steps: rebound speed (0: still attached after `steps`), largest
//     force, largest overlap, smallest force but in the step of touch, overlap and step of the last attached sample
// twice LAW ...: the same of a second impact, the pair being sent back with the speed at which it came out
// path LAW E* R* Gamma p_y c_strain n overlap_1 ...: force, radius and stored energy at prescribed overlaps, closing
//     speed 0
// books LAW E* R* Gamma p_y c_strain n overlap_1 ...: force, stored energy, work of yield and of adhesion so far
// hertz|thornton|cavity E* R* p_y n overlap_1 ...: the same by the laws without adhesion
// The p_y of cavity_adhesive is its yield stress; c_strain is its alone.
// gap LAW E* R* Gamma p_y c_strain: the largest gap across which the law pulls
#include <cstdio>
#include <iostream>
#include <string>

#include "epdem/cavity_adhesive.hpp"
#include "epdem/hertz.hpp"
#include "epdem/jkr.hpp"
#include "epdem/law.hpp"
#include "epdem/thornton.hpp"
#include "epdem/thornton_ning.hpp"

using namespace epdem;

namespace {

template <class Law>
void impact(const Law& law, double R_star, bool twice) {
  double m, v, dt, gap;
  long steps;
  std::cin >> m >> v >> dt >> gap >> steps;
  typename Law::State memory{};
  double alpha = -gap, force = 0.0, most = 0.0, deepest = 0.0, least = 0.0, last = 0.0;
  long n = 0, end = -1;
  bool first = true;
  for (; n <= steps; ++n) {
    const auto now = step(law, R_star, memory, alpha, v * dt);
    if (!first) v -= 0.5 * dt / m * now.force;
    first = false;
    force = now.force;
    memory = now.after;
    if (now.radius > 0.0) {
      most = std::max(most, force);
      if (end >= 0) least = std::min(least, force);
      deepest = std::max(deepest, alpha);
      last = alpha;
      end = n;
    } else if (end >= 0 && n > end + 1) {
      if (!twice) break;
      twice = false;
      v = -v;
      most = deepest = least = force = 0.0;
      n = end = -1;
    }
    v -= 0.5 * dt / m * force;
    alpha += dt * v;
  }
  std::printf("%.17g %.17g %.17g %.17g %.17g %ld\n", n > steps ? 0.0 : -v, most, deepest, least, last, end);
}

template <class Law>
void path(const Law& law, double R_star) {
  typename Law::State memory{};
  long count;
  std::cin >> count;
  for (long k = 0; k < count; ++k) {
    double alpha;
    std::cin >> alpha;
    const auto now = step(law, R_star, memory, alpha, 0.0);
    memory = now.after;
    std::printf("%.17g %.17g %.17g ", now.force, now.radius, stored_energy(law, R_star, memory, alpha));
  }
  std::printf("\n");
}

/// Force, stored energy, and what yield and adhesion have taken so far, at prescribed overlaps.
template <class Law>
void books(const Law& law, double R_star) {
  typename Law::State memory{};
  long count;
  double plastic = 0.0, adhesive = 0.0;
  std::cin >> count;
  for (long k = 0; k < count; ++k) {
    double alpha;
    std::cin >> alpha;
    const auto now = step(law, R_star, memory, alpha, 0.0);
    const auto lost = losses(law, R_star, memory, now.after);
    memory = now.after;
    plastic += lost.plastic;
    adhesive += lost.adhesive;
    std::printf("%.17g %.17g %.17g %.17g ", now.force, stored_energy(law, R_star, memory, alpha), plastic, adhesive);
  }
  std::printf("\n");
}

template <class Law>
void plain(const Law& law, double R_star) {
  State<Law> state{};
  long count;
  std::cin >> count;
  for (long k = 0; k < count; ++k) {
    double alpha;
    std::cin >> alpha;
    const auto now = step(law, R_star, state, alpha);
    state = now.after;
    std::printf("%.17g %.17g %.17g ", now.force, now.radius, elastic_energy(law, R_star, now, alpha));
  }
  std::printf("\n");
}

}  // namespace

int main() {
  std::string what, name;
  while (std::cin >> what) {
    double E_star, R_star, numbers[] = {0.0, 0.0, 1.60, 2.8, 0.0}, of_cavity[] = {0.0, 1.60, 2.8, no_finite_strain};
    if (what == "hertz" || what == "thornton" || what == "cavity") {
      std::cin >> E_star >> R_star >> numbers[0];
      of_cavity[0] = numbers[0];
      if (what == "cavity")
        plain(Cavity(E_star, of_cavity), R_star);
      else if (what == "hertz")
        plain(Hertz(E_star, numbers), R_star);
      else
        plain(Thornton(E_star, numbers), R_star);
      continue;
    }
    std::cin >> name >> E_star >> R_star >> numbers[0] >> numbers[1] >> numbers[4];
    const Jkr<double> jkr(E_star, numbers);
    const ThorntonNing<double> ning(E_star, numbers);
    const CavityAdhesive<double> cavity(E_star, numbers);
    if (what == "gap") {
      std::printf("%.17g\n", adhesive::largest_gap(ning.c, R_star));
      continue;
    }
    if (what == "books") {
      name == "jkr" ? books(jkr, R_star) : name == "cavity_adhesive" ? books(cavity, R_star) : books(ning, R_star);
      continue;
    }
    const bool twice = what == "twice", jumps = twice || what == "impact";
    if (name == "jkr")
      jumps ? impact(jkr, R_star, twice) : path(jkr, R_star);
    else if (name == "cavity_adhesive")
      jumps ? impact(cavity, R_star, twice) : path(cavity, R_star);
    else
      jumps ? impact(ning, R_star, twice) : path(ning, R_star);
  }
}
