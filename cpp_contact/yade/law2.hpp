// SPDX-License-Identifier: GPL-2.0-or-later
// Law2_ScGeom_EpPhys_<Law>: one contact in one step. Motion of the bodies and history in, forces and history out.
#pragma once

#include "growth.hpp"

namespace yade {

class Law2_ScGeom_EpPhys : public LawFunctor {
 public:
  void postLoad(Law2_ScGeom_EpPhys&) {
    frictionModel_ = place_of(epdem::Frictions{}, "tangential", tangential);
    rollingModel_ = place_of(epdem::Rollings{}, "rolling", rolling);
    cohesionModel_ = place_of(epdem::Cohesions{}, "cohesion", cohesion);
    if (compaction && !compacts()) {
      compaction = false;
      throw std::invalid_argument(getClassName() + ".compaction = True: only Law2_ScGeom_EpPhys_Cavity and " +
                                  "Law2_ScGeom_EpPhys_CavityAdhesive have it");
    }
    if (compaction) frictionModel_ = grown(frictionModel_);
  }

  // clang-format off
  YADE_CLASS_BASE_DOC_ATTRS(Law2_ScGeom_EpPhys, LawFunctor,
    "Attributes of all contact laws of :yref:`EpPhys`; a simulation uses one law, a class derived from this class. With O.trackEnergy a law tallies plasticWork, contactElastic, adhesionLoss and, with partial slip, frictionWork and frictionElastic in O.energy.",
    ((string, tangential, "history", Attr::triggerPostLoad, "friction: off, no_history (dashpot of restitution es), history (one spring of stiffness 8 G* a up to Coulomb's limit, Cundall and Strack 1979), partial_slip or partial_slip_2 (partial slip of the contact circle by 3 or 2 nodes)"))
    ((string, rolling, "off", Attr::triggerPostLoad, "rolling friction: off, cdt (constant torque) or epsd2 (spring)"))
    ((bool, torsion, false, , "whether rolling friction also resists torsion"))
    ((string, cohesion, "off", Attr::triggerPostLoad, "cohesion beside a law without adhesion: off, sjkr (cohesionEnergyDensity times the area of the overlap's lens), sjkr2, or with compaction bond (cohesionEnergyDensity is its strength [Pa])"))
    ((bool, compaction, false, Attr::triggerPostLoad, "whether spheres grow at each contact by the dents of their other contacts, of cavity and cavity_adhesive; takes :yref:`EpGrowth`, Bo1_Sphere_Aabb(aabbEnlargeFactor=1.25) and Ig2_..._ScGeomGrown in place of Ig2_..._ScGeom"))
    ((bool, recordStrain, false, , "whether largestRadiusRatio and largestOverlapRatio are recorded"))
    ((Real, largestRadiusRatio, 0., Attr::readonly, "largest strain w a/R* of all contacts so far, w: share of the weaker body"))
    ((Real, largestOverlapRatio, 0., Attr::readonly, "largest w delta/R* of all contacts so far, delta: overlap")));
  // clang-format on

 protected:
  /// Whether the law has compaction.
  virtual bool compacts() const { return false; }

  /// One contact; false: it has ended.
  template <class Law>
  bool act(const ScGeom& geom, EpPhys& phys, const Interaction& contact) {
    if (phys.constantsOf != Law::id && !epdem::in_yade::unless_refused([&] { return prepare<Law>(phys, contact); }))
      return true;
    bool goes_on = false;
    epdem::Frictions::each([&](auto model, int place) {
      if (place == frictionModel_) goes_on = act<decltype(model), Law>(geom, phys, contact);
      if constexpr (epdem::compacts<Law>)
        if (grown(place) == frictionModel_) goes_on = act<decltype(model), Law, true>(geom, phys, contact);
    });
    return goes_on;
  }

 private:
  using Vec = epdem::Vec<double>;
  enum Energy { plastic, elastic, adhesion, friction, friction_elastic, energies };

