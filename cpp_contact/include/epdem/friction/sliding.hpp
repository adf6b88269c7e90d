// SPDX-License-Identifier: BSD-3-Clause
// Input of a friction model. A model is a header beside this one and a line in sub_models.hpp:
//   name, id          of LIGGGHTS's tangential_model; restart files keep the id
//   of_liggghts       LIGGGHTS has a class of the model
//   adds_work        `force` gives the work of friction to the observer
//   History<T>        values of a contact, all of type T; they change their sign when the bodies change places
//   even_values       the number of values at the end of History that keep their sign
//   force<flattens>(sliding, history, observer)
//                     friction on i [N]; history before and after
#pragma once

#include <type_traits>

#include "../vec.hpp"

namespace epdem {

/// Results of the normal law in this step.
template <class T>
struct Pressed {
  T load;        // [N] friction is at most mu times it: F; F + 2 P_po for a law with pull-off force P_po
  T radius;      // contact radius a [m]
  T radius_max;  // contact radius at the largest overlap [m]; laws that flatten read it
  T flatness;    // tau at the largest overlap
};

template <class T>
struct Sliding {
  Pressed<T> pressed;
  Vec<T> normal;
  Vec<T> velocity;     // of the surfaces against each other [m/s]
  Vec<T> slip;         // velocity times the time step [m]
  T turn;              // rotation about the normal, mean of both bodies [rad]
  T mu;                // coefficient of friction
  T stiffness;         // 8 G* [Pa]
  T k_t;               // 8 G* a [N/m]
  T damping;           // of the dashpot [N s/m]
  T damping_per_step;  // over the time step [N/m]
  bool damped;         // whether there may be a dashpot
  bool keeps;          // the host stores the history of this step; else the last step is evaluated once more
};

/// Work that friction took in a step and elastic energy of its springs [J].
template <class T>
struct FrictionWork {
  T lost, stored;
};

/// How many values a contact keeps for a model.
template <class Model, class T>
inline constexpr int values_of =
    std::is_empty_v<typename Model::template History<T>> ? 0
                                                         : int(sizeof(typename Model::template History<T>) / sizeof(T));

/// Whether a vector of this square may be longer than its limit, without a root.
template <class T>
EPDEM_INLINE bool near_limit(const T& square, const T& limit) noexcept {
  return any(!(square <= 0.9 * limit * limit));
}

/// A vector, shortened so that `unit` times its length is at most `limit`.
template <class T>
EPDEM_INLINE Vec<T> limited(const Vec<T>& s, const T& unit, const T& limit) noexcept {
  const T square = unit * unit * dot(s, s);
  const auto over = square > limit * limit;
  return any(over) ? select(over, limit / sqrt(square), T{} + 1.0) * s : s;
}

/// Friction [N] of a spring within the limit `most` and a dashpot [N s/m] beside it, inside the same limit.
template <class T>
EPDEM_INLINE Vec<T> with_dashpot(const Vec<T>& spring, const T& damping, const Vec<T>& velocity,
                                 const T& most) noexcept {
  return limited(spring - damping * velocity, T{} + 1.0, most);
}

/// tangential off.
struct NoFriction {
  static constexpr const char* name = "off";
  static constexpr int id = 0, even_values = 0;
  static constexpr bool of_liggghts = true, adds_work = false;
  template <class T>
  struct History {};
  template <bool flattens, class T, class Observer>
  EPDEM_INLINE static Vec<T> force(const Sliding<T>&, History<T>&, Observer&&) noexcept {
    return {};
  }
};

}  // namespace epdem
