// SPDX-License-Identifier: GPL-2.0-or-later
// The material properties of a simulation, read from LIGGGHTS by name and checked before a law sees them.
#pragma once

#include <string>
#include <vector>

#include "epdem/backbone.hpp"

class PropertyRegistry;
namespace LAMMPS_NS {
class LAMMPS;
}

namespace epdem::liggghts {

inline std::string both(int i, int j) { return "types " + std::to_string(i) + " and " + std::to_string(j); }

/// Use of coefficientRestitution by the dashpot of the tangential model.
enum class Dashpot {
  off,       // not used
  optional,  // used if the property is there, else no dashpot
  required,  // the dashpot is the whole tangential model
};

/// Declaration of a law and its parameters.
struct Declaration {
  std::string model;  // "ep/thornton"
  const Parameter* parameters;
  int count;
  bool (*valid)(const double*);
  double (*hardening)(const double*);
  int strength;            // index of the parameter that is the strength, -1: none
  double default_ratio;    // strength over yield stress
  bool strength_by_ratio;  // yieldStress and yieldPressureRatio may stand in for it
  bool adheres;            // else a work of adhesion is refused
  bool compacts;           // it has the setting compaction
};

/// One pair of atom types.
struct PairOfTypes {
  Elastic i, j;
  std::vector<double> parameters;
  double strain_share;  // of i
  double damping_number;
  double viscous_number;
};

/// Rows and columns 1..max_type (row and column 0 are empty: LIGGGHTS counts types from 1).
struct Materials {
  int width = 0;
  std::vector<PairOfTypes> pairs;
};

/// Warns if cohesion pulls harder than the law resists: its energy density, a pressure over an area of the contact,
/// exceeds `resists` of the pair of types, row i * width + column j.
void compare_cohesion(LAMMPS_NS::LAMMPS* lmp, const std::string& model, int width, const std::vector<double>& resists);

/// Reads every type in use; a value that is missing or out of range ends the run with an error that names model,
/// property, value and range. Collective: every rank must call it.
Materials read_materials(LAMMPS_NS::LAMMPS* lmp, PropertyRegistry& registry, const Declaration& law, Dashpot dashpot,
                         bool viscous);

}  // namespace epdem::liggghts
