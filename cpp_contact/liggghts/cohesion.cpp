// SPDX-License-Identifier: GPL-2.0-or-later
#include "comm.h"
#include "reader.hpp"

namespace epdem::liggghts {

void compare_cohesion(LAMMPS_NS::LAMMPS* lmp, const std::string& model, int width, const std::vector<double>& resists) {
  auto* const density = static_cast<FixPropertyGlobal*>(lmp->modify->find_fix_property(
      "cohesionEnergyDensity", "property/global", "peratomtypepair", width - 1, width - 1, model.c_str(), false));
  if (!density) return;  // LIGGGHTS says so
  for (int i = 1; i < width; ++i)
    for (int j = i; j < width; ++j) {
      const double pull = density->compute_array(i - 1, j - 1), most = resists[i * width + j];
      if (!(pull > most)) continue;
      const std::string text = "model " + model + ": cohesionEnergyDensity = " + number(pull) + " of " + both(i, j) +
                               " pulls contacts in harder than they resist: above " + number(most) +
                               " the spheres collapse";
      static std::string said;
      if (lmp->comm->me == 0 && text != said) lmp->error->warning(FLERR, text.c_str());
      said = text;
      return;
    }
}

}  // namespace epdem::liggghts
