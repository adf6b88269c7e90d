// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "adhesive.hpp"

namespace epdem {

/// Elastic, perfectly plastic adhesive contact: a JKR contact whose pressure is cut at p_y (Thornton and Ning 1998, Powder
/// Technol. 99, 154). With A = 2 E* a/(pi R*), B = sqrt(2 Gamma E*/(pi a)) it yields where A - B = p_y; then
/// F = pi a^2 (p_y (1 - u^2) + 2 A u^3/3 - 2 B u), u = (p_y + sqrt(p_y^2 + 4 A B))/(2 A), at the same overlap a^2/R* - d.
/// It opens from a_m as a JKR contact of radius R_p = 4 E* a_m^3/(3 (F + P_t)) > R*. Gamma = 0 is `thornton`.
template <class T = real>
struct ThorntonNing {
  static constexpr const char* name = "thornton_ning";
  static constexpr Parameter parameters[] = {
      {"work_of_adhesion", "workOfAdhesion", "J/m^2", std::numeric_limits<real>::quiet_NaN()},
      {"yield_pressure", "yieldPressure", "Pa", std::numeric_limits<real>::quiet_NaN()}};
  static constexpr int n_parameters = 2;

  /// What an opening contact needs. A contact that broke inside its dent keeps all but the root.
  struct Memory {
    T root{};       // (c R_p)^(1/3) while the bodies are attached [m^(1/2)], else 0
    T delta_max{};  // largest overlap [m]
    T y_max{};      // sqrt(a) there
    T R_open{};     // R_p [m]
  };

  T E_star, p_y;
  T c;     // sqrt(2 pi Gamma/E*): d = c sqrt(a)
  T pull;  // pi Gamma
  T B;     // B sqrt(a)
  T flat;  // pi/(2 E*): 1/A in R*/a

  ThorntonNing(T E_star_, const T* parameter) noexcept : E_star(E_star_), p_y(parameter[1]), pull(pi * parameter[0]) {
    using std::sqrt;
    c = sqrt(2.0 * pull / E_star);
    B = sqrt(2.0 * parameter[0] * E_star / pi);
    flat = pi / (2.0 * E_star);
  }

  /// Whether the pressure at the centre would pass p_y at y = sqrt(a).
  auto yields(T R_star, T y) const noexcept { return y * (y * y - p_y * flat * R_star) > B * flat * R_star; }

  /// F [N] while the contact grows.
  T load(T R_star, T y) const noexcept {
    using std::sqrt;
    const T soft = flat * R_star, y2 = y * y;
    const T S = p_y + sqrt(p_y * p_y + 4.0 * B / soft * y);  // 2 A u
    const T plastic = pi * (p_y * (y2 * y2 - S * S * soft * soft / 12.0) - 2.0 / 3.0 * B * soft * y * S);
    return adhesive::select(yields(R_star, y), plastic, adhesive::force(E_star, c, R_star, y));
  }
};

/// y = sqrt(a) of a growing contact at `delta` > 0: the largest root of y^4 - c R* y = R* delta, which is not smaller than
/// `y_max` >= (c R*)^(1/3) and lies between max(y_max, (R* delta)^(1/4)) and 1.23 times that. Newton's method.
template <class T>
inline T grown(const ThorntonNing<T>& law, T R_star, T y_max, T delta) noexcept {
  using std::sqrt;
  const T X = R_star * delta, cube = law.c * R_star;
  T y = 1.1 * adhesive::max(y_max, sqrt(sqrt(X)));
  for (int k = 0; k < 5; ++k) {
    const T y3 = y * y * y;
    y = (3.0 * y3 * y + X) / (4.0 * y3 - cube);
  }
  return y;
}

/// As the step of `Jkr`. A contact that broke inside its dent forms again where its opening curve passes 0; one that is apart
/// at delta <= 0 forgets.
template <class T>
inline adhesive::Step<T, typename ThorntonNing<T>::Memory> step(const ThorntonNing<T>& law, T R_star,
                                                                const typename ThorntonNing<T>::Memory& before, T delta,
                                                                T closing) noexcept {
  using namespace adhesive;
  const T zero{}, y_m = before.y_max, y_m3 = y_m * y_m * y_m;
  const auto stood = before.root > 0.0, known = y_m > 0.0;
  const auto dented = known & law.yields(R_star, y_m);
  const T R = select(dented, before.R_open, R_star), top = select(known, before.delta_max, zero);
  // overlap since the opening curve's own touch
  const T own = select(dented, (y_m3 / R - law.c) * y_m - (top - delta), delta);
  const auto forms = (before.root <= 0.0) & (delta > 0.0) & (own > 0.0);
  const T root = any(stood | forms) ? refreshed(before.root, law.c * R) : before.root;
  const T y_f = fold_share * root, fold = -3.0 * y_f * y_f * y_f * y_f, X = R * own;
  const auto ends = stood & (X < fold), stands = (stood & (X >= fold)) | forms;
  const auto grows = stands & (delta >= top), wins = stands & (delta > top);

  T y = curve(y_f, X), F = force(law.E_star, law.c, R, y), y_max = select(known, y_m, zero), R_open = R;
  if (any(grows)) {
    const T first = select(known, y_m, root), up = select(wins, grown(law, R_star, first, delta), y_m);
    const T cube = up * up * up, load = law.load(R_star, up);
    y = select(grows, up, y);
    F = select(grows, load, F);
    if (any(wins)) {
      const T flat = 4.0 / 3.0 * law.E_star * cube * cube / (load + 2.0 * law.E_star * law.c * cube);
      y_max = select(wins, up, y_max);
      R_open = select(wins, select(law.yields(R_star, up), flat, R_star), R_open);
    }
  }
  if (any(forms)) {
    const T jump = select(dented, -4.0 / 3.0 * law.pull * R, law.load(R_star, root));
    F += select(forms, on_touch(jump, own, closing), zero);
  }
  F = select(stands, F, zero);
  if (any(ends)) F = select(ends, on_parting(law.E_star, law.pull, R, y_f, (fold - X) / R, closing), F);
  const auto keeps = stands | (delta > 0.0);
  return {F, select(stands, y * y, zero),
          {select(stands, root, zero), select(keeps, select(wins, delta, top), zero), select(keeps, y_max, zero),
           select(keeps, R_open, zero)}};
}

}  // namespace epdem
