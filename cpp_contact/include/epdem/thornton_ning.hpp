// SPDX-License-Identifier: BSD-3-Clause
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
  static constexpr const char* title = "elastic, perfectly plastic with adhesion";
  static constexpr const char* sources = "Thornton and Ning 1998";
  static constexpr const char* condition = nullptr;
  static constexpr const char* without_adhesion = "thornton";  // the law of the same bodies with Gamma = 0
  static constexpr bool yields = true;
  static constexpr bool flattens = false;
  static constexpr Parameter parameters[] = {
      {"work_of_adhesion", "workOfAdhesion", "Gamma", "J/m^2", not_given, true, true},
      {"yield_pressure", "yieldPressure", "p_y", "Pa", not_given}};
  static constexpr int n_parameters = 2;
  static constexpr int strength = 1;
  static constexpr double default_ratio = 2.8;
  static constexpr bool strength_by_ratio = true;

  /// History of a contact: its opening curve. One that broke inside its dent keeps all but the root.
  struct State {
    static constexpr const char* slots[] = {"delta_max", "root", "dent", "R_open", "jump"};
    T delta_max{};  // largest overlap [m]
    T root{};       // (c R_p)^(1/3) while the bodies are attached [m^(1/2)], else 0
    T dent{};       // alpha_p [m], from which the opening curve counts its overlap; 0 before yield
    T R_open{};     // R_p [m] of a contact with a dent
    T jump{};       // what a crossing of touch or fold in the last step added to the force [N]
  };

  T E_star{}, p_y{};
  T c{};     // sqrt(2 pi Gamma/E*): d = c sqrt(a)
  T pull{};  // pi Gamma
  T B{};     // B sqrt(a)
  T flat{};  // pi/(2 E*): 1/A in R*/a

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const T*) noexcept { return true; }

  ThorntonNing() = default;
  ThorntonNing(T E_star_, const T* parameter) noexcept : E_star(E_star_), p_y(parameter[1]), pull(pi * parameter[0]) {
    c = sqrt(2.0 * pull / E_star);
    B = sqrt(2.0 * parameter[0] * E_star / pi);
    flat = pi / (2.0 * E_star);
  }

  /// Whether the pressure at the centre would pass p_y at y = sqrt(a).
  auto yields_at(T R_star, T y) const noexcept { return y * (y * y - p_y * flat * R_star) > B * flat * R_star; }

  /// F [N] of a contact that yields.
  T load(T R_star, T y) const noexcept {
    const T soft = flat * R_star, y2 = y * y;
    const T S = p_y + sqrt(p_y * p_y + 4.0 * B / soft * y);  // 2 A u
    return pi * (p_y * (y2 * y2 - S * S * soft * soft / 12.0) - 2.0 / 3.0 * B * soft * y * S);
  }

  /// R_p [m] of the curve on which a contact opens that has yielded up to y.
  T opening(T R_star, T y) const noexcept {
    const T cube = y * y * y;
    return 4.0 / 3.0 * E_star * cube * cube / (load(R_star, y) + 2.0 * E_star * c * cube);
  }

  /// y = sqrt(a) at which the contact yields: the root of y (y^2 - p_y soft) = B soft, by Newton's method from above.
  T yield_root(T R_star) const noexcept {
    const T q = p_y * flat * R_star, r = B * flat * R_star;
    T y = max(sqrt(2.0 * q), cbrt(2.0 * r));
    for (int k = 0; k < 12; ++k) y = (2.0 * y * y * y + r) / (3.0 * y * y - q);
    return y;
  }

  /// Work [J] of the force of yield between y = low and high >= low.
  /// Gauss's rule of 8 points is exact, for the core pressure going straight makes it a polynomial of degree 15.
  T yield_work(T R_star, T low, T high) const noexcept {
    constexpr double node[] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623};
    constexpr double weight[] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447, 0.10122853629037626};
    const T steep = 4.0 * B / (flat * R_star);
    const T first = sqrt(p_y * p_y + steep * low), last = sqrt(p_y * p_y + steep * high);
    const T D = (high - low) / (first + last), rise = steep * D;
    T sum{};
    for (int k = 0; k < 8; ++k) {
      const double t = 0.5 + (k < 4 ? 0.5 : -0.5) * node[k % 4];
      const T y = low + D * t * (2.0 * first + rise * t), slope = (4.0 * y * y * y / R_star - c) * 2.0 * D;
      sum += 0.5 * weight[k % 4] * load(R_star, y) * slope * (first + rise * t);
    }
    return sum;
  }

  /// Work from touch to `delta` [J] while the contact grows.
  T work(T R_star, T delta) const noexcept {
    const T touch = adhesive::refreshed(T{}, c * R_star), start = yield_root(R_star);
    const T y = adhesive::curve(adhesive::fold_share * touch, R_star * delta);
    const T elastic = min(max(start, touch), max(y, touch));
    return adhesive::energy(E_star, c, R_star, elastic) - adhesive::energy(E_star, c, R_star, touch) +
           yield_work(R_star, elastic, max(y, elastic));
  }
};

