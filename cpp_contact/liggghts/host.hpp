// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's headers in the one order that compiles, and the guard against a library they do not belong to.
#pragma once

// fix_insert_stream_predefined.h lacks this include and an include guard
#include "fix_insert_stream.h"

// the tangential models use these without including them
#include "fix_mesh_surface.h"
#include "fix_property_atom.h"
#include "neighbor.h"
#include "update.h"

#include <cstdio>
#include <string>
#include <vector>

#include "comm.h"
#include "contact_models.h"
#include "epdem/vec.hpp"
#include "fix_wall_gran_base.h"
#include "kernels/spheres.hpp"
#include "pair_gran_base.h"

namespace epdem::liggghts {

inline Vec<double> vector_of(const double* v) { return {v[0], v[1], v[2]}; }

/// A law's name as a LIGGGHTS model.
template <class Law>
std::string model_name() {
  return std::string("ep/") + Law::name;
}

/// The names of all models, each after a blank.
std::string model_names();

/// Whether the particles of the simulation are spheres.
bool only_spheres(LAMMPS_NS::LAMMPS* lmp);

/// The smallest radius of the spheres of each type that are there or will be added; infinite if there are none.
/// Collective.
std::vector<double> smallest_radii(LAMMPS_NS::LAMMPS* lmp);

/// Makes LIGGGHTS look at bodies up to this factor of the sum of their radii.
void register_contact_distance(LAMMPS_NS::LAMMPS* lmp, double factor);

/// The kernels of the processor; none for LIGGGHTS-PFM, which has no compaction.
const kernels::SphereKernels* sphere_kernels(LAMMPS_NS::LAMMPS* lmp);

/// Prints a line on the screen and into the log, on the first rank.
inline void say(const LAMMPS_NS::LAMMPS* lmp, const std::string& line) {
  if (lmp->comm->me != 0) return;
  for (FILE* out : {lmp->screen, lmp->logfile})
    if (out) std::fputs((line + "\n").c_str(), out);
}

/// Whether the library in use is the one that the headers describe: its members may be read.
bool library_matches(LAMMPS_NS::LAMMPS* lmp);

/// Ends the run if the library in use is another one.
void check_host(LAMMPS_NS::LAMMPS* lmp);

}  // namespace epdem::liggghts
