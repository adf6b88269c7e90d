// SPDX-License-Identifier: GPL-2.0-or-later
#include "words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "atom.h"
#include "epdem/contact.hpp"
#include "epdem/laws.hpp"
#include "epdem/range.hpp"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "kernels/gather.hpp"
#include "modify.h"
#include "neighbor.h"
#include "update.h"
#include "utils.h"

namespace epdem::lammps {

using LAMMPS_NS::LAMMPS;

namespace {

/// Index of a value in the history of a law, -1: none.
template <class Class>
int place_of(const char* value) {
  for (int k = 0; k < history_size<Class>; ++k)
    if (std::strcmp(State<Class>::slots[k], value) == 0) return k;
  return -1;
}

template <class Class>
Class law_at(const double* numbers) {
  Class law;
  std::memcpy(static_cast<void*>(&law), numbers, sizeof law);
  return law;
}

template <class Class>
Law law_of() {
  static_assert(sizeof(ContactConstants<Class>) <= kernels::most_constants * sizeof(double));
  return {Class::name,
          Class::id,
          Class::parameters,
          Class::n_parameters,
          Class::strength,
          &Class::valid,
          &hardening<Class>,
          Class::condition,
          detail::place<Class>(),
          history_size<Class>,
          gap_places<Class>(),
          place_of<Class>("delta_max"),
          [](double E_star, const double* parameters, const BodyShares<double>& bodies, double* constants) {
            ContactConstants<Class> pair;
            std::memcpy(static_cast<void*>(&pair), constants, sizeof pair);
            pair.law = Class(E_star, parameters);
            pair.bodies = bodies;
            std::memcpy(static_cast<void*>(constants), &pair, sizeof pair);
          },
          [](const double* numbers, double R_star) {
            if constexpr (adheres<Class>) {
              return adhesive::largest_gap(law_at<Class>(numbers).c, R_star);
            }
            (void)numbers;
            (void)R_star;
            return 0.0;
          },
          [](const double* numbers) { return least_R_star(law_at<Class>(numbers)); },
          [](const double* numbers, double R_star) { return refused_adhesion(law_at<Class>(numbers), R_star); }};
}

[[noreturn]] void fail(LAMMPS* lmp, const std::string& text) { lmp->error->all(FLERR, text); }

std::string symbols(const Law& law) {
  std::string text;
  for (int k = 0; k < law.parameter_count; ++k) {
    const Parameter& p = law.parameters[k];
    const bool optional = !std::isnan(p.fallback);
    text += std::string(optional ? " [" : " ") + p.symbol + (optional ? "]" : "");
  }
  return text;
}

/// Names of a list of models as words of LAMMPS: `none` for the first, the others without the prefix ep/.
template <class Models>
std::vector<std::string> names() {
  std::vector<std::string> all;
  Models::each([&](auto model, int place) { all.push_back(place == 0 ? "none" : plain_name(decltype(model)::name)); });
  return all;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (size_t k = 0; k < names.size(); ++k) text += (k == 0 ? "" : k + 1 == names.size() ? " or " : ", ") + names[k];
  return text;
}

/// Reads one word after the other.
class WordReader {
 public:
  WordReader(LAMMPS* lmp, const std::string& place, int count, char** word)
      : lmp_(lmp), place_(place), count_(count), word_(word) {}

  bool at_end() const { return at_ == count_; }
  bool at_number() const { return !at_end() && LAMMPS_NS::utils::is_double(word_[at_]); }

  std::string next(const std::string& what) {
    if (at_end()) wrong("ends before " + what);
    return word_[at_++];
  }

  double next_number(const std::string& what, const Range& range) {
    const std::string text = next(what);
    if (!LAMMPS_NS::utils::is_double(text)) wrong(what + " = " + text + ", must be a number");
    const double x = std::atof(text.c_str());
    if (!range.holds(x)) wrong(what + " = " + text + ", " + range.text());
    return x;
  }

  /// Place of the next word in a list of names.
  int next_of(const std::string& what, const std::vector<std::string>& names) {
    const std::string text = next(what + " (" + joined(names) + ")");
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) wrong(what + " = " + text + ", must be " + joined(names));
    return static_cast<int>(found - names.begin());
  }

  [[noreturn]] void wrong(const std::string& text) const { fail(lmp_, place_ + ": " + text); }

