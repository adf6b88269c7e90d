// SPDX-License-Identifier: GPL-2.0-or-later
// Ip2_EpMat_EpMat_EpPhys: the contact of two materials.
#pragma once

#include <core/InteractionLoop.hpp>

#include "contact_phys.hpp"

namespace yade {

class Ip2_EpMat_EpMat_EpPhys : public IPhysFunctor {
 public:
  void go(const shared_ptr<Material>& b1, const shared_ptr<Material>& b2,
          const shared_ptr<Interaction>& contact) override {
    if (contact->phys) return;
    epdem::in_yade::unless_refused([&] {
      try {
        require_one_law();
        contact->phys = pair(static_cast<const EpMat&>(*b1), static_cast<const EpMat&>(*b2), *contact);
      } catch (const std::exception& error) {
        contact->phys = boost::make_shared<EpPhys>();  // YADE ends a run where a contact has none
        epdem::in_yade::refuse(std::string("Ip2_EpMat_EpMat_EpPhys: ") + error.what());
      }
      return true;
    });
  }

  FUNCTOR2D(EpMat, EpMat);
  // clang-format off
  YADE_CLASS_BASE_DOC_ATTRS(Ip2_EpMat_EpMat_EpPhys, IPhysFunctor,
    "Makes the :yref:`EpPhys` of two :yref:`EpMat`. Values of pairs are given by :yref:`MatchMaker` or as one number.",
    ((shared_ptr<MatchMaker>, frictAngle, , , "angle of friction [rad]; default: the smaller of both"))
    ((shared_ptr<MatchMaker>, en, , , "restitution of impacts without yield, in [0.14, 1]: a normal dashpot; default: no dashpot"))
    ((shared_ptr<MatchMaker>, es, , , "restitution of the dashpot beside friction, in (0, 1]; default: no dashpot"))
    ((shared_ptr<MatchMaker>, rollingFriction, , , "coefficient of rolling friction; default: the smaller of both"))
    ((shared_ptr<MatchMaker>, cohesionEnergyDensity, , , "energy density of the law's cohesion [J/m^3]; default: 0"))
    ((shared_ptr<MatchMaker>, workOfAdhesion, , , "work of adhesion [J/m^2]; default: twice the geometric mean of both surface energies")));
  // clang-format on

 private:
  /// Refuses a contact unless one law of these contacts is among the engines: without it YADE's own law reads a
  /// stiffness of 0, and of two YADE takes the last.
  void require_one_law() const {
    string names;
    int laws = 0;
    for (const auto& engine : scene->engines) {
      const auto* const loop = dynamic_cast<const InteractionLoop*>(engine.get());
      const auto* const laws_of = loop ? loop->lawDispatcher.get() : dynamic_cast<const LawDispatcher*>(engine.get());
      if (!laws_of || engine->dead) continue;
      for (const auto& functor : laws_of->functors) {
        const string name = functor->getClassName();
        laws += name.rfind("Law2_ScGeom_EpPhys_", 0) == 0;
        names += (names.empty() ? "" : ", ") + name;
      }
    }
    if (laws != 1)
      throw std::invalid_argument("laws of the engines = [" + names + "], must have one Law2_ScGeom_EpPhys_<Law>; " +
                                  (laws ? "keep one" : "add one"));
  }

  static double checked(const char* name, double value, const epdem::Range& range, const Interaction& i) {
    if (!range.holds(value))
      throw std::invalid_argument(std::string(name) + " of bodies " + std::to_string(i.getId1()) + " and " +
                                  std::to_string(i.getId2()) + " = " + epdem::number(value) + ", " + range.text());
    return value;
  }

  /// The value of a matchmaker, which knows the numbers of materials, or its default.
  static double of_pair(const shared_ptr<MatchMaker>& match, const EpMat& m1, const EpMat& m2, double v1, double v2,
                        double other) {
    return match ? (*match)(m1.id, m2.id, v1, v2) : other;
  }