  /// Place of the model with this name in its list.
  template <class Models>
  int place_of(Models, const char* attribute, const string& wanted) const {
    const int found = Models::find(wanted.c_str());
    if (found >= 0) return found;
    string names;
    Models::each([&](auto model, int place) { names += (place ? ", " : "") + string(epdem::plain_name(model.name)); });
    throw std::invalid_argument(getClassName() + "." + attribute + " = '" + wanted + "', must be one of " + names);
  }

  static Vec vec(const Vector3r& v) { return {v[0], v[1], v[2]}; }
  static Vector3r eigen(const Vec& v) { return Vector3r(v.x, v.y, v.z); }

  /// Copy values of a contact's history to `part`, and back.
  template <class Part>
  static void load(const EpPhys& phys, int at, Part& part) {
    if constexpr (!std::is_empty_v<Part>) std::memcpy(static_cast<void*>(&part), phys.history.data() + at, sizeof part);
  }
  template <class Part>
  static void store(EpPhys& phys, int at, const Part& part) {
    if constexpr (!std::is_empty_v<Part>) std::memcpy(phys.history.data() + at, &part, sizeof part);
  }
  static constexpr int friction_at = epdem::in_yade::law_history,
                       rolling_at = friction_at + epdem::in_yade::friction_history;

  /// Writes radius, stiffness, strain and energies of a step for scripts and O.energy.
  struct Observer {
    Law2_ScGeom_EpPhys& functor;
    EpPhys& phys;
    const Interaction& contact;
    bool tallies;

    template <class Law, class Energies>
    void normal(const epdem::ContactConstants<Law>& pair, double R_star, const epdem::Step<Law>& now, double overlap,
                const Energies& energies) const {
      phys.contactRadius = now.radius;
      phys.kn = epdem::normal_stiffness(pair.law.E_star, now.radius);
      const double share = epdem::larger_share(pair.bodies) / R_star;
      if (functor.recordStrain) functor.record_strain(share * now.radius, share * overlap);
      if (tallies) add(energies());
    }
    // a call, so that a contact without energies keeps the registers
    [[gnu::noinline]] void add(const epdem::NormalEnergies<double>& e) const {
      phys.elasticEnergy = e.stored;
      phys.adhesionLoss += e.adhesion_loss;
      functor.add_plastic(phys, contact, e.plastic_work_step);
      functor.add(elastic, e.stored);
      functor.add(adhesion, e.adhesion_loss);
      functor.share(phys, contact, &EpState::adhesionLoss, e.adhesion_loss);
    }
    template <class Work>
    void friction(const Work& work) const {
      if (!tallies) return;
      const auto w = work();
      phys.frictionEnergy = w.stored;
      functor.share(phys, contact, &EpState::frictionWork, w.lost);
      functor.add(Energy::friction, w.lost);
      functor.add(friction_elastic, w.stored);
    }
    template <class Any>
    void step(const Any&) const {}
  };

  /// Constants of the contact from its attributes.
  template <class Law>
  bool prepare(EpPhys& phys, const Interaction& contact) const {
    namespace iy = epdem::in_yade;
    if (epdem::adheres<Law> && cohesionModel_ != 0)
      iy::refuse(getClassName() + ".cohesion = '" + cohesion + "': the law has its adhesion already, must be off");
    if (compaction && cohesionModel_ != 0 && cohesionModel_ != epdem::bond_place)
      iy::refuse(getClassName() + ".cohesion = '" + cohesion + "': contacts with compaction have bond or none");
    if (!compaction && cohesionModel_ == epdem::bond_place)
      iy::refuse(getClassName() + ".cohesion = 'bond': it holds contacts with compaction; give compaction = True");
    if (compaction) EpFindsGrown::require(*scene, getClassName());
    double values[Law::n_parameters + 1];
    const string bodies = "bodies " + std::to_string(contact.getId1()) + " and " + std::to_string(contact.getId2());
    for (int k = 0; k < Law::n_parameters; ++k) {
      const epdem::Parameter& p = Law::parameters[k];
      values[k] = phys.lawValues[iy::place_of(p.property)];
      const epdem::Range range = epdem::range_of(p);
      if (!range.holds(values[k]))
        iy::refuse(getClassName() + ": " + p.property + " of " + bodies + " = " + epdem::number(values[k]) + ", " +
                   range.text() + " " + p.unit + "; give " + p.property + " to the EpMat of both");
    }
    if (!Law::valid(values))
      iy::refuse(getClassName() + ": the parameters of " + bodies +
                 " do not go together: " + (Law::condition ? Law::condition : ""));
    epdem::ContactConstants<Law> pair;
    pair.bodies = bodies_of<Law>(phys, contact, epdem::hardening<Law>(values));
    pair.law = Law(phys.effectiveModulus, values);
    const auto& geom = static_cast<const ScGeom&>(*contact.geom);
    const double one = geom.radius1, two = geom.radius2;
    const string refused = epdem::refused_adhesion(pair.law, phys.wall == 1 ? two
                                                             : phys.wall    ? one
                                                                            : epdem::reduced_finite(one, two));
    if (!refused.empty()) iy::refuse(getClassName() + ": " + bodies + ": " + refused);
    pair.shear_modulus = phys.effectiveShearModulus;
    pair.dashpot = epdem::viscous_number(phys.en);
    pair.damping = epdem::damping_number(phys.es);
    pair.rolling_friction = phys.rollingFriction;
    pair.cohesion_density = phys.cohesionEnergyDensity;
    new (phys.constants.bytes) epdem::ContactConstants<Law>(pair);
    if (phys.lawId != Law::id) phys.history = {};
    phys.lawId = phys.constantsOf = Law::id;
    return true;
  }

