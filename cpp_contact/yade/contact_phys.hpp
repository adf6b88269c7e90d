// SPDX-License-Identifier: GPL-2.0-or-later
// EpPhys: history and constants of a contact, and their names in scripts.
#pragma once

#include <set>

#include "material.hpp"

namespace yade {

using EpHistory = epdem::in_yade::History;

class EpPhys : public FrictPhys {
 public:
  /// Gives the Python class the history by the names of the laws and the parameters of the pair.
  struct Properties : boost::python::def_visitor<Properties> {
    template <class Class>
    void visit(Class& python) const {
      namespace iy = epdem::in_yade;
      for (const std::string& slot : slots())
        add(python, iy::camel(slot), slot + " of the law's history; nan: the law has none",
            [slot](EpPhys& p) { return p.kept(slot); });
      add(python, "addedOverlap", "overlap [m] that the growth of the bodies adds, with compaction",
          [](EpPhys& p) { return p.addedOverlap(); });
      add(python, "screening", "elastic recovery over that of the contact alone, with compaction; 0: a new contact",
          [](EpPhys& p) { return p.screening(); });
      add(python, "grownOverlap", "overlap [m] of addedOverlap by the dents of other contacts",
          [](EpPhys& p) { return p.grownOverlap(); });
      add(python, "bodyPressure", "pressure [Pa] of the bodies that their growth carries, with compaction",
          [](EpPhys& p) { return p.bodyPressure(); });
      add(python, "brokenBond", "1: the bond of this contact has broken", [](EpPhys& p) { return p.brokenBond(); });
      add(python, "retreat", "overlap [m] that other contacts take as they part, with compaction",
          [](EpPhys& p) { return p.retreat(); });
      for (int k = 0; k < iy::parameter_count; ++k)
        if (iy::is_first(k)) {
          const epdem::Parameter& p = *iy::parameters[k].declared;
          add(python, p.property,
              std::string(p.symbol) + " of the pair [" + p.unit + "], of " + iy::laws_with(p.property),
              [k](EpPhys& phys) { return phys.lawValues[k]; });
        }
    }

   private:
    template <class Class, class Get>
    static void add(Class& python, const std::string& name, const std::string& text, Get get) {
      namespace py = boost::python;
      python.add_property(name.c_str(),
                          py::make_function(get, py::default_call_policies(), boost::mpl::vector<double, EpPhys&>()),
                          text.c_str());
    }
  };

  virtual ~EpPhys() = default;

  /// Names of the values that the laws keep.
  static std::set<std::string> slots() {
    std::set<std::string> all;
#define EPDEM_SLOTS(Class) \
  for (const char* slot : epdem::Class<double>::State::slots) all.insert(slot);
    EPDEM_LAWS(EPDEM_SLOTS)
#undef EPDEM_SLOTS
    return all;
  }

  /// The value that the law of this contact keeps under this name, nan if there is none.
  double kept(const std::string& slot) const {
    double value = NaN;
#define EPDEM_KEPT(Class) \
  if (lawId == epdem::Class<double>::id) value = kept_by<epdem::Class<double>>(slot);
    EPDEM_LAWS(EPDEM_KEPT)
#undef EPDEM_KEPT
    return value;
  }

  /// Where the history has the values of growth; -1: the law has no compaction.
  int growthAt() const {
    int at = -1;
#define EPDEM_GROWTH_AT(Class)                                                    \
  if (epdem::compacts<epdem::Class<double>> && lawId == epdem::Class<double>::id) \
    at = epdem::in_yade::growth_at<epdem::Class<double>>;
    EPDEM_LAWS(EPDEM_GROWTH_AT)
#undef EPDEM_GROWTH_AT
    return at;
  }
  double addedOverlap() const { return growthAt() < 0 ? 0.0 : epdem::added_overlap_of(&history[growthAt()]); }
  double screening() const { return growthAt() < 0 ? 0.0 : epdem::screening_of(&history[growthAt()]); }
  double grownOverlap() const { return growthAt() < 0 ? 0.0 : epdem::grown_overlap_of(&history[growthAt()]); }
  double bodyPressure() const { return growthAt() < 0 ? 0.0 : epdem::body_pressure_of(&history[growthAt()]); }
  double brokenBond() const { return growthAt() < 0 ? 0.0 : epdem::broken_of(&history[growthAt()]); }
  double retreat() const { return growthAt() < 0 ? 0.0 : epdem::retreat_of(&history[growthAt()]); }

  boost::python::dict pyDictCustom() const override {
    namespace iy = epdem::in_yade;
    boost::python::dict all;
    for (const std::string& slot : slots()) all[iy::camel(slot)] = kept(slot);
    for (int k = 0; k < iy::parameter_count; ++k)
      if (iy::is_first(k)) all[iy::parameters[k].declared->property] = lawValues[k];
    return all;
  }

  // What each step reads comes first, so that it shares lines of the cache.
  // the constants of the law `constantsOf`, 0: none; they follow from the attributes
  epdem::in_yade::Constants constants{};
  int constantsOf = 0;

  // clang-format off
  YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(EpPhys, FrictPhys,
    "Contact of two :yref:`EpMat`: constants of the pair and history.",
    ((int, wall, 0, Attr::readonly, "which body is no sphere, 1 or 2; 0: both are spheres"))
    ((int, lawId, 0, Attr::hidden, "number of the law whose history is kept"))
    ((int, frictionId, 0, Attr::hidden, "number of the friction model whose history is kept"))
    ((Real, contactRadius, 0., Attr::readonly, "contact radius a [m]"))
    ((EpHistory, history, EpHistory(), Attr::hidden, "history of law, friction and rolling friction"))
    ((Real, effectiveMass, NaN, Attr::readonly, "m* [kg]; clumps count as a whole, bodies that are not dynamic as walls; 0: neither is dynamic"))
    ((Real, effectiveModulus, NaN, Attr::readonly, "E* [Pa]"))
    ((Real, effectiveShearModulus, NaN, Attr::readonly, "G* [Pa]"))
    ((Real, en, 1., Attr::readonly, "restitution of the normal dashpot in slow impacts without yield; 1: none"))
    ((Real, es, 1., Attr::readonly, "restitution of the dashpot beside friction; 1: none"))
    ((Real, rollingFriction, 0., Attr::readonly, "coefficient of rolling friction"))
    ((Real, cohesionEnergyDensity, 0., Attr::readonly, "energy density of cohesion [J/m^3], strength of a bond [Pa]"))
    ((Real, plasticWork, 0., Attr::readonly, "plastic work of this contact so far [J], with O.trackEnergy"))
    ((Real, elasticEnergy, 0., Attr::readonly, "elastic energy [J] of the normal force, with O.trackEnergy; with adhesion less the surface energy"))
    ((Real, adhesionLoss, 0., Attr::readonly, "energy that adhesion lost in touch and parting [J], with O.trackEnergy"))
    ((Real, frictionEnergy, 0., Attr::readonly, "elastic energy of friction [J], with O.trackEnergy and partial slip"))
    ((LawValues, lawValues, epdem::in_yade::fallbacks(), Attr::hidden, "parameters of the pair")),
    createIndex();,
    .def(Properties()));
  // clang-format on
  REGISTER_CLASS_INDEX(EpPhys, FrictPhys);

 private:
  template <class Law>
  double kept_by(const std::string& slot) const {
    constexpr auto& names = Law::State::slots;
    for (size_t k = 0; k < std::size(names); ++k)
      if (slot == names[k]) return history[k];
    return NaN;
  }
};
REGISTER_SERIALIZABLE(EpPhys);

}  // namespace yade