  /// 1 or 2: this body is a wall; 0: both are spheres.
  int wall_of(const Interaction& i) const {
    const auto kind = [&](Body::id_t id) { return Body::byId(id, scene)->shape->getClassName(); };
    const auto is_wall = [](const string& s) { return s == "Wall" || s == "Facet" || s == "Box"; };
    const string first = kind(i.getId1()), second = kind(i.getId2());
    if (first == "Sphere" && second == "Sphere") return 0;
    if (second == "Sphere" && is_wall(first)) return 1;
    if (first == "Sphere" && is_wall(second)) return 2;
    throw std::invalid_argument("bodies " + std::to_string(i.getId1()) + " (" + first + ") and " +
                                std::to_string(i.getId2()) + " (" + second +
                                ") touch, contacts are between spheres or of a sphere with a Wall, Facet or Box");
  }

  /// Mass of the body that moves [kg], infinite if it is not dynamic.
  double mass_of(Body::id_t id) const {
    const Body* body = Body::byId(id, scene).get();
    if (body->isClumpMember()) body = Body::byId(body->clumpId, scene).get();
    return body->isDynamic() ? body->state->mass : epdem::unlimited;
  }

  shared_ptr<EpPhys> pair(const EpMat& m1, const EpMat& m2, const Interaction& i) const {
    namespace iy = epdem::in_yade;
    const epdem::Elastic e1{m1.young, m1.poisson}, e2{m2.young, m2.poisson};
    const auto phys = boost::make_shared<EpPhys>();
    phys->wall = wall_of(i);
    phys->effectiveModulus = epdem::effective_modulus(e1, e2);
    phys->effectiveShearModulus = epdem::effective_shear_modulus(e1, e2);
    const double mass1 = mass_of(i.getId1()), mass2 = mass_of(i.getId2());
    if (std::isinf(mass1) || std::isinf(mass2)) {
      const double mass = std::min(mass1, mass2);
      phys->effectiveMass = std::isinf(mass) ? 0.0 : mass;  // of two bodies that do not move: no dashpot
    } else {
      phys->effectiveMass = epdem::reduced_finite(mass1, mass2);
    }
    const double angle =
        of_pair(frictAngle, m1, m2, m1.frictionAngle, m2.frictionAngle, std::min(m1.frictionAngle, m2.frictionAngle));
    phys->tangensOfFrictionAngle = std::tan(checked("frictAngle", angle, {0.0, std::atan(epdem::unlimited), true}, i));
    phys->en = checked("en", of_pair(en, m1, m2, NaN, NaN, 1.0), {epdem::viscous_restitution_min, 1.0, true, true}, i);
    phys->es = checked("es", of_pair(es, m1, m2, NaN, NaN, 1.0), {0.0, 1.0, false, true}, i);
    const double rolling = of_pair(rollingFriction, m1, m2, m1.rollingFriction, m2.rollingFriction,
                                   std::min(m1.rollingFriction, m2.rollingFriction));
    phys->rollingFriction = checked("rollingFriction", rolling, {0.0, epdem::unlimited, true}, i);
    phys->cohesionEnergyDensity =
        checked("cohesionEnergyDensity", of_pair(cohesionEnergyDensity, m1, m2, NaN, NaN, 0.0),
                {0.0, epdem::unlimited, true}, i);
    for (int k = 0; k < iy::parameter_count; ++k) {
      if (!iy::is_first(k)) continue;
      const iy::LawParameter& p = iy::parameters[k];
      phys->lawValues[k] = p.declared->of_pair
                               ? of_pair(workOfAdhesion, m1, m2, NaN, NaN,
                                         epdem::adhesive::work_of_adhesion(m1.surfaceEnergy, m2.surfaceEnergy))
                               : softer(p, m1, m2).lawValues[k];
    }
    return phys;
  }

  /// The body with the lower strength; at equal strength, or without strength, the body of the first material.
  static const EpMat& softer(const epdem::in_yade::LawParameter& p, const EpMat& m1, const EpMat& m2) {
    if (!p.strength) return m1;
    const int at = epdem::in_yade::place_of(p.strength);
    const double s1 = m1.lawValues[at], s2 = m2.lawValues[at];
    if (s2 == s1 && m2.id < m1.id) return m2;
    return std::isnan(s2) || !epdem::is_softer(s1, s2) ? m2 : m1;
  }
};
REGISTER_SERIALIZABLE(Ip2_EpMat_EpMat_EpPhys);

}  // namespace yade