  /// Shares of the bodies; i is the first sphere.
  template <class Law>
  epdem::BodyShares<double> bodies_of(const EpPhys& phys, const Interaction& contact, double hardening) const {
    const auto material_of = [this](Body::id_t id) -> const EpMat& {
      return static_cast<const EpMat&>(*(*scene->bodies)[id]->material);
    };
    const EpMat *i = &material_of(contact.getId1()), *j = &material_of(contact.getId2());
    if (phys.wall == 1) std::swap(i, j);
    double share = 0.5;
    if constexpr (Law::strength >= 0) {
      const int at = epdem::in_yade::place_of(Law::parameters[Law::strength].property);
      share = epdem::strain_share(i->lawValues[at], j->lawValues[at], hardening);
    }
    return epdem::body_shares({i->young, i->poisson}, {j->young, j->poisson}, share);
  }

  template <class Friction, class Law, bool grows = false>
  bool act(const ScGeom& geom, EpPhys& phys, const Interaction& contact) {
    return phys.wall ? act<Friction, true, Law, grows>(geom, phys, contact)
                     : act<Friction, false, Law, grows>(geom, phys, contact);
  }

  // flatten: without it GCC copies constants, motion and history between the functions of a contact
  template <class Friction, bool wall, class Law, bool grows>
  [[gnu::flatten]] bool act(const ScGeom& geom, EpPhys& phys, const Interaction& contact) {
    const auto& bodies = *scene->bodies;
    const Body::id_t id1 = contact.getId1(), id2 = contact.getId2();
    const State &s1 = *bodies[id1]->state, &s2 = *bodies[id2]->state;
    const bool periodic = scene->isPeriodic;
    const Vec shift = periodic ? vec(scene->cell->intrShiftPos(contact.cellDist)) : Vec{};
    const Vec drift = periodic ? vec(scene->cell->intrShiftVel(contact.cellDist)) : Vec{};

    // i is the first sphere; of a wall and a sphere the sphere
    const bool swapped = wall && phys.wall == 1;
    epdem::Kinematics<double> c;
    if constexpr (wall) {
      const State &sphere = swapped ? s2 : s1, &plane = swapped ? s1 : s2;
      const Vec apart = vec(geom.contactPoint) - vec(plane.pos) - (swapped ? Vec{} : shift);
      const double radius = swapped ? geom.radius2 : geom.radius1, side = swapped ? 1.0 : -1.0;
      const Vec at_contact = vec(plane.vel) + cross(vec(plane.angVel), apart);
      c = epdem::at_wall(radius, double(geom.penetrationDepth),
                         side * (radius - geom.penetrationDepth) * vec(geom.normal),
                         vec(sphere.vel) - at_contact + side * drift, vec(sphere.angVel));
    } else {
      c = epdem::between_spheres(double(geom.radius1), double(geom.radius2), vec(s1.pos) - vec(s2.pos) - shift,
                                 vec(s1.vel) - vec(s2.vel) - drift, vec(s1.angVel), vec(s2.angVel));
    }

    auto& pair = phys.constants.of<Law>();
    pair.friction = phys.tangensOfFrictionAngle;
    using Growth = std::conditional_t<grows, epdem::Growing<wall, double>, epdem::NoGrowth>;
    epdem::ContactHistory<Law, Friction, Vec, Growth> history;
    load(phys, 0, history.law);
    // One pass with the sums of the step before, as in LIGGGHTS: a second pass of a step would need the geometry of all
    // contacts before the first force.
    if constexpr (grows) {
      const auto sums_of = [](const State& state) {
        const auto& body = static_cast<const EpState&>(state);
        return epdem::BodySums<double>{body.growth, body.dentedArea, body.pressure, body.parted};
      };
      const double* const state = &phys.history[epdem::in_yade::growth_at<Law>];
      if constexpr (wall)
        history.growth = epdem::growing_at_wall(c.radius_i, sums_of(swapped ? s2 : s1), state);
      else
        history.growth = epdem::growing_pair(c.radius_i, c.radius_j, sums_of(s1), sums_of(s2), state);
    }
    if (!(c.overlap > 0.0)) {
      constexpr epdem::GapPlaces places = epdem::gap_places<Law>(grows ? epdem::in_yade::growth_at<Law> : -1);
      epdem::Gap gap{c.distance * c.distance, c.radius_i, c.radius_j, {}, {}};
      if constexpr (grows) gap.i = history.growth.i, gap.j = history.growth.j;
      if (!epdem::exists(places, phys.history.data(), gap, false)) return false;
    }
    if (phys.frictionId == Friction::id) load(phys, friction_at, history.friction);
    phys.frictionId = Friction::id;
    if (rollingModel_ != 0) load(phys, rolling_at, history.rolling);

    const epdem::ContactSettings settings{scene->dt,          rollingModel_, cohesionModel_, pair.damping > 0.0,
                                          pair.dashpot > 0.0, torsion,       false};
    const auto loads = epdem::contact<Friction, wall>(
        pair, settings, c, history, [&] { return phys.effectiveMass; },
        Observer{*this, phys, contact, bool(scene->trackEnergy)});
    if constexpr (grows) {
      store(phys, epdem::in_yade::growth_at<Law>, history.growth.state);
      store(phys, epdem::in_yade::growth_at<Law> + epdem::growth_values, history.growth.dents);
    }
    store(phys, 0, history.law);
    store(phys, friction_at, history.friction);
    if (rollingModel_ != 0) store(phys, rolling_at, history.rolling);

    const Vec on_1 = swapped ? -loads.force : loads.force, normal = vec(geom.normal);
    const Vec normal_force = -dot(on_1, normal) * normal;
    const Vector3r force = eigen(on_1), reaction = eigen(-on_1);
    phys.ks = epdem::tangential_stiffness(pair.shear_modulus, phys.contactRadius);
    phys.normalForce = eigen(normal_force);
    phys.shearForce = eigen(-on_1 - normal_force);
    scene->forces.addForce(id1, force);
    scene->forces.addForce(id2, reaction);
    if constexpr (wall) {
      const Vec arm = vec(geom.contactPoint) - (swapped ? vec(s1.pos) : vec(s2.pos) + shift);
      scene->forces.addTorque(swapped ? id2 : id1, eigen(loads.torque_i));
      scene->forces.addTorque(swapped ? id1 : id2, eigen(cross(arm, -loads.force) + loads.torque_j));
    } else {
      scene->forces.addTorque(id1, eigen(loads.torque_i));
      scene->forces.addTorque(id2, eigen(loads.torque_j));
    }
    bool attached = true;
    if constexpr (epdem::adheres<Law>) attached = c.overlap > 0.0 || history.law.root > 0.0;
    return grows || attached;
  }

