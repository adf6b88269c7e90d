// SPDX-License-Identifier: GPL-2.0-or-later
#include "heat.hpp"

#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <string>

#include "atom.h"
#include "energy_tally.hpp"
#include "force.h"
#include "lammps/fix_slowing.hpp"
#include "modify.h"

namespace epdem::liggghts {

using namespace LAMMPS_NS;

namespace {

using Styles = std::map<std::string, Fix* (*)(LAMMPS*, int, char**)>;

/// An explicit instantiation may name a private member.
template <Styles* Modify::* styles>
struct StylesOf {
  friend Styles& styles_of(Modify& modify) { return *(modify.*styles); }
};
Styles& styles_of(Modify& modify);
template struct StylesOf<&Modify::fix_map>;

constexpr const char *style_name = "heat/ep", *property = "temperature";

template <class Style>
Fix* create(LAMMPS* lmp, int count, char** word) {
  return new Style(lmp, count, word);
}

}  // namespace

void add_fix_styles(LAMMPS* lmp) {
  styles_of(*lmp->modify)[style_name] = &create<FixHeat>;
  styles_of(*lmp->modify)[FixSlowing::style_name] = &create<FixSlowing>;
}

FixHeat::FixHeat(LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
  sums_.read(
      count, word, atom->ntypes, [=](int k) { return lmp->force->numeric(FLERR, word[k]); },
      [=](const std::string& text) { lmp->error->all(FLERR, text.c_str()); });
  create_attribute = 1;
  just_created = 0;  // the first run would take the temperatures of all spheres away
  size_vector = static_cast<int>(sums_.walls().size());
  vector_flag = size_vector > 0;
  extvector = 1;
  global_freq = 1;
  nevery = 1;
}

FixHeat* FixHeat::of(LAMMPS* lmp, bool computes_areas) {
  auto* const found = static_cast<FixHeat*>(lmp->modify->find_fix_style(style_name, 0));
  if (found && !computes_areas)
    lmp->error->all(FLERR,
                    "fix heat/ep: the area of the contacts comes from computePlasticWork on; give it to pairs and "
                    "walls");
  return found;
}

FixPropertyAtom* FixHeat::find(const char* name) {
  return static_cast<FixPropertyAtom*>(modify->find_fix_property(name, "property/atom", "scalar", 0, 0, style, false));
}

/// A fix that a constructor adds takes the place of the constructed one.
void FixHeat::post_create() {
  const char* words[] = {property, "all", "property/atom", property, "scalar", "yes", "yes", "no", "none"};
  temperature_ = find(property);
  if (temperature_) return;
  temperature_ = modify->add_fix_property_atom(9, const_cast<char**>(words), style);
  if (temperature_->recent_restart) return;
  for (int i = 0; i < atom->nlocal; ++i) set_arrays(i);
}

void FixHeat::init() {
  if (modify->n_fixes_style(style_name) > 1) error->all(FLERR, "fix heat/ep: there are two; keep one");
  temperature_ = find(property);
  work_ = find(EnergyTally::work_name);
  friction_ = find(EnergyTally::friction_name);
}

void FixHeat::open() {
  temperature_->do_forward_comm();
  sums_.open(atom->nlocal, temperature_->vector_atom, atom->type, [this](int i) { return work_of(i); });
}

void FixHeat::add_wall(int i, const FixMeshSurface* mesh, const FixWallGran& wall, double radius) {
  if (kernels::Heat::Wall* const found = sums_.wall(mesh ? mesh->id : wall.id)) sums_.add_wall(i, *found, radius);
}

void FixHeat::end_of_step() {
  char text[200];
  sums_.close(
      temperature_->vector_atom, atom->rmass, update->dt, [this](int i) { return work_of(i); },
      [&](int i, double limit) {
        std::snprintf(text, sizeof text,
                      "fix heat/ep: a time step of %g is too long for the heat of atom %d, which "
                      "needs at most %g; give a smaller step or a larger specific heat",
                      update->dt, atom->tag[i], limit);
        error->one(FLERR, text);
      },
      [&](int i) {
        std::snprintf(text, sizeof text,
                      "fix heat/ep: atom %d or a neighbour has no temperature; give fix_modify %s "
                      "temperature",
                      atom->tag[i], id);
        error->one(FLERR, text);
      });
}

double FixHeat::compute_vector(int wall) {
  double all = 0.0;
  MPI_Allreduce(&sums_.walls()[wall].flow, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

int FixHeat::modify_param(int count, char** word) {
  if (std::strcmp(word[0], property) != 0) return 0;
  if (count < 4) error->all(FLERR, "fix_modify: the words are temperature FROM TO T");
  const int from = force->inumeric(FLERR, word[1]), to = force->inumeric(FLERR, word[2]);
  const double T = force->numeric(FLERR, word[3]);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->tag[i] >= from && atom->tag[i] <= to) temperature_->vector_atom[i] = T;
  return 4;
}

/// A new sphere has no temperature.
void FixHeat::set_arrays(int i) { temperature_->vector_atom[i] = std::numeric_limits<double>::quiet_NaN(); }

}  // namespace epdem::liggghts
