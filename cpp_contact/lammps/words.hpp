// SPDX-License-Identifier: GPL-2.0-or-later
// The words LAW E nu PARAMETERS [options] of pair_coeff and of walls, and the constants of a contact that follow.
#pragma once

#include <string>
#include <vector>

#include "epdem/exists.hpp"
#include "kernels/block.hpp"
#include "pointers.h"

namespace epdem::lammps {

/// A law as its class declares it; laws.hpp lists the classes.
struct Law {
  const char* name;
  int id;  // of restart files
  const Parameter* parameters;
  int parameter_count;
  int strength;  // index of the parameter, -1: none
  bool (*valid)(const double*);
  double (*hardening)(const double*);  // pressure of full plasticity over pressure of first yield
  const char* condition;               // the condition of `valid` in words
  int place;                           // in the kernels
  int history_size;
  GapPlaces gap;  // in the history
  int most;       // index of the largest overlap, -1: none
  /// Writes the law of E* and these parameters, and the shares of the bodies, to the constants of a contact.
  void (*put)(double E_star, const double* parameters, const BodyShares<double>& bodies, double* constants);
  /// Largest gap [length] across which a law object of these numbers pulls; 0 without adhesion.
  double (*largest_gap)(const double* numbers, double R_star);
  /// The least R* [length] that the adhesion of such a law allows, and the sentence on a smaller one.
  double (*least_R_star)(const double* numbers);
  std::string (*refused_adhesion)(const double* numbers, double R_star);
};

const std::vector<Law>& all_laws();

/// A body of a contact.
struct Material {
  Elastic elastic;
  std::vector<double> parameters;  // of the law
};

/// Law and models beside it, by their places in their lists; 0: no such model.
struct Models {
  const Law* law = nullptr;
  int friction = 0, rolling = 0, cohesion = 0;
  bool adds_friction = false;  // friction computes its work
  bool compaction = false;
};

/// The ids of law, friction and rolling friction, which restart files keep.
std::vector<double> ids_of(const Models& models);

/// Coefficients of a pair of bodies; 0: no such force. A restitution of 0 means no dashpot.
struct Coefficients {
  double friction = 0.0, normal_restitution = 0.0, tangential_restitution = 0.0, rolling = 0.0, cohesion = 0.0;

  bool damped() const { return normal_restitution > 0.0 || tangential_restitution > 0.0; }
};

struct Words {
  Material material;  // without parameters of `mixed`, which leaves the material to the like types
  Models models;
  Coefficients coefficients;
};

/// Reads the words behind `place`, e.g. "pair_coeff 1 2"; ends the run with a sentence about the first wrong one.
Words read_words(LAMMPS_NS::LAMMPS* lmp, const std::string& place, int count, char** word);

/// The models of a pair style that has models `a` and `b`, whose law may be null; ends the run if a and b differ.
Models common_models(LAMMPS_NS::LAMMPS* lmp, const std::string& place, const Models& a, const Models& b);

/// Coefficients of unlike types: geometric means.
Coefficients mixed(const Coefficients& a, const Coefficients& b);

/// Writes the kernels::most_constants constants of a contact, and those of j and i unless null. The body with the lower
/// strength gives the parameters of the law; a parameter of a pair of surfaces is the geometric mean of both bodies.
void put_constants(const Law& law, const Material& i, const Material& j, const Coefficients& common, double* constants,
                   double* constants_ji = nullptr);

/// Ends the run if LAMMPS's settings exclude contacts of spheres by these models: atom style, units, minimization.
void check_settings(LAMMPS_NS::LAMMPS* lmp, const std::string& place);

/// Ends the run if there are rigid bodies: a dashpot needs their masses.
void refuse_rigid_bodies(LAMMPS_NS::LAMMPS* lmp, const std::string& place);

/// Largest gap [length] across which a contact of these constants pulls; ends the run if it is above the skin.
double checked_gap(LAMMPS_NS::LAMMPS* lmp, const std::string& place, const Law& law, const double* constants,
                   double R_most);

/// The least R* [length] that the adhesion of each pair of materials allows. Contacts are judged one by one where the
/// smallest spheres would be refused: they may never meet.
class AdhesionJudge {
 public:
  void begin(size_t pairs);
  /// Whether smallest spheres of `R_star` [length] would be refused by the constants at this place.
  bool note(size_t place, const Law& law, const double* constants, double R_star);
  /// Ends the run at the first of n contacts below the least R*.
  void judge(LAMMPS_NS::LAMMPS* lmp, const std::string& place, const Law& law, const kernels::Block& b, int n,
             bool several, bool wall, const double* constants) const;

 private:
  std::vector<double> least_;
  bool judges_ = false;
};

/// The kernels of the widest instruction set of this processor, or of EPDEM_SIMD; ends the run if that is none.
const kernels::Kernels& kernels_of(LAMMPS_NS::LAMMPS* lmp);

/// The kernel of these models; ends the run if the models have no kernel. complete: it can compute energies and repeat
/// a step, with compaction at a cost.
kernels::Kernel kernel_of(LAMMPS_NS::LAMMPS* lmp, const std::string& place, const Models& models, bool wall,
                          bool complete);

/// Rows of three numbers of atoms, of which kernels read one number behind the last: a copy where memory ends there.
const double* readable_rows(const double* const* rows, int atoms, int capacity, std::vector<double>& copy);

/// Values in the history of a contact.
struct Layout {
  int values = 0;      // numbers of a contact
  int last_step = -1;  // place, of pairs with a history
  GapPlaces gap;
  std::vector<double> mirror;  // 1, or -1 of a number that changes its sign when j takes the place of i
};

Layout layout_of(const Models& models, bool wall);

}  // namespace epdem::lammps