  /// Adds plastic work of a step [J].
  [[gnu::noinline]] void add_plastic(EpPhys& phys, const Interaction& contact, double work) {
    phys.plasticWork += work;
    add(plastic, work);
    share(phys, contact, &EpState::plasticWork, work);
  }

  /// Adds to an energy of O.energy. One thread creates all names before any thread adds.
  [[gnu::noinline]] void add(Energy which, double value) {
    static constexpr const char* names[energies] = {"plasticWork", "contactElastic", "adhesionLoss", "frictionWork",
                                                    "frictionElastic"};
    static constexpr bool momentary[energies] = {false, true, false, false, true};
    if (!added_.load(std::memory_order_acquire)) {
#ifdef YADE_OPENMP
#pragma omp critical(epdem_energies)
#endif
      if (!added_.load(std::memory_order_relaxed)) {
        for (int k = 0; k < energies; ++k) scene->energy->findId(names[k], energyId_[k], momentary[k]);
        added_.store(true, std::memory_order_release);
      }
    }
    scene->energy->add(value, names[which], energyId_[which], momentary[which]);
  }

  /// Adds the work of a contact to the work of its spheres.
  [[gnu::noinline]] void share(const EpPhys& phys, const Interaction& contact, Real EpState::* work,
                               double value) const {
    if (value == 0.0) return;
    for (const int k : {1, 2}) {
      if (phys.wall == k) continue;
      const Body::id_t id = k == 1 ? contact.getId1() : contact.getId2();
      auto* const state = dynamic_cast<EpState*>((*scene->bodies)[id]->state.get());
      if (!state) continue;  // a body that got its material later
      Real& sum = state->*work;
#ifdef YADE_OPENMP
#pragma omp atomic
#endif
      sum += phys.wall ? value : 0.5 * value;
    }
  }

