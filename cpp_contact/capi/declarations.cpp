// SPDX-License-Identifier: GPL-2.0-or-later
// What each law declares of itself, as one JSON text for Python and for the decks of YADE.
#include <cmath>
#include <cstdio>
#include <string>

#include "epdem.h"
#include "epdem/compaction.hpp"
#include "epdem/laws.hpp"

namespace {

using namespace epdem;

std::string json(const char* text) { return text ? '"' + std::string(text) + '"' : "null"; }
std::string json(bool truth) { return truth ? "true" : "false"; }
std::string json(int number) { return std::to_string(number); }
std::string json(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17e", number);  // always a number with a fraction
  return std::isfinite(number) ? text : "null";
}

template <class T>
std::string field(const char* name, const T& value) {
  return json(name) + ": " + json(value);
}

std::string parameter(const Parameter& p) {
  return "{" + field("name", p.name) + ", " + field("property", p.property) + ", " + field("symbol", p.symbol) + ", " +
         field("unit", p.unit) + ", " + field("default", p.fallback) + ", " + field("may_vanish", p.may_vanish) + ", " +
         field("of_pair", p.of_pair) + ", " + field("below", p.below) + "}";
}

/// Names of the values that compaction keeps behind those of the law.
template <class Law>
std::string growth_slots() {
  std::string names;
  if constexpr (compacts<Law>)
    for (const char* slot : GrowthState<double>::slots) names += (names.empty() ? "" : ", ") + json(slot);
  return names;
}

template <class Law>
std::string declaration() {
  std::string parameters;
  for (int k = 0; k < Law::n_parameters; ++k) parameters += (k ? ", " : "") + parameter(Law::parameters[k]);
  const char* const strength =
      Law::strength < 0 ? nullptr : Law::parameters[Law::strength < 0 ? 0 : Law::strength].name;
  return "{" + field("name", Law::name) + ", " + field("id", Law::id) + ", " + field("title", Law::title) + ", " +
         field("sources", Law::sources) + ", " + field("condition", static_cast<const char*>(Law::condition)) +
         ", \"parameters\": [" + parameters + "], " + field("strength", strength) + ", " +
         field("default_ratio", Law::default_ratio) + ", " + field("memory", history_size<Law>) + ", " +
         "\"growth\": [" + growth_slots<Law>() + "], " + field("yields", Law::yields) + ", " +
         field("flattens", Law::flattens) + ", " + field("adheres", adheres<Law>) + ", " +
         field("without_adhesion", without_adhesion<Law>()) + "}";
}

std::string all() {
  std::string text;
#define EPDEM_DECLARATION(Class) text += (text.empty() ? "[" : ", ") + declaration<Class<double>>();
  EPDEM_LAWS(EPDEM_DECLARATION)
#undef EPDEM_DECLARATION
  return text + "]";
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const char* epdem_declarations(void) {
  static const std::string text = all();
  return text.c_str();
}
