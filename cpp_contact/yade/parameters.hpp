// SPDX-License-Identifier: GPL-2.0-or-later
// The laws' parameters and history as attributes of YADE's classes: names, units and defaults come from the laws.
#pragma once

#include <cctype>
#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>

#include "epdem/contact.hpp"
#include "epdem/laws.hpp"
#include "epdem/range.hpp"
#include "host.hpp"

namespace epdem::in_yade {

#define EPDEM_COUNT(Class) +Class<double>::n_parameters
inline constexpr int parameter_count = 0 EPDEM_LAWS(EPDEM_COUNT);
#undef EPDEM_COUNT

/// A parameter of a law and the strength of this law; laws may share parameters.
struct LawParameter {
  const Parameter* declared = nullptr;
  const char* law = nullptr;
  const char* strength = nullptr;  // property; nullptr: the law has no strength
};

template <class Law>
constexpr void append(std::array<LawParameter, parameter_count>& all, int& at) {
  for (int k = 0; k < Law::n_parameters; ++k) {
    all[at].declared = &Law::parameters[k];
    all[at].law = Law::name;
    if constexpr (Law::strength >= 0) all[at].strength = Law::parameters[Law::strength].property;
    ++at;
  }
}

constexpr std::array<LawParameter, parameter_count> all_parameters() {
  std::array<LawParameter, parameter_count> all{};
  int at = 0;
#define EPDEM_APPEND(Class) append<Class<double>>(all, at);
  EPDEM_LAWS(EPDEM_APPEND)
#undef EPDEM_APPEND
  return all;
}
inline constexpr std::array<LawParameter, parameter_count> parameters = all_parameters();

using detail::same_text;

/// Where the value of a property is kept: at the place of its first law.
constexpr int place_of(const char* property) {
  int at = 0;
  while (!same_text(parameters[at].declared->property, property)) ++at;
  return at;
}
constexpr bool is_first(int at) { return place_of(parameters[at].declared->property) == at; }

/// Values of all parameters.
using LawValues = std::array<double, parameter_count>;

inline LawValues fallbacks() {
  LawValues values;
  for (int k = 0; k < parameter_count; ++k) values[k] = parameters[k].declared->fallback;
  return values;
}

/// The laws that read a property, as text.
inline std::string laws_with(const char* property) {
  std::string names;
  for (const LawParameter& p : parameters)
    if (same_text(p.declared->property, property)) names += (names.empty() ? "" : ", ") + std::string(p.law);
  return names;
}

template <class Law>
inline constexpr int numbers_of = int(sizeof(Law) / sizeof(double));

constexpr int most(std::initializer_list<int> sizes) {
  int largest = 0;
  for (const int size : sizes) largest = size > largest ? size : largest;
  return largest;
}

template <class... Models>
constexpr int largest_history(List<Models...>) {
  return most({values_of<Models, double>...});
}

/// Of a law with compaction: where the history of a contact has its GrowthState, and behind that its Dents.
template <class Law>
inline constexpr int growth_at = numbers_of<State<Law>>;

// Numbers in the history of a contact: of its law, of friction, of rolling friction.
inline constexpr int dent_values = sizeof(Dents<double>) / sizeof(double);
#define EPDEM_SIZE(Class) growth_at<Class<double>> + (growth_values + dent_values) * compacts<Class<double>>,
inline constexpr int law_history = most({EPDEM_LAWS(EPDEM_SIZE)});
#undef EPDEM_SIZE
inline constexpr int friction_history = largest_history(Frictions{}), rolling_history = 3;
using History = std::array<double, law_history + friction_history + rolling_history>;

/// Room for the constants of a contact; they follow from its parameters and are not saved.
#define EPDEM_SIZE(Class) numbers_of<ContactConstants<Class<double>>>,
struct Constants {
  alignas(double) std::byte bytes[sizeof(double) * most({EPDEM_LAWS(EPDEM_SIZE)})];

  template <class Law>
  ContactConstants<Law>& of() {
    return *std::launder(reinterpret_cast<ContactConstants<Law>*>(bytes));
  }
};
#undef EPDEM_SIZE

/// delta_max -> deltaMax
inline std::string camel(const std::string& name) {
  std::string text;
  for (size_t k = 0; k < name.size(); ++k) {
    if (name[k] == '_' && k + 1 < name.size())
      text += char(std::toupper(name[++k]));
    else
      text += char(std::tolower(name[k]));
  }
  return text;
}

/// Values of a parameter of one body; a strength may be infinite.
inline Range range_of_body(const Parameter& p) { return {0.0, p.below, p.may_vanish, std::isinf(p.below)}; }

/// A value that a contact cannot have, in one sentence.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[noreturn]] inline void refuse(const std::string& sentence) { throw Refusal(sentence); }

/// Pauses the simulation and raises RuntimeError in Python's main thread, in the statement that runs the simulation.
inline void raise_in_python(const std::string& sentence) {
  static std::atomic<bool> waits{false};  // of all contacts of a step one raises
  if (waits.exchange(true)) return;
  yade::Omega::instance().pause();
  Py_AddPendingCall(
      [](void* text) {
        const std::unique_ptr<std::string> owned(static_cast<std::string*>(text));
        PyErr_SetString(PyExc_RuntimeError, owned->c_str());
        waits = false;
        return -1;
      },
      new std::string("epdem_yade: " + sentence));
}

/// Result of an action of a functor, which no exception can leave, because YADE calls functors in a parallel region.
template <class Action>
bool unless_refused(const Action& action) {
  try {
    return action();
  } catch (const Refusal& refusal) {
    raise_in_python(refusal.what());
    return false;
  }
}

}  // namespace epdem::in_yade
