// SPDX-License-Identifier: GPL-2.0-or-later
// One contact of two bodies whose motion is prescribed: every step of it counts.
#pragma once

#include "friction.hpp"

namespace epdem {

/// What the bodies do in one step; the field `damping` of `shear` is not read.
template <class T>
struct MotionStep {
  T overlap;  // [m]
  T closing;  // closing speed times the time step [m]
  Shear<T> shear;
};

/// A contact that remembers what its law and its friction do. stiffness = 8 G* [Pa].
template <int nodes, class Law>
class MovedContact {
  using T = Number<Law>;

 public:
  MovedContact(const Law& law, T R_star, T stiffness, T mu)
      : law_(law), R_star_(R_star), stiffness_(stiffness), mu_(mu) {}

  /// (normal force [N], friction on the body that the normal points to [N]) of the next step.
  std::pair<T, Vec<T>> operator()(const MotionStep<T>& motion) noexcept {
    if (!attached(motion.overlap)) {
      friction_ = {};
      if constexpr (!adheres<Law>) state_ = {};
    }
    const Step<Law> now = step(law_, R_star_, state_, motion.overlap, motion.closing);
    state_ = now.after;
    if (!(now.radius > 0.0 || motion.overlap > 0.0)) return {now.force, {}};
    const T load = sliding_load(law_, R_star_, now, now.force);
    return {now.force, friction_(pressed_by<Law>(now, load), motion.shear, stiffness_, mu_)};
  }

 private:
  /// Whether the contact of the step before goes on.
  bool attached(T overlap) const noexcept {
    if constexpr (adheres<Law>) return state_.root > 0.0;
    return overlap > 0.0;
  }

  const Law& law_;
  T R_star_, stiffness_, mu_;
  State<Law> state_{};
  Friction<nodes, Law> friction_{};
};

}  // namespace epdem
