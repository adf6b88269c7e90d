// SPDX-License-Identifier: GPL-2.0-or-later
#include "materials.hpp"

#include <memory>

#include "adhesion.hpp"
#include "epdem/tangential.hpp"
#include "epdem/viscous.hpp"
#include "force.h"
#include "global_properties.h"
#include "simulation.hpp"
#include "update.h"

namespace epdem::liggghts {

namespace {

/// A law's parameter for every pair of types. A value per type is that of the softer body: the body with the smaller
/// first parameter yields, and its other parameters go with it.
class ParameterTable {
 public:
  ParameterTable(const Reader& reader, const Parameter& p, const Adhesion* adhesion)
      : reader_(reader), p_(p), range_(range_of(p)) {
    if (p.property == std::string(adhesion_name)) {
      adhesion_ = adhesion;
      return;
    }
    if (!std::isnan(p.fallback)) {
      if (FixPropertyGlobal* scalar = reader.find(p.property, "scalar")) {
        common_ = reader.checked(p.property, p.unit, "all types", scalar->compute_scalar(), range_);
        return;
      }
    }
    pairs_ = reader.find(p.property, "peratomtypepair");
    if (pairs_) return;
    if (!std::isnan(p.fallback) && !reader.find(p.property, "peratomtype")) {
      common_ = p.fallback;
      return;
    }
    values_ = reader.per_type(p.property, p.unit, range_);
  }

  bool per_type() const { return !values_.empty(); }
  double of_type(int i) const { return values_[i]; }

  double at(int i, int j) const {
    if (adhesion_) return adhesion_->at(i, j);
    if (!pairs_) return common_;
    return reader_.of_pair(pairs_, p_.property, p_.unit, i, j, range_);
  }