  /// Notes how far a contact leaves small strain.
  [[gnu::noinline]] void record_strain(double radius_ratio, double overlap_ratio) {
    if (radius_ratio <= largestRadiusRatio && overlap_ratio <= largestOverlapRatio) return;
#ifdef YADE_OPENMP
#pragma omp critical(epdem_strain)
#endif
    {
      largestRadiusRatio = std::max<Real>(largestRadiusRatio, radius_ratio);
      largestOverlapRatio = std::max<Real>(largestOverlapRatio, overlap_ratio);
    }
  }

  /// The friction model at this place with compaction, so that one choice of a contact takes both.
  static constexpr int grown(int place) { return -1 - place; }

  int frictionModel_ = epdem::Frictions::place(epdem::SlidingSpring::id), rollingModel_ = 0, cohesionModel_ = 0;
  std::atomic<bool> added_{false};
  int energyId_[energies] = {-1, -1, -1, -1, -1};
};
REGISTER_SERIALIZABLE(Law2_ScGeom_EpPhys);

/// The text that YADE's help shows of a law.
template <class Law>
const char* law_text() {
  static const std::string text =
      std::string("Contact law `") + Law::name + "` (" + Law::title + "; " + Law::sources +
      ") of :yref:`EpPhys`; its attributes belong to the base class :yref:`Law2_ScGeom_EpPhys`.";
  return text.c_str();
}

#define EPDEM_LAW2(Class)                                                                                   \
  class Law2_ScGeom_EpPhys_##Class : public Law2_ScGeom_EpPhys {                                            \
   public:                                                                                                  \
    bool go(shared_ptr<IGeom>& geom, shared_ptr<IPhys>& phys, Interaction* contact) override {              \
      return act<epdem::Class<double>>(static_cast<ScGeom&>(*geom), static_cast<EpPhys&>(*phys), *contact); \
    }                                                                                                       \
    bool compacts() const override { return epdem::compacts<epdem::Class<double>>; }                        \
    FUNCTOR2D(ScGeom, EpPhys);                                                                              \
    YADE_CLASS_BASE_DOC(Law2_ScGeom_EpPhys_##Class, Law2_ScGeom_EpPhys, law_text<epdem::Class<double>>());  \
  };                                                                                                        \
  REGISTER_SERIALIZABLE(Law2_ScGeom_EpPhys_##Class);
EPDEM_LAWS(EPDEM_LAW2)
#undef EPDEM_LAW2

}  // namespace yade