 private:
  LAMMPS* const lmp_;
  const std::string& place_;
  const int count_;
  char** const word_;
  int at_ = 0;
};

void read_parameters(WordReader& reader, const Law& law, std::vector<double>& values) {
  for (int k = 0; k < law.parameter_count; ++k) {
    const Parameter& p = law.parameters[k];
    if (!std::isnan(p.fallback) && !reader.at_number()) {
      values.push_back(p.fallback);
      continue;
    }
    const std::string what = std::string(p.symbol) + " [" + p.unit + "] of " + law.name + " E nu" + symbols(law);
    values.push_back(reader.next_number(what, range_of(p)));
  }
  if (!law.valid(values.data()))
    reader.wrong("the parameters of " + std::string(law.name) +
                 " do not go together; they must fulfil: " + law.condition);
}

void read_options(WordReader& reader, Words& words) {
  constexpr Range not_negative{0.0, unlimited, true};
  constexpr Range restitution{viscous_restitution_min, 1.0, true, true}, tangential{0.0, 1.0, false, true};
  const std::vector<std::string> options{
      "tangential", "restitution", "rolling", "cohesion", "normal_restitution", "tangential_restitution", "compaction"};
  std::vector<bool> seen(options.size());
  while (!reader.at_end()) {
    const int option = reader.next_of("option", options);
    if (seen[option]) reader.wrong("option " + options[option] + " stands twice; keep one");
    seen[option] = true;
    if (option == 0) {
      words.models.friction = reader.next_of("tangential", names<Frictions>());
      Frictions::each([&](auto model, int place) {
        if (place == words.models.friction) words.models.adds_friction = decltype(model)::adds_work;
      });
      if (words.models.friction) words.coefficients.friction = reader.next_number("friction mu", not_negative);
    } else if (option == 1) {
      words.coefficients.normal_restitution = words.coefficients.tangential_restitution =
          reader.next_number("restitution e", restitution);
    } else if (option == 2) {
      words.models.rolling = reader.next_of("rolling", names<Rollings>());
      if (words.models.rolling) words.coefficients.rolling = reader.next_number("rolling friction mu_r", not_negative);
    } else if (option == 4) {
      words.coefficients.normal_restitution = reader.next_number("normal_restitution e", restitution);
    } else if (option == 5) {
      words.coefficients.tangential_restitution = reader.next_number("tangential_restitution e", tangential);
    } else if (option == 6) {
      words.models.compaction = reader.next_of("compaction", {"off", "on"});
    } else {
      words.models.cohesion = reader.next_of("cohesion", names<Cohesions>());
      if (words.models.cohesion)
        words.coefficients.cohesion = reader.next_number("cohesion energy density", not_negative);
    }
  }
}

int common_place(LAMMPS* lmp, const std::string& place, const char* what, const std::vector<std::string>& names, int a,
                 int b) {
  if (a && b && a != b)
    fail(lmp, place + ": " + what + " " + names[b] + " beside " + what + " " + names[a] +
                  "; all contacts of a pair style have one model, others take a pair style of their own (hybrid)");
  return a ? a : b;
}

double geometric(double a, double b) { return std::sqrt(a * b); }

}  // namespace

const std::vector<Law>& all_laws() {
#define EPDEM_LAW_OF(Class) law_of<Class<double>>(),
  static const std::vector<Law> laws{EPDEM_LAWS(EPDEM_LAW_OF)};
#undef EPDEM_LAW_OF
  return laws;
}

std::vector<double> ids_of(const Models& models) {
  std::vector<double> ids{double(models.law->id)};
  const auto add = [&](auto list, int place) {
    list.each([&](auto model, int at) {
      if (at == place) ids.push_back(decltype(model)::id);
    });
  };
  add(Frictions{}, models.friction);
  add(Rollings{}, models.rolling);
  return ids;
}

Words read_words(LAMMPS* lmp, const std::string& place, int count, char** word) {
  WordReader reader(lmp, place, count, word);
  Words words;
  if (count > 0 && std::strcmp(word[0], "mixed") == 0) {
    reader.next("mixed");
    read_options(reader, words);
    return words;
  }
  std::vector<std::string> laws;
  for (const Law& law : all_laws()) laws.emplace_back(law.name);
  words.models.law = &all_laws()[reader.next_of("law", laws)];
  words.material.elastic.young_modulus = reader.next_number("Young's modulus E", {0.0, unlimited});
  words.material.elastic.poisson_ratio = reader.next_number("Poisson's ratio nu", {-1.0, 0.5, false, true});
  read_parameters(reader, *words.models.law, words.material.parameters);
  read_options(reader, words);
  return words;
}

