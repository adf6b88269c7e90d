// SPDX-License-Identifier: GPL-2.0-or-later
// EpMat: YADE's FrictMat with the parameters of all laws; EpState: the work of a body's contacts.
#pragma once

#include <functional>
#include <vector>

#include "parameters.hpp"

namespace yade {

using epdem::in_yade::LawValues;
using EpMemory = std::array<double, epdem::memory_values>;

class EpState : public State {
 public:
  virtual ~EpState() = default;

  // clang-format off
  YADE_CLASS_BASE_DOC_ATTRS_CTOR(EpState, State,
    "State of a body of :yref:`EpMat`. With O.trackEnergy it sums up the work of the body's contacts: half of the work of a contact with a sphere, the whole work of a contact with a wall.",
    ((Real, plasticWork, 0., , "plastic work [J]"))
    ((Real, adhesionLoss, 0., , "energy that adhesion lost [J]"))
    ((Real, frictionWork, 0., , "work of friction [J], with partial slip"))
    ((Real, growth, 0., Attr::readonly, "growth of the sphere over its radius by the dents of its contacts, with compaction"))
    ((Real, dentedArea, 0., Attr::readonly, "sum of the areas of its contacts that yield [m^2], with compaction"))
    ((Real, pressure, 0., Attr::readonly, "largest mean pressure by its contacts so far [Pa], with compaction"))
    ((Real, parted, 0., Attr::readonly, "share of its recovery that parted contacts have taken, with compaction"))
    ((EpMemory, memory, EpMemory(), Attr::hidden, "what the body keeps of its contacts, with compaction")),
    createIndex(););
  // clang-format on
  REGISTER_CLASS_INDEX(EpState, State);
};
REGISTER_SERIALIZABLE(EpState);

class EpMat : public FrictMat {
 public:
  /// An attribute whose value is checked when Python sets it.
  struct Attribute {
    std::string name, unit, meaning;
    epdem::Range range;
    std::function<Real&(EpMat&)> value;
  };

  /// Gives the Python class its checked attributes.
  struct Properties : boost::python::def_visitor<Properties> {
    template <class Class>
    void visit(Class& python) const {
      namespace py = boost::python;
      for (const Attribute& a : attributes()) {
        const auto get = [&a](EpMat& m) { return a.value(m); };
        const auto set = [&a](EpMat& m, double value) { m.set(a, value); };
        python.add_property(
            a.name.c_str(), py::make_function(get, py::default_call_policies(), boost::mpl::vector<double, EpMat&>()),
            py::make_function(set, py::default_call_policies(), boost::mpl::vector<void, EpMat&, double>()),
            (a.meaning + (a.unit == "1" ? "" : " [" + a.unit + "]") + "; " + a.range.text()).c_str());
      }
    }
  };

  virtual ~EpMat() = default;

  shared_ptr<State> newAssocState() const override { return boost::make_shared<EpState>(); }

  static const std::vector<Attribute>& attributes() {
    static const std::vector<Attribute> all = declared();
    return all;
  }

  void set(const Attribute& attribute, double value) {
    if (!attribute.range.holds(value))
      throw std::invalid_argument("EpMat." + attribute.name + " = " + epdem::number(value) + ", " +
                                  attribute.range.text() + (attribute.unit == "1" ? "" : " " + attribute.unit));
    attribute.value(*this) = value;
  }

  void pyHandleCustomCtorArgs(boost::python::tuple&, boost::python::dict& keywords) override {
    for (const Attribute& a : attributes())
      if (keywords.has_key(a.name)) {
        set(a, boost::python::extract<double>(keywords[a.name]));
        keywords[a.name].del();
      }
  }

  boost::python::dict pyDictCustom() const override {
    namespace iy = epdem::in_yade;
    boost::python::dict all;
    for (int k = 0; k < iy::parameter_count; ++k)
      if (iy::is_first(k) && !iy::parameters[k].declared->of_pair)
        all[iy::parameters[k].declared->property] = lawValues[k];
    return all;
  }

  // clang-format off
  YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(EpMat, FrictMat,
    "Elastic-plastic material: the parameters of all contact laws of :yref:`Law2_ScGeom_EpPhys`. A law reads its own parameters; the body with the lower strength yields.",
    ((Real, surfaceEnergy, 0., , "surface energy gamma; the work of adhesion of two bodies is twice the geometric mean of both"))
    ((Real, rollingFriction, 0., , "coefficient of rolling friction"))
    ((LawValues, lawValues, epdem::in_yade::fallbacks(), Attr::hidden, "parameters of the laws")),
    createIndex();,
    .def(Properties()));
  // clang-format on
  REGISTER_CLASS_INDEX(EpMat, FrictMat);

 private:
  static std::vector<Attribute> declared() {
    namespace iy = epdem::in_yade;
    const double right_angle = std::atan(epdem::unlimited);
    std::vector<Attribute> all = {
        {"young",
         "Pa",
         "Young's modulus; inf: rigid",
         {0.0, epdem::unlimited, false, true},
         [](EpMat& m) -> Real& { return m.young; }},
        {"poisson", "1", "Poisson's ratio", {-1.0, 0.5, false, true}, [](EpMat& m) -> Real& { return m.poisson; }},
        {"density", "kg/m^3", "density", {0.0, epdem::unlimited}, [](EpMat& m) -> Real& { return m.density; }},
        {"frictionAngle",
         "rad",
         "angle of friction",
         {0.0, right_angle, true},
         [](EpMat& m) -> Real& { return m.frictionAngle; }},
        {"surfaceEnergy",
         "J/m^2",
         "surface energy gamma; the work of adhesion of two bodies is twice the geometric mean of both",
         {0.0, epdem::unlimited, true},
         [](EpMat& m) -> Real& { return m.surfaceEnergy; }},
        {"rollingFriction",
         "1",
         "coefficient of rolling friction",
         {0.0, epdem::unlimited, true},
         [](EpMat& m) -> Real& { return m.rollingFriction; }}};
    for (int k = 0; k < iy::parameter_count; ++k) {
      const epdem::Parameter& p = *iy::parameters[k].declared;
      if (iy::is_first(k) && !p.of_pair)
        all.push_back({p.property, p.unit, std::string(p.symbol) + " of " + iy::laws_with(p.property),
                       iy::range_of_body(p), [k](EpMat& m) -> Real& { return m.lawValues[k]; }});
    }
    return all;
  }
};
REGISTER_SERIALIZABLE(EpMat);

}  // namespace yade