template <class T>
inline constexpr bool adheres<ThorntonNing<T>> = true;

/// Whether (R* delta)^(1/4) is larger than (c R*)^(1/3).
template <class T>
inline auto is_wide(const ThorntonNing<T>& law, T R_star, T delta) noexcept {
  const T X = R_star * delta, cube = law.c * R_star;
  return X * X * X > (cube * cube) * (cube * cube);
}

/// y = sqrt(a) of a growing contact at `delta` > 0: the largest root of y^4 - c R* y = R* delta. It lies between
/// b = max((c R*)^(1/3), (R* delta)^(1/4)) and 1.23 b. `root` is (c R)^(1/3) of the curve on which the contact opens,
/// from which one step of Halley's method gives (c R*)^(1/3) to 1 % wherever it is larger than (R* delta)^(1/4). From
/// there three steps of Halley's method (of third order) lead to round-off. The bits of a wide contact do not depend
/// on R and root.
template <class T, class M>
inline T grown(const ThorntonNing<T>& law, T R_star, T R, T root, T delta, M wide) noexcept {
  const T X = R_star * delta, cube = law.c * R_star, s = sqrt(sqrt(X));
  T y = 1.1 * select(wide, s, max(root * ((R + 2.0 * R_star) / (2.0 * R + R_star)), s));
  for (int k = 0; k < 3; ++k) {
    const T y2 = y * y, y3 = y2 * y, f = y * (y3 - cube) - X, slope = 4.0 * y3 - cube;
    y = y - f * slope / (slope * slope - 6.0 * y2 * f);
  }
  return y;
}

