// SPDX-License-Identifier: GPL-2.0-or-later
// Compaction: growth of the spheres by the dents of their contacts, and Ig2 functors that find contacts of grown
// spheres.
#pragma once

#include <core/GlobalEngine.hpp>
#include <core/InteractionLoop.hpp>
#include <pkg/common/Bo1_Aabb.hpp>
#include <pkg/common/Collider.hpp>
#include <pkg/dem/Ig2_Box_Sphere_ScGeom.hpp>
#include <pkg/dem/Ig2_Facet_Sphere_ScGeom.hpp>
#include <pkg/dem/Ig2_Sphere_Sphere_ScGeom.hpp>

#include "contact_phys.hpp"

namespace yade {

/// An object as its class, if it is of this class and not of another: cheaper than a dynamic_cast.
template <class Class, class Base>
auto* exactly(Base* object) {
  using Found = std::conditional_t<std::is_const_v<Base>, const Class, Class>;
  return object && object->getClassIndex() == Class::getClassIndexStatic() ? static_cast<Found*>(object) : nullptr;
}

class EpGrowth : public GlobalEngine {
 public:
  /// A thread writes its own spheres, and each sum has the order of the neighbours' numbers: neither threads nor O.load
  /// change a bit of it.
  void action() override {
    const auto& bodies = *scene->bodies;
    const Body::id_t n = bodies.size();
#ifdef YADE_OPENMP
#pragma omp parallel for schedule(guided)
#endif
    for (Body::id_t id = 0; id < n; ++id) {
      const Body* const body = bodies[id].get();
      if (!body || !exactly<Sphere>(body->shape.get())) continue;
      auto* const state = exactly<EpState>(body->state.get());
      if (!state) {
        epdem::in_yade::raise_in_python("EpGrowth: body " + std::to_string(id) +
                                        " has no EpState; give the sphere its EpMat when it is made");
        continue;
      }
      double sums[epdem::dent_sums] = {};
      for (const auto& [other, contact] : body->intrs) {
        if (!contact->isReal()) continue;
        const auto* const phys = exactly<EpPhys>(contact->phys.get());
        if (!phys || phys->growthAt() < 0) continue;
        epdem::Dents<double> dents;
        std::memcpy(&dents, &phys->history[phys->growthAt() + epdem::growth_values], sizeof dents);
        // i is the first sphere
        epdem::add_dent(sums, phys->wall != 0 || contact->getId1() == id ? dents.i : dents.j);
      }
      epdem::Dent<double> dents;
      epdem::BodyMemory<double> memory;
      static_assert(sizeof dents == sizeof sums && sizeof memory == sizeof state->memory);
      std::memcpy(&dents, sums, sizeof dents);
      std::memcpy(&memory, state->memory.data(), sizeof memory);
      const epdem::BodySums<double> now = epdem::sums_of_step(dents, memory);
      std::memcpy(state->memory.data(), &memory, sizeof memory);
      state->growth = now.growth;
      state->dentedArea = now.area;
      state->pressure = now.pressure;
      state->parted = now.parted;
    }
  }

  // clang-format off
  YADE_CLASS_BASE_DOC(EpGrowth, GlobalEngine,
    "Computes the :yref:`growth<EpState.growth>` of each sphere from the dents of its contacts, for laws with compaction; stands before :yref:`InteractionLoop`.");
  // clang-format on
};
REGISTER_SERIALIZABLE(EpGrowth);

/// An Ig2 functor that finds contacts of grown spheres.
class EpFindsGrown {
 public:
  virtual ~EpFindsGrown() = default;

