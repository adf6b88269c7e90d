// SPDX-License-Identifier: BSD-3-Clause
// One contact in one step: normal law, dashpot, adhesion, cohesion, friction, rolling friction and their energies, a
// pure function of constants, history and motion. Hosts gather and scatter; the order of a contact stands here only.
#pragma once

#include <cstddef>
#include <type_traits>

#include "adhesive.hpp"
#include "exists.hpp"
#include "grown_energies.hpp"
#include "settings.hpp"
#include "sub_models.hpp"
#include "tangential.hpp"
#include "viscous.hpp"

namespace epdem {

/// Constants of a pair of materials; numbers of one type only.
template <class Law>
struct ContactConstants {
  Number<Law> shear_modulus{};  // G* [Pa]
  Number<Law> damping{};        // damping_number of the dashpot beside friction, 0: none
  Number<Law> dashpot{};        // viscous_number of the normal dashpot, 0: none
  Number<Law> friction{};       // coefficients
  Number<Law> rolling_friction{};
  Number<Law> cohesion_density{};  // [Pa]
  Law law{};
  BodyShares<Number<Law>> bodies{};
};

/// A pair with a law alone.
template <class Law>
inline ContactConstants<Law> of_law(const Law& law) noexcept {
  ContactConstants<Law> pair;
  pair.law = law;
  return pair;
}

/// The law of a contact of unlike bodies; a call, so that other contacts keep their registers.
template <class Law, class T = Number<Law>>
[[gnu::noinline]] Law confined(const ContactConstants<Law>& pair, T R_star, T radius_i) noexcept {
  Law law = pair.law;
  law.confine(curvature_share(pair.bodies, R_star, radius_i));
  return law;
}

/// The law of a contact: that of the pair, or `own`, which few contacts set, where it depends on the radii of the
/// contact.
template <class Law, class T = Number<Law>>
EPDEM_INLINE const Law& law_at(const ContactConstants<Law>& pair, [[maybe_unused]] T R_star,
                               [[maybe_unused]] T radius_i, [[maybe_unused]] Unset<Law>& own) noexcept {
  if constexpr (is_confined<Law>) {
    const bool unlike = any(pair.law.softens()) && any(pair.bodies.strain_i != 0.5);
    if (rarely(unlike)) return own.numbers = confined(pair, R_star, radius_i);
  }
  return pair.law;
}

/// Observer that records nothing.
struct NoObserver {
  template <class... Any>
  void normal(const Any&...) const noexcept {}
  template <class Work>
  void friction(const Work&) const noexcept {}
  template <class Contact>
  void step(const Contact&) const noexcept {}
};

/// A contact without compaction.
struct NoGrowth {};

/// Energies of a step of a law without adhesion.
template <class Law>
inline NormalEnergies<Number<Law>> energies(const Law& law, Number<Law> R_star, const State<Law>& before,
                                            const Step<Law>& now, Number<Law> overlap) noexcept {
  const Number<Law> stored = elastic_energy(law, R_star, now, overlap);
  return {plastic_growth(law, R_star, before, now, stored), stored, Number<Law>{}};
}

/// The same of a law with adhesion. Many kernels call this function.
template <class Law>
[[gnu::noinline]] NormalEnergies<Number<Law>> adhesive_energies(const Law& law, Number<Law> R_star,
                                                                const State<Law>& before, const Step<Law>& now,
                                                                Number<Law> overlap) noexcept {
  const auto lost = losses(law, R_star, before, now.after);
  return {lost.plastic, stored_energy(law, R_star, now.after, overlap), lost.adhesive};
}

/// Normal force of a contact and what the models beside it read.
template <class Law>
struct NormalContact {
  Step<Law> step;
  Number<Law> overlap;  // of the law, with growth [m]
  Number<Law> force;    // [N] with the dashpot
  Number<Law> load;     // [N] friction is at most mu times it: with a bond also the pull that it stands
  Number<Law> k_n;      // [N/m] of rolling friction, F/alpha of Hertz; none across a gap
  Number<Law> k_t;      // [N/m]
  Number<Law> damping;  // of the dashpot beside friction [N s/m]
};

/// A step of the law with its dashpots; closing: closing speed at the half step times the time step [m];
/// approach_speed [m/s]; m_star() is evaluated where there is a dashpot. repeats: `before` is the history after a step
/// that is evaluated once more, with closing = 0. growth: a Growing with compaction. The observer gets the step, its
/// overlap and a function that returns the energies of the step; it may be told that nobody asks for the elastic
/// energy.
template <class Law, class Mass, class Observer = NoObserver, class Growth = NoGrowth>
inline NormalContact<Law> normal_contact(const ContactConstants<Law>& pair, Number<Law> R_star, Number<Law> radius_i,
                                         const State<Law>& before, Number<Law> overlap, Number<Law> closing,
                                         Number<Law> approach_speed, bool damped, bool viscous, Mass m_star,
                                         bool repeats = false, Observer&& observer = {},
                                         Growth&& growth = {}) noexcept {
  using T = Number<Law>;
  Unset<Law> own;
  const Law& law = law_at(pair, R_star, radius_i, own);
  NormalContact<Law> now{};
  now.overlap = overlap;
  [[maybe_unused]] T reached{}, delta_max{};  // largest overlap before the step; after it without growth
  [[maybe_unused]] T grip{};                  // pull at which a bond breaks [N]
  if constexpr (Law::yields) {
    reached = before.delta_max;
    // a host rounds positions anew between two steps; what the last step left at its largest overlap is still there
    if (repeats) overlap = select(fabs(overlap - reached) < 1e-9 * fabs(reached), reached, overlap);
  }
  if constexpr (std::is_same_v<std::decay_t<Growth>, NoGrowth>) {
    (void)growth;
    now.step = step(law, R_star, before, overlap, closing);
    observer.normal(pair, R_star, now.step, overlap, [&](bool = true) __attribute__((always_inline)) {
      if constexpr (adheres<Law>) {
        const State<Law> first = before;  // copies: what is passed by its address stays in memory
        const Step<Law> last = now.step;
        return adhesive_energies(law, R_star, first, last, overlap);
      } else {
        return energies(law, R_star, before, now.step, overlap);
      }
    });
  } else {
    const GrownStep<Law> grown = grown_step(law, pair.bodies, R_star, before, overlap, closing, growth, repeats);
    now.step = grown.step;
    now.overlap = grown.overlap;
    reached = grown.reached_grown;
    delta_max = grown.delta_max;
    grip = grown.grip;
    observer.normal(pair, R_star, now.step, now.overlap, [&](bool holds = true) __attribute__((always_inline)) {
      Unset<GrownStep<Law>> copy;  // what is passed by its address stays in memory
      copy_numbers<T, sizeof copy / sizeof(T)>(grown, copy.numbers);
      if constexpr (adheres<Law>) {
        const State<Law> first = before;
        return grown_energies(law, R_star, first, copy.numbers, overlap, closing, holds);
      } else {
        const auto peak = before.point;
        return grown_energies(law, R_star, peak, copy.numbers, overlap, closing, holds);
      }
    });
    growth.keep();
  }
  if constexpr (adheres<Law>)
    if (repeats) now.step.force = now.step.force + before.jump;
  now.force = now.step.force;
  now.k_n = 4.0 / 3.0 * law.E_star * now.step.radius;
  now.k_t = tangential_stiffness(pair.shear_modulus, now.step.radius);
  now.damping = T{};
  if (damped || viscous) {
    const T mass = m_star();
    if (viscous)
      now.force =
          damped_force(law, R_star, reached, now.step, pair.dashpot, mass, approach_speed, now.overlap, repeats);
    now.damping = tangential_damping(pair.damping, now.k_t, mass);
  }
  now.load = sliding_load(law, R_star, now.step, now.force);
  if constexpr (adheres<Law>) now.k_n = select(overlap > 0.0, now.k_n, T{});
  if constexpr (!std::is_same_v<std::decay_t<Growth>, NoGrowth>) {
    now.step.after.delta_max = delta_max;
    now.load = now.load + grip;
  }
  return now;
}

/// Input of friction from a step of a law; `load` is the force that limits it.
template <class Law>
EPDEM_INLINE Pressed<Number<Law>> pressed_by(const Step<Law>& now, const Number<Law>& load) noexcept {
  if constexpr (Law::flattens) return {load, now.radius, now.after.point.radius, now.after.point.flatness};
  return {load, now.radius, now.radius, Number<Law>{}};
}

/// A sliding contact in a step of length dt [s], in which it turns by `turn` about its normal [rad].
template <class Law>
EPDEM_INLINE Sliding<Number<Law>> sliding_of(const ContactConstants<Law>& pair, const NormalContact<Law>& now,
                                             const Vec<Number<Law>>& normal, const Vec<Number<Law>>& velocity,
                                             Number<Law> turn, double dt, bool damped, bool keeps = true) noexcept {
  return {pressed_by<Law>(now.step, now.load),
          normal,
          velocity,
          dt * velocity,
          turn,
          pair.friction,
          8.0 * pair.shear_modulus,
          now.k_t,
          now.damping,
          1.0 / dt * now.damping,
          damped,
          keeps};
}

/// The history of a contact: the values of the law, then the values of the models beside the law. RollingHistory
/// converts to a vector and takes one; rolling friction with a history reads and writes it, other models leave it
/// alone. Growth: a Growing with compaction.
template <class Law, class Friction, class RollingHistory = Vec<Number<Law>>, class Growth = NoGrowth>
struct ContactHistory {
  State<Law> law{};
  typename Friction::template History<Number<Law>> friction{};
  RollingHistory rolling{};
  Growth growth{};
};

/// Forces and torques of a contact [N], [N m]; the force on j is the negative of that on i.
template <class T>
struct ContactLoads {
  Vec<T> force, torque_i, torque_j;
};

namespace detail {

/// Where the bodies are attached; everywhere without adhesion.
template <class Law>
EPDEM_INLINE auto attached(const State<Law>& before) noexcept {
  if constexpr (adheres<Law>)
    return before.root > 0.0;
  else
    return true;
}

}  // namespace detail

/// One contact. `history` holds the values before the step, then the values after the step.
template <class Friction, bool wall, class Law, class RollingHistory, class Growth, class Mass, class Observer>
inline ContactLoads<Number<Law>> contact(const ContactConstants<Law>& pair, const ContactSettings& settings,
                                         const Kinematics<Number<Law>>& c,
                                         ContactHistory<Law, Friction, RollingHistory, Growth>& history, Mass m_star,
                                         Observer&& observer) noexcept {
  using T = Number<Law>;
  // bodies that touch without being attached begin anew in the models beside the law
  [[maybe_unused]] const auto attached = detail::attached<Law>(history.law);
  if constexpr (adheres<Law>) keep_where<T>(attached, history.friction);
  if constexpr (!std::is_same_v<Growth, NoGrowth>)
    history.growth.bond = settings.cohesion == bond_place ? pair.cohesion_density : T{};
  NormalContact<Law> now = normal_contact(pair, c.R_star, c.radius_i, history.law, c.overlap,
                                          T(-c.normal_velocity * settings.dt), -c.normal_velocity, settings.damped,
                                          settings.viscous, m_star, settings.repeats, observer, history.growth);
  history.law = now.step.after;

  ContactLoads<T> loads{now.force * c.normal, {}, {}};
  if constexpr (!adheres<Law>)
    if (settings.cohesion != 0) {
      T pull{};
      Cohesions::each([&](auto model, int place) __attribute__((always_inline)) {
        if (place == settings.cohesion) pull = decltype(model)::template force<wall>(c, pair.cohesion_density);
      });
      if (settings.cohesion_slides) now.load = now.load + pull;
      loads.force = loads.force + pull * c.normal;
    }

  if constexpr (!std::is_same_v<Friction, NoFriction>) {
    const T turn = 0.5 * settings.dt * dot(c.normal, c.spin);
    const auto sliding =
        sliding_of(pair, now, c.normal, c.slip_velocity, turn, settings.dt, settings.damped, !settings.repeats);
    const Vec<T> F = Friction::template force<Law::flattens>(sliding, history.friction, observer);
    const Vec<T> lever = cross(c.normal, F);
    loads.force = loads.force + F;
    loads.torque_i = -c.arm_i * lever;
    if constexpr (!wall) loads.torque_j = -c.arm_j * lever;
  }

  if (rarely(settings.rolling != 0)) {
    const epdem::Rolling<T> rolling{c.normal,    c.rolling,       c.R_star, now.overlap,
                                    now.load,    now.k_n,         now.k_t,  pair.rolling_friction,
                                    settings.dt, settings.torsion};
    Rollings::each([&](auto model, int place) __attribute__((always_inline)) {
      using Model = decltype(model);
      if constexpr (!std::is_same_v<Model, NoRolling>)
        if (place == settings.rolling) {
          Vec<T> kept{};
          if constexpr (Model::has_history) kept = history.rolling;
          if constexpr (Model::has_history && adheres<Law>) keep_where<T>(attached, kept);
          const Vec<T> torque = Model::template torque<wall>(rolling, kept);
          if constexpr (Model::has_history) history.rolling = kept;
          loads.torque_i = loads.torque_i - torque;
          loads.torque_j = loads.torque_j + torque;
        }
    });
  }
  return loads;
}

}  // namespace epdem
