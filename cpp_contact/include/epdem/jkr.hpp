// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "adhesive.hpp"

namespace epdem {

/// Elastic adhesive contact (Johnson, Kendall and Roberts 1971, Proc. R. Soc. A 324, 301): F = 4 E* a^3/(3 R*) - P_t,
/// alpha = a^2/R* - d, P_t = 2 E* a d, d = sqrt(2 pi Gamma a/E*). It forms at alpha = 0 and ends at the fold,
/// alpha = -3/4 d, where d alpha/da = 0. Gamma = 0 is `hertz`.
template <class T = double>
struct Jkr {
  using number = T;
  static constexpr const char* name = "jkr";
  static constexpr int id = 44;  // of a LIGGGHTS model: restart files keep it, it never changes
  static constexpr const char* title = "elastic with adhesion";
  static constexpr const char* sources = "Johnson, Kendall and Roberts 1971";
  static constexpr const char* condition = nullptr;
  static constexpr const char* without_adhesion = "hertz";  // the law of the same bodies with Gamma = 0
  static constexpr bool yields = false;
  static constexpr bool flattens = false;
  static constexpr Parameter parameters[] = {
      {"work_of_adhesion", "workOfAdhesion", "Gamma", "J/m^2", not_given, true, true}};
  static constexpr int n_parameters = 1;
  static constexpr int strength = -1;
  static constexpr double default_ratio = not_given;
  static constexpr bool strength_by_ratio = false;

  /// History of a contact.
  struct State {
    static constexpr const char* slots[] = {"root", "jump"};
    T root{};  // (c R*)^(1/3) while the bodies are attached [m^(1/2)], else 0
    T jump{};  // what a crossing of touch or fold in the last step added to the force [N]
  };

  T E_star{};
  T c{};     // sqrt(2 pi Gamma/E*): d = c sqrt(a)
  T pull{};  // pi Gamma

  /// Whether positive, finite parameters also make sense together.
  static bool valid(const T*) noexcept { return true; }

  Jkr() = default;
  Jkr(T E_star_, const T* parameter) noexcept : E_star(E_star_), pull(pi * parameter[0]) {
    c = sqrt(2.0 * pull / E_star);
  }

  /// Work from touch to `delta` [J] while the contact grows.
  T work(T R_star, T delta) const noexcept {
    const T root = adhesive::refreshed(T{}, c * R_star),
            y = adhesive::curve(adhesive::fold_share * root, R_star * delta);
    return adhesive::energy(E_star, c, R_star, y) - adhesive::energy(E_star, c, R_star, root);
  }
};

template <class T>
inline constexpr bool adheres<Jkr<T>> = true;

/// Force and contact radius at overlap `delta` [m] (negative while apart) of a contact that remembers `before`;
/// `closing` is the closing speed at the half step times the time step [m]. Never NaN for finite input.
template <class T>
inline Step<Jkr<T>> step(const Jkr<T>& law, T R_star, const typename Jkr<T>::State& before, T delta,
                         T closing) noexcept {
  using namespace adhesive;
  const auto stood = before.root > 0.0;
  const auto forms = (before.root <= 0.0) & (delta > 0.0);
  const T cube = law.c * R_star, root = any(stood | forms) ? refreshed(before.root, cube) : before.root;
  const T y_f = fold_share * root, fold = -3.0 * y_f * y_f * y_f * y_f, X = R_star * delta;
  const auto ends = stood & (X < fold), stands = (stood & (X >= fold)) | forms;
  const T y = curve(y_f, X);
  T jump{};
  if (any(forms)) jump = select(forms, on_touch(-4.0 / 3.0 * law.pull * R_star, delta, closing), T{});
  if (any(ends)) jump = select(ends, on_parting(law.E_star, law.pull, R_star, y_f, (fold - X) / R_star, closing), jump);
  const T F = select(stands, force(law.E_star, law.c, delta, y), T{});
  return {F + jump, select(stands, y * y, T{}), {select(stands, max(root, T{} + no_root), T{}), jump}};
}

/// The radius R [m] of the curve on which a contact opens: its pull-off force is 3/2 pi Gamma R.
template <class T>
inline T opening_radius(const Jkr<T>&, T R_star, const typename Jkr<T>::State&) noexcept {
  return R_star;
}

/// The overlap [m] at which a contact that broke forms again.
template <class T>
inline T reforming_overlap(const Jkr<T>&, const typename Jkr<T>::State&) noexcept {
  return T{};
}

/// Energies that a step took for good.
template <class T>
inline adhesive::Losses<T> losses(const Jkr<T>& law, T R_star, const typename Jkr<T>::State& before,
                                  const typename Jkr<T>::State& after) noexcept {
  using namespace adhesive;
  const auto stood = before.root > 0.0, stands = after.root > 0.0;
  const T touch = select(stands & (before.root <= 0.0), energy_at_touch(law.E_star, law.c, R_star), T{});
  const T fold = select(stood & (after.root <= 0.0), energy_at_fold(law.E_star, law.c, R_star), T{});
  return {T{}, fold - touch};
}

/// Elastic and surface energy [J] of a contact at overlap `delta`, 0 for bodies apart.
template <class T>
inline T stored_energy(const Jkr<T>& law, T R_star, const typename Jkr<T>::State& now, T delta) noexcept {
  using namespace adhesive;
  const T y = curve(fold_share * now.root, R_star * delta);
  return select((now.root > 0.0) | (delta > 0.0), energy(law.E_star, law.c, R_star, y), T{});
}

}  // namespace epdem
