// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "adhesive.hpp"

namespace epdem {

/// Elastic, perfectly plastic adhesive contact: a JKR contact whose pressure is cut at p_y (Thornton and Ning 1998,
/// Powder Technol. 99, 154). With A = 2 E* a/(pi R*), B = sqrt(2 Gamma E*/(pi a)) it yields where A - B = p_y; then
/// F = pi a^2 (p_y (1 - u^2) + 2 A u^3/3 - 2 B u), u = (p_y + sqrt(p_y^2 + 4 A B))/(2 A), at the overlap a^2/R* - d.
/// It opens from a_m as a JKR contact of radius R_p = 4 E* a_m^3/(3 (F + P_t)) > R*. Gamma = 0 is `thornton`.
template <class T = double>
struct ThorntonNing {
  using number = T;
  static constexpr const char* name = "thornton_ning";
  static constexpr int id = 45;  // of a LIGGGHTS model: restart files keep it, it never changes
  static constexpr Parameter parameters[] = {
      {"work_of_adhesion", "workOfAdhesion", "J/m^2", std::numeric_limits<double>::quiet_NaN()},
      {"yield_pressure", "yieldPressure", "Pa", std::numeric_limits<double>::quiet_NaN()}};
  static constexpr int n_parameters = 2;

  /// What a contact remembers: its opening curve. One that broke inside its dent keeps all but the root.
  struct State {
    T root{};       // (c R_p)^(1/3) while the bodies are attached [m^(1/2)], else 0
    T delta_max{};  // largest overlap [m]
    T dent{};       // alpha_p [m], from which the opening curve counts its overlap; 0 before yield
    T R_open{};     // R_p [m] of a contact with a dent
  };

  T E_star, p_y;
  T c;     // sqrt(2 pi Gamma/E*): d = c sqrt(a)
  T pull;  // pi Gamma
  T B;     // B sqrt(a)
  T flat;  // pi/(2 E*): 1/A in R*/a

  ThorntonNing(T E_star_, const T* parameter) noexcept : E_star(E_star_), p_y(parameter[1]), pull(pi * parameter[0]) {
    c = sqrt(2.0 * pull / E_star);
    B = sqrt(2.0 * parameter[0] * E_star / pi);
    flat = pi / (2.0 * E_star);
  }

  /// Whether the pressure at the centre would pass p_y at y = sqrt(a).
  auto yields(T R_star, T y) const noexcept { return y * (y * y - p_y * flat * R_star) > B * flat * R_star; }

  /// F [N] of a contact that yields.
  T load(T R_star, T y) const noexcept {
    const T soft = flat * R_star, y2 = y * y;
    const T S = p_y + sqrt(p_y * p_y + 4.0 * B / soft * y);  // 2 A u
    return pi * (p_y * (y2 * y2 - S * S * soft * soft / 12.0) - 2.0 / 3.0 * B * soft * y * S);
  }
};

/// y = sqrt(a) of a growing contact at `delta` > 0: the largest root of y^4 - c R* y = R* delta, which is not smaller
/// than `y_max` >= (c R*)^(1/3) and lies between max(y_max, (R* delta)^(1/4)) and 1.23 times that. Newton's method.
template <class T>
inline T grown(const ThorntonNing<T>& law, T R_star, T y_max, T delta) noexcept {
  const T X = R_star * delta, cube = law.c * R_star;
  T y = 1.1 * max(y_max, sqrt(sqrt(X)));
  for (int k = 0; k < 5; ++k) {
    const T y3 = y * y * y;
    y = (3.0 * y3 * y + X) / (4.0 * y3 - cube);
  }
  return y;
}

/// As the step of `Jkr`. Growth moves the opening curve, and the force is always that of the opening curve, so that the
/// same step taken twice gives the same bits. A contact that broke inside its dent forms again where that curve begins;
/// one that is apart at delta <= 0 forgets.
template <class T>
inline adhesive::Step<ThorntonNing<T>> step(const ThorntonNing<T>& law, T R_star,
                                            const typename ThorntonNing<T>::State& before, T delta,
                                            T closing) noexcept {
  using namespace adhesive;
  const T zero{};
  const auto stood = before.root > 0.0, dented = before.dent > 0.0;
  T R = select(dented, before.R_open, R_star), dent = before.dent, own = delta - dent;
  const auto forms = (before.root <= 0.0) & (delta > 0.0) & (own > 0.0);
  T root = any(stood | forms) ? refreshed(before.root, law.c * R) : before.root;
  const T y_f = fold_share * root, fold = -3.0 * y_f * y_f * y_f * y_f, X = R * own;
  const auto ends = stood & (X < fold), stands = (stood & (X >= fold)) | forms;
  const auto grows = stands & (delta > before.delta_max);

  T y = curve(y_f, X), jump = -4.0 / 3.0 * law.pull * R;
  if (any(grows)) {
    T up = y;
    if (any(grows & dented)) {
      const T y_max = curve(y_f, R * (before.delta_max - dent));
      up = select(dented, grown(law, R_star, y_max, delta), y);
    }
    const auto flows = grows & law.yields(R_star, up);
    if (any(flows)) {
      const auto at_once = forms & (dent <= 0.0) & law.yields(R_star, root);
      if (any(at_once)) jump = select(at_once, law.load(R_star, root), jump);
      const T cube = up * up * up;
      R = select(flows, 4.0 / 3.0 * law.E_star * cube / (law.load(R_star, up) / cube + 2.0 * law.E_star * law.c), R);
      dent = select(flows, cube * up * (1.0 / R_star - 1.0 / R), dent);
      own = delta - dent;
      root = refreshed(root, law.c * R);
      y = curve(fold_share * root, R * own);
    }
  }
  T F = select(stands, force(law.E_star, law.c, own, y), zero);
  if (any(forms)) F += select(forms, on_touch(jump, delta - before.dent, closing), zero);
  if (any(ends)) F = select(ends, on_parting(law.E_star, law.pull, R, y_f, (fold - X) / R, closing), F);
  const auto keeps = stands | (delta > 0.0);
  const T delta_max = select(keeps, select(grows, delta, before.delta_max), zero);
  return {F,
          select(stands, y * y, zero),
          {select(stands, root, zero), delta_max, select(keeps, dent, zero), select(keeps, R, zero)}};
}

/// Elastic and surface energy [J] of a contact at overlap `delta` <= delta_max, 0 for bodies apart.
template <class T>
inline T stored_energy(const ThorntonNing<T>& law, T R_star, const typename ThorntonNing<T>::State& now,
                       T delta) noexcept {
  using namespace adhesive;
  const T R = select(now.dent > 0.0, now.R_open, R_star), own = delta - now.dent;
  const T y = curve(fold_share * now.root, R * own);
  return select((now.root > 0.0) | (own > 0.0), energy(law.E_star, law.c, R, y), T{});
}

}  // namespace epdem
