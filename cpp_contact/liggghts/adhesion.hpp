// SPDX-License-Identifier: GPL-2.0-or-later
// The work of adhesion of pairs of types, and what a deck must not ask of adhesion and cohesion.
#pragma once

#include "comm.h"
#include "epdem/adhesive.hpp"
#include "epdem/laws.hpp"
#include "force.h"
#include "reader.hpp"

namespace epdem::liggghts {

inline constexpr const char* adhesion_name = "workOfAdhesion";  // of a pair of types [J/m^2]
inline constexpr const char* surface_name = "surfaceEnergy";    // of a type [J/m^2]

/// Work of adhesion of every pair of types [J/m^2]: as given, or twice the geometric mean of the surface energies.
class Adhesion {
 public:
  explicit Adhesion(const Reader& reader) : reader_(reader), pairs_(reader.find(adhesion_name, "peratomtypepair")) {
    const bool energy = reader.given(surface_name);
    if (energy && reader.given(adhesion_name))
      reader.fail(std::string("both ") + adhesion_name + " and " + surface_name + " are given; keep one");
    if (energy) surface_ = reader.per_type(surface_name, "J/m^2", range);
    if (!energy && !pairs_)
      reader.fail(std::string("property ") + adhesion_name +
                  " [J/m^2] is missing; give one value per pair of atom types: fix ID all property/global " +
                  adhesion_name + " peratomtypepair NTYPES VALUE ... (or " + surface_name +
                  " peratomtype gamma ..., of which it is twice the geometric mean)");
  }

  double at(int i, int j) const {
    if (!pairs_) return adhesive::work_of_adhesion(surface_[i], surface_[j]);
    return reader_.of_pair(pairs_, adhesion_name, "J/m^2", i, j, range);
  }

 private:
  static constexpr Range range{0.0, unlimited, true};
  const Reader& reader_;
  FixPropertyGlobal* const pairs_;
  std::vector<double> surface_;
};

/// Advice for a law without adhesion: the model with adhesion for the same bodies, else all models with adhesion.
inline std::string models_with_adhesion(const std::string& model) {
  std::string all, own;
#define EPDEM_ADHESIVE(Class)                                                        \
  if constexpr (adheres<Class<double>>) {                                            \
    const std::string name = std::string("ep/") + Class<double>::name;               \
    all += (all.empty() ? "" : " or ") + name;                                       \
    if (model == std::string("ep/") + without_adhesion<Class<double>>()) own = name; \
  }
  EPDEM_LAWS(EPDEM_ADHESIVE)
#undef EPDEM_ADHESIVE
  return own.empty() ? "no theory of adhesion exists for it, take " + all : "take " + own;
}

/// A law without adhesion beside a deck that asks for it.
inline void refuse_adhesion(const Reader& reader, const Declaration& law) {
  for (const char* name : {adhesion_name, surface_name})
    if (reader.given(name))
      reader.fail(std::string(name) + " is given, but this law has no adhesion; " + models_with_adhesion(law.model) +
                  ", or remove the property");
}

}  // namespace epdem::liggghts