 private:
  const Reader& reader_;
  const Parameter& p_;
  const Range range_;
  const Adhesion* adhesion_ = nullptr;
  FixPropertyGlobal* pairs_ = nullptr;
  std::vector<double> values_;
  double common_ = 0.0;
};

/// Strength over E* above which a contact yields at overlaps beyond the range of the laws only (2.5 % of R*).
constexpr double elastic_share = 0.1;
/// A strength [Pa] of this size says that a body never yields.
constexpr double rigid_strength = 1e25;

/// A strength as a ratio, which has a default, of the yield stress.
constexpr const char* ratio_name = "yieldPressureRatio";
constexpr Parameter yield_stress = {"yield_stress", "yieldStress", "Y", "Pa", not_given};

/// Properties that the deck must have: the law's parameters, or the yield stress in place of the strength, and the
/// ratio last.
struct RequiredProperties {
  std::vector<Parameter> parameters;
  bool by_ratio;
};

/// A yield stress beside a strength may belong to another model of the deck: the strength counts.
RequiredProperties required_properties(const Reader& reader, const Declaration& law) {
  RequiredProperties q{{law.parameters, law.parameters + law.count}, false};
  if (!law.strength_by_ratio) return q;
  const Parameter pressure = law.parameters[law.strength];
  const bool ratio = reader.given(ratio_name);
  if (reader.given(pressure.property)) {
    if (ratio) reader.fail(std::string("both ") + pressure.property + " and " + ratio_name + " are given; keep one");
    return q;
  }
  if (!ratio && !reader.given(yield_stress.property))
    reader.fail(reader.missing(pressure.property, pressure.unit) + " (or " + yield_stress.property + ", of which " +
                pressure.property + " is " + number(law.default_ratio) + " times, or " + ratio_name + ")");
  q.parameters[law.strength] = yield_stress;
  q.parameters.push_back({"yield_pressure_ratio", ratio_name, "ratio", "1", law.default_ratio});
  q.by_ratio = true;
  return q;
}

/// The law's parameters for one pair of types; `pascal` is the deck's unit of pressure.
std::vector<double> parameters_of(const Reader& reader, const Declaration& law, const RequiredProperties& required,
                                  const std::vector<ParameterTable>& tables, double pascal, int i, int j) {
  std::vector<double> values;
  // equal strength: the smaller type number, so that swapping i and j changes nothing
  const int low = std::min(i, j), high = std::max(i, j);
  const ParameterTable* const strength = law.strength < 0 ? nullptr : &tables[law.strength];
  const bool strength_per_type = strength && strength->per_type();
  const int softer = !strength_per_type || is_softer(strength->of_type(low), strength->of_type(high)) ? low : high;
  for (size_t k = 0; k < tables.size(); ++k) {
    const ParameterTable& t = tables[k];
    if (!t.per_type()) {
      values.push_back(t.at(i, j));
      continue;
    }
    if (strength && !strength_per_type && t.of_type(i) != t.of_type(j))
      reader.fail(std::string(required.parameters[k].property) + " per type and " +
                  required.parameters[law.strength].property + " per pair leave open which body of " + both(i, j) +
                  " is the softer one; give both per pair");
    values.push_back(t.of_type(softer));
  }
  const std::vector<double> as_given = values;
  for (size_t k = 0; k < values.size(); ++k)
    if (std::string(required.parameters[k].unit) == "Pa") values[k] *= pascal;
  if (required.by_ratio) {
    values[law.strength] = strength_from(values[law.strength], values.back());
    values.pop_back();
  }
  if (law.valid(values.data())) return values;
  std::string text;
  for (size_t k = 0; k < as_given.size(); ++k)
    text += std::string(k ? ", " : "") + required.parameters[k].property + " = " + number(as_given[k]);
  reader.fail(text + " of " + both(i, j) + " do not go together: the law would create energy at yield");
}

/// The strain share of body i of a pair; a strength that is given per pair or for all is the strength of both.
double strain_share_of(const Declaration& law, const std::vector<ParameterTable>& tables,
                       const std::vector<double>& parameters, int i, int j) {
  if (law.strength < 0 || !tables[law.strength].per_type()) return 0.5;
  const ParameterTable& strength = tables[law.strength];
  return strain_share(strength.of_type(i), strength.of_type(j), law.hardening(parameters.data()));
}

/// A number that follows from the restitution of each pair of types; 0 where none is given, if `needed` does not say
/// why one must be.
std::vector<double> of_restitution(const Reader& reader, double (*number_of)(double), Range range,
                                   const char* needed = nullptr) {
  const int n = reader.types();
  std::vector<double> numbers((n + 1) * (n + 1), 0.0);
  FixPropertyGlobal* const e = reader.find("coefficientRestitution", "peratomtypepair");
  if (!e && needed) reader.fail(needed);
  for (int i = 1; e && i <= n; ++i)
    for (int j = 1; j <= n; ++j)
      numbers[i * (n + 1) + j] =
          number_of(reader.checked("coefficientRestitution", "1", both(i, j), e->compute_array(i - 1, j - 1), range));
  return numbers;
}

std::vector<double> damping_numbers(const Reader& reader, Dashpot dashpot) {
  return of_restitution(reader, damping_number, {0.0, 1.0, false, true},
                        dashpot == Dashpot::required
                            ? "tangential no_history needs coefficientRestitution (peratomtypepair): its only force is "
                              "the dashpot that follows from it; the normal force does not use it"
                            : nullptr);
}

std::vector<double> viscous_numbers(const Reader& reader) {
  return of_restitution(reader, viscous_number, {viscous_restitution_min, 1.0, true, true},
                        "viscous on needs coefficientRestitution (peratomtypepair), the restitution of slow impacts "
                        "that do not yield");
}

/// Names the first pair of types whose strength lies so high above the modulus that the contact does not yield.
void compare_strength(LAMMPS_NS::LAMMPS* lmp, const Declaration& law, const Materials& m) {
  if (law.strength < 0) return;
  for (int i = 1; i < m.width; ++i)
    for (int j = i; j < m.width; ++j) {
      const PairOfTypes& p = m.pairs[i * m.width + j];
      const double strength = p.parameters[law.strength], share = strength / effective_modulus(p.i, p.j);
      if (!(share > elastic_share) || strength >= rigid_strength) continue;
      const char* const name = law.parameters[law.strength].property;
      return say_once(lmp, "epdem: " + law.model + ": " + name + " of " + both(i, j) + " is " + number(share) +
                               " E*, above " + number(elastic_share) + " E*: the contacts are elastic " +
                               (share < 1.0 ? "up to an overlap of 2.5 % of R* or more" : "at any overlap") +
                               "; give youngsModulus its real value");
    }
}

/// Names the effect of a restitution, which damps the normal force in LIGGGHTS's own models.
void explain_restitution(LAMMPS_NS::LAMMPS* lmp, const Reader& reader, const Declaration& law, Dashpot dashpot) {
  if (!reader.given("coefficientRestitution")) return;
  const char* const effect = dashpot == Dashpot::off ? " has no effect" : " acts on the tangential dashpot only";
  say_once(lmp, std::string("epdem: ") + law.model + ": coefficientRestitution" + effect +
                    "; the setting 'viscous on' adds the normal dashpot");
}

}  // namespace

Materials read_materials(LAMMPS_NS::LAMMPS* lmp, PropertyRegistry& registry, const Declaration& law, Dashpot dashpot,
                         bool viscous) {
  const Reader reader(lmp, registry, law);
  const int n = reader.types(), width = n + 1;
  const std::vector<double> E = reader.per_type("youngsModulus", "Pa", {0.0, unlimited});
  const std::vector<double> nu = reader.per_type("poissonsRatio", "1", {0.0, 0.5, true, true});
  // LIGGGHTS's own limits on the modulus (soft_particles, hard_particles) hold for every model of a simulation
  registry.registerProperty("youngsModulus", &MODEL_PARAMS::createYoungsModulus, law.model.c_str());
  registry.getVectorProperty("youngsModulus", law.model.c_str());

  if (!law.adheres) refuse_adhesion(reader, law);
  const std::unique_ptr<Adhesion> adhesion(law.adheres ? new Adhesion(reader) : nullptr);
  const RequiredProperties required = required_properties(reader, law);
  std::vector<ParameterTable> tables;
  tables.reserve(required.parameters.size());
  for (const Parameter& p : required.parameters) tables.emplace_back(reader, p, adhesion.get());
  const std::vector<double> none(width * width, 0.0);
  const std::vector<double> beta = dashpot == Dashpot::off ? none : damping_numbers(reader, dashpot);
  const std::vector<double> dashpots = viscous ? viscous_numbers(reader) : none;

  const double pascal = 1.0 / lmp->force->nktv2p;  // pressure unit of the deck in force/length^2
  Materials materials{width, std::vector<PairOfTypes>(width * width)};
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= n; ++j) {
      const std::vector<double> parameters = parameters_of(reader, law, required, tables, pascal, i, j);
      materials.pairs[i * width + j] = {
          {E[i] * pascal, nu[i]}, {E[j] * pascal, nu[j]}, parameters, strain_share_of(law, tables, parameters, i, j),
          beta[i * width + j],    dashpots[i * width + j]};
    }
  compare_strength(lmp, law, materials);
  if (!viscous) explain_restitution(lmp, reader, law, dashpot);
  return materials;
}

}  // namespace epdem::liggghts