  /// Refuses a contact unless the engines compute growth and find each contact that growth brings about.
  static void require(const Scene& scene, const string& law) {
    using epdem::in_yade::refuse;
    bool grows = false;
    for (const auto& engine : scene.engines) {
      grows |= !engine->dead && dynamic_cast<const EpGrowth*>(engine.get());
      if (const auto* const loop = dynamic_cast<const InteractionLoop*>(engine.get())) {
        if (!grows) refuse(law + ": compaction needs the engine EpGrowth() before InteractionLoop; add it");
        for (const auto& functor : loop->geomDispatcher->functors) {
          const string name = functor->getClassName();
          if (!dynamic_cast<const EpFindsGrown*>(functor.get()))
            refuse(law + ": compaction misses contacts across gaps with " + name + "; take " + name + "Grown");
        }
      }
      if (const auto* const collider = dynamic_cast<const Collider*>(engine.get()))
        for (const auto& functor : collider->boundDispatcher->functors) {
          const auto* const bound = dynamic_cast<const Bo1_Sphere_Aabb*>(functor.get());
          if (bound && bound->aabbEnlargeFactor < 1.0 + epdem::growth_reach)
            refuse(law + ": Bo1_Sphere_Aabb.aabbEnlargeFactor = " + epdem::number(bound->aabbEnlargeFactor) +
                   ", compaction closes gaps of up to a quarter of the radii; give at least " +
                   epdem::number(1.0 + epdem::growth_reach));
        }
    }
  }
};

/// YADE's functor for a sphere and a body of the shape First.
template <class Ig2, class First>
class EpGrownIg2 : public Ig2, public EpFindsGrown {
  static constexpr bool spheres = std::is_same_v<First, Sphere>;

 public:
  bool go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1, const State& state2,
          const Vector3r& shift2, const bool& force, const shared_ptr<Interaction>& contact) override {
    const auto finds = [&](const shared_ptr<Shape>& first, const shared_ptr<Shape>& second) {
      return Ig2::go(first, second, state1, state2, shift2, force, contact);
    };
    if (contact->isReal()) return finds(shape1, shape2);
    const double growth1 = spheres ? growth_of(state1) : 0.0, growth2 = growth_of(state2);
    if (!(growth1 + growth2 > 0.0)) return finds(shape1, shape2);
    if constexpr (spheres) {  // most pairs within the bounds are apart
      const double reach = radius_of(shape1) * (1.0 + growth1) + radius_of(shape2) * (1.0 + growth2);
      if ((state2.pos + shift2 - state1.pos).squaredNorm() > reach * reach) return false;
    }
    Sphere grown1, grown2;
    if (!finds(spheres ? grow(shape1, growth1, grown1) : shape1, grow(shape2, growth2, grown2))) return false;
    // once more with the spheres themselves: YADE computes the geometry of a real contact at any distance
    contact->phys = boost::make_shared<IPhys>();
    finds(shape1, shape2);
    contact->phys.reset();
    return true;
  }

 private:
  static double growth_of(const State& state) {
    const auto* const of_material = exactly<EpState>(&state);
    return of_material ? of_material->growth : 0.0;
  }

  static double radius_of(const shared_ptr<Shape>& sphere) { return static_cast<const Sphere&>(*sphere).radius; }

  static shared_ptr<Shape> grow(const shared_ptr<Shape>& sphere, double growth, Sphere& grown) {
    grown.radius = radius_of(sphere) * (1.0 + growth);
    return shared_ptr<Shape>(shared_ptr<Shape>(), &grown);
  }
};

#define EPDEM_IG2(First)                                                                                              \
  class Ig2_##First##_Sphere_ScGeomGrown : public EpGrownIg2<Ig2_##First##_Sphere_ScGeom, First> {                    \
   public:                                                                                                            \
    YADE_CLASS_BASE_DOC(Ig2_##First##_Sphere_ScGeomGrown, Ig2_##First##_Sphere_ScGeom,                                \
                        "The same for laws with compaction: finds contacts of grown spheres across a gap, as far as " \
                        ":yref:`Bo1_Sphere_Aabb::aabbEnlargeFactor` reaches.");                                       \
  };                                                                                                                  \
  REGISTER_SERIALIZABLE(Ig2_##First##_Sphere_ScGeomGrown);
EPDEM_IG2(Sphere)
EPDEM_IG2(Wall)
EPDEM_IG2(Facet)
EPDEM_IG2(Box)
#undef EPDEM_IG2

}  // namespace yade
