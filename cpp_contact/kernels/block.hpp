// SPDX-License-Identifier: BSD-3-Clause
// Contacts on their way through the loops of a host: gathered into a block, computed as lanes, scattered in the order
// of the host's list. No header of a host in this folder, and no inline function in this file: sources that are
// compiled for newer processors include it.
#pragma once

#include "epdem/settings.hpp"
#include "kernels/spheres.hpp"

namespace epdem::kernels {

constexpr int block_size = 64, most_lanes = 8;

/// A pair of materials as numbers: ContactConstants, the data of its law from `law_data` on, then its BodyShares.
enum Constant { shear_modulus, damping, dashpot, friction, rolling_friction, cohesion_density, law_data };
constexpr int most_constants = 24;

/// One number per contact; whole vectors of lanes may be read and written behind the last.
struct alignas(64) Line {
  double a[block_size + most_lanes];
};

struct Block {
  int i[block_size + most_lanes], j[block_size + most_lanes];
  double* history[block_size + most_lanes];
  const double* material[block_size + most_lanes];  // constants of the pair of types
  Line radius_i, radius_j, mass_i, mass_j;
  Line frozen_i, frozen_j;                                // 1 or 0
  Line force[3], torque_i[3], torque_j[3];                // on i; the force on j is its negative
  Line plastic_work_step, stored_energy, contact_radius;  // [J], [J], [m]
  Line friction_work, spring_energy;                      // of friction in this step, elastic at its end [J]
  Line adhesion_loss;                                     // with adhesion: lost in jumps in this step [J]
  double radius_ratio[most_lanes],
      overlap_ratio[most_lanes];          // largest w a/R* and w overlap/R* so far, w the larger share
  Line overlap, from_wall[3], wall_v[3];  // of a wall: as the host found them
  Line dents_i[6], dents_j[6];            // with compaction: numbers of Dent
  double unused_history[64];              // of the lanes behind the last contact
};

/// Settings and arrays of a pass, the same for all contacts.
struct Pass : ContactSettings {
  const double *x, *v, *omega;  // rows of three; one number behind the last row can be read
  const double* sums;           // BodySums of all spheres side by side, with compaction
  double now;                   // step
  bool several;                 // pairs of materials in this block; else the pair of its first contact
  bool freeze;                  // whether a group of atoms is frozen
  bool work;                    // energies are requested
  bool holds;                   // with them what contacts hold; else stored_energy has no sense
  bool strain;                  // the largest w a/R* and w overlap/R* are requested
};

/// Computes n contacts; the lanes behind them have valid indices and an unused history (`pad`).
using Kernel = void (*)(Block&, int n, const Pass&);

/// The kernels of one instruction set: law and friction by their places in their lists, whether the contacts are at
/// walls; null: no such model.
struct Kernels {
  static constexpr int most_laws = 16, most_frictions = 16;
  Kernel of[most_laws][most_frictions][2];
  SphereKernels spheres;
  // with compaction; 1 of the last index also computes energies and repeats steps, whose many numbers would stay in
  // registers beside each contact
  Kernel grown[most_laws][most_frictions][2][2];
};

extern const Kernels kernels_sse2, kernels_avx2, kernels_avx512;

/// Gives the lanes behind the last of n contacts something harmless.
void pad(Block& block, int n);

}  // namespace epdem::kernels
