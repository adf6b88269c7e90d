// SPDX-License-Identifier: BSD-3-Clause
// One contact of two bodies whose motion is prescribed: every step of it counts.
#pragma once

#include <utility>

#include "contact.hpp"

namespace epdem {

/// Motion of the bodies in one step.
template <class T>
struct MotionStep {
  T overlap;  // [m]
  T closing;  // closing speed times the time step [m]
  Vec<T> normal;
  Vec<T> slip;  // relative tangential displacement of the surfaces [m]
  T turn;       // rotation about the normal, mean of both bodies [rad]
};

/// A contact that keeps the history of its law and of its friction.
template <class Friction, class Law>
class MovedContact {
  using T = Number<Law>;

 public:
  MovedContact(const ContactConstants<Law>& pair, T R_star) : pair_(pair), R_star_(R_star) {}

  /// (normal force [N], friction on the body that the normal points to [N]) of the next step.
  std::pair<T, Vec<T>> operator()(const MotionStep<T>& motion) noexcept {
    if (!attached(motion.overlap)) {
      friction_ = {};
      if constexpr (!adheres<Law>) state_ = {};
    }
    const NormalContact<Law> now = normal_contact(pair_, R_star_, R_star_, state_, motion.overlap, motion.closing, T{},
                                                  false, false, [] { return T{}; });
    state_ = now.step.after;
    if (!(now.step.radius > 0.0 || motion.overlap > 0.0)) return {now.force, {}};
    // velocities are displacements in a step of length 1
    const auto sliding = sliding_of(pair_, now, motion.normal, motion.slip, motion.turn, 1.0, false);
    return {now.force, Friction::template force<Law::flattens>(sliding, friction_, NoObserver{})};
  }

 private:
  /// Whether the contact of the step before goes on.
  bool attached(T overlap) const noexcept {
    if constexpr (adheres<Law>) return state_.root > 0.0;
    return overlap > 0.0;
  }

  const ContactConstants<Law> pair_;
  const T R_star_;
  State<Law> state_{};
  typename Friction::template History<T> friction_{};
};

}  // namespace epdem
