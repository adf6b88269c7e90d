// SPDX-License-Identifier: GPL-2.0-or-later
// The properties of a deck by name, each value checked against its range.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "epdem/range.hpp"
#include "error.h"
#include "fix_property_global.h"
#include "lammps.h"
#include "materials.hpp"
#include "modify.h"
#include "property_registry.h"
#include "update.h"

namespace epdem::liggghts {

class Reader {
 public:
  Reader(LAMMPS_NS::LAMMPS* lmp, PropertyRegistry& registry, const Declaration& law)
      : lmp_(lmp), law_(law), n_(registry.max_type()) {}

  int types() const { return n_; }

  /// How a message names the unit of a property: as declared in SI, by the style of the deck's units in other ones.
  std::string unit_of(const char* unit) const {
    if (std::string(unit) == "1") return "";
    const std::string style = lmp_->update->unit_style;
    return " [" + (style == "si" ? unit : "units " + style) + "]";
  }

  [[noreturn]] void fail(const std::string& what) const {
    lmp_->error->all(FLERR, ("model " + law_.model + ": " + what).c_str());
    std::abort();  // not reached: error->all ends the run
  }

  FixPropertyGlobal* find(const char* name, const char* style) const {
    const int rows = style[0] == 's' ? 0 : n_, columns = std::string(style) == "peratomtypepair" ? n_ : 0;
    return static_cast<FixPropertyGlobal*>(
        lmp_->modify->find_fix_property(name, "property/global", style, rows, columns, law_.model.c_str(), false));
  }

  bool given(const char* name) const {
    return find(name, "scalar") || find(name, "peratomtype") || find(name, "peratomtypepair");
  }

  double checked(const char* name, const char* unit, const std::string& where, double x, Range range) const {
    if (!range.holds(x))
      fail(std::string(name) + " = " + number(x) + unit_of(unit) + " of " + where + ", " + range.text());
    return x;
  }

  /// A value of two types, which must be the same from both sides.
  double of_pair(FixPropertyGlobal* pairs, const char* name, const char* unit, int i, int j, Range range) const {
    const double x = pairs->compute_array(i - 1, j - 1), y = pairs->compute_array(j - 1, i - 1);
    if (x != y) fail(std::string(name) + " of " + both(i, j) + " is not symmetric: " + number(x) + " and " + number(y));
    return checked(name, unit, both(i, j), x, range);
  }

  std::string missing(const char* name, const char* unit) const {
    return std::string("property ") + name + unit_of(unit) +
           " is missing; give one value per atom type: " + "fix ID all property/global " + name +
           " peratomtype VALUE ...";
  }

  std::vector<double> per_type(const char* name, const char* unit, Range range) const {
    FixPropertyGlobal* fix = find(name, "peratomtype");
    if (!fix) fail(missing(name, unit));
    std::vector<double> values(n_ + 1, 0.0);
    for (int i = 1; i <= n_; ++i)
      values[i] = checked(name, unit, "type " + std::to_string(i), fix->compute_vector(i - 1), range);
    return values;
  }

 private:
  LAMMPS_NS::LAMMPS* lmp_;
  const Declaration& law_;
  int n_;
};

}  // namespace epdem::liggghts