/// As the step of `Jkr`. Growth moves the opening curve, and the force is always the force of the opening curve. Where
/// this curve begins, y is the y of growth: a wide contact takes it from there, which saves the curve, in the step of
/// growth and in the same step taken again, so that both give the same bits. A contact that broke inside its dent forms
/// again where that curve begins; the history is cleared when separated and delta <= 0.
template <class T>
inline Step<ThorntonNing<T>> step(const ThorntonNing<T>& law, T R_star, const typename ThorntonNing<T>::State& before,
                                  T delta, T closing) noexcept {
  using namespace adhesive;
  const T zero{};
  const auto stood = before.root > 0.0;
  // else the memory of another law; the dent of a contact that its attraction makes yield is above its overlap
  const auto dented = (before.dent > 0.0) & (before.dent < no_overlap) & (before.delta_max < no_overlap) &
                      (before.R_open >= R_star) & (before.R_open < no_overlap);
  T R = select(dented, before.R_open, R_star), dent = select(dented, before.dent, zero), own = delta - dent;
  const auto forms = (before.root <= 0.0) & (delta > 0.0) & (own > 0.0);
  T root = any(stood | forms) ? refreshed(before.root, law.c * R) : before.root;
  const T y_f = fold_share * root, fold = -3.0 * y_f * y_f * y_f * y_f, X = R * own;
  const auto ends = stood & (X < fold), stands = (stood & (X >= fold)) | forms;
  const auto grows = stands & (delta > before.delta_max);

  T y{}, up{}, at_touch = -4.0 / 3.0 * law.pull * R;
  const auto wide = is_wide(law, R_star, delta);
  auto peak = stands & dented & (delta >= before.delta_max);
  if (any(peak)) {
    up = grown(law, R_star, R, root, delta, wide);
    peak = peak & law.yields_at(R_star, up);
  }
  auto flows = peak & grows;
  if (any(!(peak & wide))) {
    y = curve(y_f, X);
    const auto first = grows & !dented & law.yields_at(R_star, y);
    if (any(first)) up = select(first, select(wide, grown(law, R_star, R, root, delta, wide), y), up);
    flows = flows | first;
  }
  if (any(flows)) {
    const auto at_once = forms & (dent <= 0.0) & law.yields_at(R_star, root);
    if (any(at_once)) at_touch = select(at_once, law.load(R_star, root), at_touch);
    R = select(flows, law.opening(R_star, up), R);
    dent = select(flows, up * up * up * up * ((R - R_star) / (R * R_star)), dent);
    own = delta - dent;
    root = refreshed(root, law.c * R);
    if (any(flows & !wide)) y = select(flows, curve(fold_share * root, R * own), y);
  }
  y = select((peak | flows) & wide, up, y);
  T jump{};
  if (any(forms)) jump = select(forms, on_touch(at_touch, delta - before.dent, closing), zero);
  if (any(ends)) jump = select(ends, on_parting(law.E_star, law.pull, R, y_f, (fold - X) / R, closing), jump);
  const T F = select(stands, force(law.E_star, law.c, own, y), zero);
  const auto keeps = stands | (delta > 0.0);
  return {F + jump,
          select(stands, y * y, zero),
          {select(keeps, select(grows, delta, before.delta_max), zero), select(stands, max(root, zero + no_root), zero),
           select(keeps, dent, zero), select(keeps, R, zero), jump}};
}

/// Work lost by yield [J] of a contact with this memory: what loading took from a_y (or from touch, if the attraction
/// makes it yield at once), less what is stored at the largest overlap.
template <class T>
inline T plastic_work(const ThorntonNing<T>& law, T R_star, const typename ThorntonNing<T>::State& now) noexcept {
  using namespace adhesive;
  const auto dented = now.dent > 0.0;
  if (!any(dented)) return T{};
  const T E = law.E_star, touch = refreshed(T{}, law.c * R_star), yield = law.yield_root(R_star);
  const T start = max(yield, touch);
  const T R = select(dented, now.R_open, R_star), root = refreshed(T{}, law.c * R);
  const T y = max(curve(fold_share * root, R * (now.delta_max - now.dent)), start);
  const T from = select(yield < touch, law.opening(R_star, touch), R_star);
  const T stored = energy(E, law.c, R, y) - energy(E, law.c, from, start);
  return select(dented, max(law.yield_work(R_star, start, y) - stored, T{}), T{});
}

/// Energies that a step took for good.
template <class T>
inline adhesive::Losses<T> losses(const ThorntonNing<T>& law, T R_star, const typename ThorntonNing<T>::State& before,
                                  const typename ThorntonNing<T>::State& after) noexcept {
  using namespace adhesive;
  const auto stood = before.root > 0.0, stands = after.root > 0.0, dented = before.dent > 0.0;
  const T E = law.E_star, c = law.c, R = select(dented, before.R_open, R_star);
  T adhesive{};
  const auto forms = stands & (before.root <= 0.0), ends = stood & (after.root <= 0.0);
  if (any(forms)) {
    const T root = refreshed(T{}, c * R_star);
    const auto at_once = (before.dent <= 0.0) & (after.dent > 0.0) & law.yields_at(R_star, root);
    T first = R;
    if (any(at_once)) first = select(at_once, law.opening(R_star, root), R);
    // what yields at once does so on the curve of R_p, but at the contact radius of touch
    const T y = select(at_once, root, refreshed(T{}, c * R));
    adhesive = select(forms, -energy(E, c, first, y), adhesive);
  }
  if (any(ends)) adhesive = select(ends, energy_at_fold(E, c, R), adhesive);
  return {plastic_work_of_step(law, R_star, before, after), adhesive};
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
