// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts on their way through our loops: gathered into a block, computed as lanes, scattered in the list's order.
// No header of LIGGGHTS and no inline function in here: files that are compiled for newer processors include it.
#pragma once

namespace epdem::liggghts::loop {

constexpr int block_size = 128, most_lanes = 8;

enum class Tangential { off, no_history, history, partial_slip, partial_slip_2 };
constexpr int tangentials = 5;
enum class Rolling { off, cdt, epsd2 };
enum class Cohesion { off, sjkr, sjkr2 };

/// What a pair of materials has in common; the data of its law follow from `law_data` on.
enum Constant { shear_modulus, damping, dashpot, friction, rolling_friction, cohesion_density, law_data };
constexpr int most_constants = 16;

/// One number per contact; whole vectors of lanes may be read and written behind the last.
struct alignas(64) Line {
  double a[block_size + most_lanes];
};

struct Block {
  int i[block_size + most_lanes], j[block_size + most_lanes];
  double* history[block_size + most_lanes];
  const double* material[block_size + most_lanes];  // constants of the pair of types
  Line radi, radj, mi, mj;
  Line frozen_i, frozen_j;                  // 1 or 0
  Line force[3], torque_i[3], torque_j[3];  // on i; the force on j is its negative
  Line grown, stored;                       // plastic work of this step, elastic energy
  Line rubbed, sprung;                      // work of friction in this step, elastic energy of its springs
  Line parted, radius;                      // with adhesion: what its jumps took in this step, contact radius
  double radius_ratio[most_lanes], overlap_ratio[most_lanes];  // largest of all contacts so far, over R*
  Line overlap, apart[3], wall_v[3];  // of a wall: as LIGGGHTS's loop found them; from the wall to the sphere
};

/// What all contacts of a pass have in common.
struct Pass {
  const double *x, *v, *omega;  // rows of three; one number behind the last row can be read
  double now, dt;               // step and its length
  Rolling rolling;
  Cohesion cohesion;
  bool several;          // pairs of materials in this block; else that of its first contact
  bool damped, viscous;  // whether any pair has a tangential dashpot, a normal one
  bool freeze;           // whether a group of atoms is frozen
  bool work;             // plastic work and elastic energy are asked for
  bool strain;           // the largest contact radius and overlap over R* are requested
  bool torsion;          // rolling friction also resists torsion
  bool cohesion_slides;  // cohesion lowers the normal force that friction sees
};

/// Computes n contacts; the lanes behind them have valid indices and a history that nobody reads.
using Kernel = void (*)(Block&, int n, const Pass&);

/// The kernels of one instruction set, by the place of the law in the register.
struct Kernels {
  static constexpr int most_laws = 16;
  Kernel of[most_laws][tangentials][2][2];  // law, tangential, whether rolling has history, walls; null: no such model
};

extern const Kernels kernels_sse2, kernels_avx2, kernels_avx512;

}  // namespace epdem::liggghts::loop