Models common_models(LAMMPS* lmp, const std::string& place, const Models& a, const Models& b) {
  if (a.law && b.law && a.law != b.law)
    fail(lmp, place + ": law " + b.law->name + " beside law " + a.law->name +
                  "; all contacts of a pair style and its walls have one law, others take a pair style of their own "
                  "(hybrid)");
  Models common{a.law ? a.law : b.law};
  common.friction = common_place(lmp, place, "tangential", names<Frictions>(), a.friction, b.friction);
  common.adds_friction = a.adds_friction || b.adds_friction;
  common.compaction = a.compaction || b.compaction;
  common.rolling = common_place(lmp, place, "rolling", names<Rollings>(), a.rolling, b.rolling);
  common.cohesion = common_place(lmp, place, "cohesion", names<Cohesions>(), a.cohesion, b.cohesion);
  return common;
}

Coefficients mixed(const Coefficients& a, const Coefficients& b) {
  return {geometric(a.friction, b.friction), geometric(a.normal_restitution, b.normal_restitution),
          geometric(a.tangential_restitution, b.tangential_restitution), geometric(a.rolling, b.rolling),
          geometric(a.cohesion, b.cohesion)};
}

void put_constants(const Law& law, const Material& i, const Material& j, const Coefficients& common, double* constants,
                   double* constants_ji) {
  const bool i_is_softer = law.strength < 0 || is_softer(i.parameters[law.strength], j.parameters[law.strength]);
  std::vector<double> parameters = (i_is_softer ? i : j).parameters;
  for (int k = 0; k < law.parameter_count; ++k)
    if (law.parameters[k].of_pair)
      parameters[k] = adhesive::work_of_adhesion(0.5 * i.parameters[k], 0.5 * j.parameters[k]);
  std::fill_n(constants, kernels::most_constants, 0.0);
  constants[kernels::shear_modulus] = effective_shear_modulus(i.elastic, j.elastic);
  if (common.tangential_restitution > 0.0) constants[kernels::damping] = damping_number(common.tangential_restitution);
  if (common.normal_restitution > 0.0) constants[kernels::dashpot] = viscous_number(common.normal_restitution);
  constants[kernels::friction] = common.friction;
  constants[kernels::rolling_friction] = common.rolling;
  constants[kernels::cohesion_density] = common.cohesion;
  const double share = law.strength < 0 ? 0.5
                                        : strain_share(i.parameters[law.strength], j.parameters[law.strength],
                                                       law.hardening(parameters.data()));
  const BodyShares<double> bodies = body_shares(i.elastic, j.elastic, share);
  const double E_star = effective_modulus(i.elastic, j.elastic);
  if (constants_ji) {
    std::copy_n(constants, kernels::most_constants, constants_ji);
    law.put(E_star, parameters.data(), mirrored(bodies), constants_ji);
  }
  law.put(E_star, parameters.data(), bodies, constants);
}

void check_settings(LAMMPS* lmp, const std::string& place) {
  const LAMMPS_NS::Atom& atom = *lmp->atom;
  if (!atom.radius_flag || !atom.rmass_flag || !atom.omega_flag || !atom.torque_flag)
    fail(lmp, place + ": the atom style has no radius, mass, spin and torque per atom; take atom_style sphere");
  if (atom.ellipsoid_flag || atom.line_flag || atom.tri_flag || atom.body_flag)
    fail(lmp, place + ": the atom style holds other bodies than spheres; take atom_style sphere");
  if (!atom.tag_enable) fail(lmp, place + ": contacts need atom IDs; remove atom_modify id no");
  if (lmp->force->ftm2v != 1.0 || lmp->force->nktv2p != 1.0)
    fail(lmp, place + ": units " + lmp->update->unit_style +
                  " measure pressure by other units than force and length; take units si, cgs, micro, nano or lj");
  if (lmp->update->whichflag == 2)
    fail(lmp, place + ": minimization has no steps in time, which the history of contacts needs; take run");
  if (std::strncmp(lmp->update->integrate_style, "respa", 5) == 0)
    fail(lmp, place + ": run_style respa has steps of several lengths; take run_style verlet");
}

void refuse_rigid_bodies(LAMMPS* lmp, const std::string& place) {
  for (const LAMMPS_NS::Fix* fix : lmp->modify->get_fix_list())
    if (fix->rigid_flag)
      fail(lmp, place + ": restitution needs the mass of the body of fix " + fix->style + " " + fix->id +
                    ", which contacts do not know; remove restitution");
}

