// SPDX-License-Identifier: GPL-2.0-or-later
#include "comm.h"
#include "force.h"
#include "reader.hpp"

namespace epdem::liggghts {

void compare_cohesion(LAMMPS_NS::LAMMPS* lmp, const Declaration& law, const Materials& materials) {
  if (law.strength < 0) return;
  auto* const density = static_cast<FixPropertyGlobal*>(
      lmp->modify->find_fix_property("cohesionEnergyDensity", "property/global", "peratomtypepair", materials.width - 1,
                                     materials.width - 1, law.model, false));
  if (!density) return;  // LIGGGHTS says so
  const double pascal = 1.0 / lmp->force->nktv2p;
  for (int i = 1; i < materials.width; ++i)
    for (int j = i; j < materials.width; ++j) {
      const double pull = density->compute_array(i - 1, j - 1);
      const double resists = materials.pairs[i * materials.width + j].parameters[law.strength] / pascal;
      if (!(pull > resists)) continue;
      const std::string text = std::string("model ") + law.model + ": cohesionEnergyDensity = " + number(pull) +
                               " exceeds " + law.parameters[law.strength].property + " = " + number(resists) + " of " +
                               both(i, j) +
                               ": cohesion pulls contacts in harder than they resist, and the spheres collapse";
      static std::string said;
      if (lmp->comm->me == 0 && text != said) lmp->error->warning(FLERR, text.c_str());
      said = text;
      return;
    }
}

}  // namespace epdem::liggghts