double checked_gap(LAMMPS* lmp, const std::string& place, const Law& law, const double* constants, double R_most) {
  const double gap = law.largest_gap(constants + kernels::law_data, R_most), skin = lmp->neighbor->skin;
  if (gap > skin)
    fail(lmp, place + ": law " + law.name + " pulls across gaps up to " + number(gap) + ", above the skin " +
                  number(skin) + "; increase the skin of command neighbor");
  return gap;
}

void AdhesionJudge::begin(size_t pairs) {
  least_.assign(pairs, 0.0);
  judges_ = false;
}

bool AdhesionJudge::note(size_t place, const Law& law, const double* constants, double R_star) {
  least_[place] = law.least_R_star(constants + kernels::law_data);
  const bool refused = R_star < least_[place];
  judges_ |= refused;
  return refused;
}

void AdhesionJudge::judge(LAMMPS* lmp, const std::string& place, const Law& law, const kernels::Block& b, int n,
                          bool several, bool wall, const double* constants) const {
  const int k = judges_ ? kernels::first_below(b, n, several, wall, constants, least_.data()) : -1;
  if (k < 0) return;
  const auto tag = [&](int i) { return std::to_string(lmp->atom->tag[i]); };
  const double R_i = b.radius_i.a[k], R_star = wall ? R_i : reduced_finite(R_i, b.radius_j.a[k]);
  const std::string text = place + ": step " + std::to_string(lmp->update->ntimestep) + ", sphere " + tag(b.i[k]) +
                           (wall ? "" : " and " + tag(b.j[k])) + ": " +
                           law.refused_adhesion(b.material[several ? k : 0] + kernels::law_data, R_star);
  lmp->error->one(FLERR, text);
}

const kernels::Kernels& kernels_of(LAMMPS* lmp) {
  std::string refusal;
  const kernels::Kernels* const set = kernels::chosen_kernels(refusal);
  if (!set) fail(lmp, refusal);
  return *set;
}

kernels::Kernel kernel_of(LAMMPS* lmp, const std::string& place, const Models& models, bool wall, bool complete) {
  if (models.law->gap.root >= 0 && models.cohesion)
    fail(lmp, place + ": cohesion " + names<Cohesions>()[models.cohesion] + " beside " + models.law->name +
                  ", which attracts by itself; remove one");
  const kernels::Kernels& set = kernels_of(lmp);
  if (models.compaction && models.cohesion && models.cohesion != bond_place)
    fail(lmp, place + ": compaction beside cohesion " + names<Cohesions>()[models.cohesion] + "; remove one");
  if (models.cohesion == bond_place && !models.compaction)
    fail(lmp, place + ": cohesion bond needs compaction on, whose contacts it holds; give it, or remove the cohesion");
  const int law = models.law->place, friction = models.friction;
  const kernels::Kernel kernel =
      models.compaction ? set.grown[law][friction][wall][complete] : set.of[law][friction][wall];
  if (kernel) return kernel;
  if (models.compaction && set.of[law][friction][wall])
    fail(lmp, place + ": law " + models.law->name + " has no compaction; take law cavity or cavity_adhesive");
  fail(lmp, place + ": tangential " + names<Frictions>()[models.friction] + " does not exist beside law " +
                models.law->name + "; take tangential history");
}

const double* readable_rows(const double* const* rows, int atoms, int capacity, std::vector<double>& copy) {
  if (atoms < capacity) return rows[0];
  copy.assign(rows[0], rows[0] + 3L * atoms);
  copy.push_back(0.0);
  return copy.data();
}

Layout layout_of(const Models& models, bool wall) {
  int friction = 0, even = 0;
  Frictions::each([&](auto model, int at) {
    if (at != models.friction) return;
    friction = values_of<decltype(model), double>;
    even = decltype(model)::even_values;
  });
  const int law = models.law->history_size, rolling = has_history(Rollings{}, models.rolling) ? 3 : 0;
  Layout layout;
  if (law + friction + rolling == 0) return layout;
  layout.gap = models.law->gap;
  layout.mirror.assign(law, 1.0);
  if (!wall) {
    layout.last_step = law;
    layout.mirror.push_back(1.0);
  }
  layout.mirror.insert(layout.mirror.end(), friction - even, -1.0);
  layout.mirror.insert(layout.mirror.end(), even, 1.0);
  layout.mirror.insert(layout.mirror.end(), rolling, -1.0);
  if (models.compaction) {
    layout.gap.growth = static_cast<int>(layout.mirror.size());
    for (int k = 0; k < growth_values; ++k) layout.mirror.push_back(GrowthState<double>::turns(k) ? -1.0 : 1.0);
  }
  layout.values = static_cast<int>(layout.mirror.size());
  return layout;
}

}  // namespace epdem::lammps
