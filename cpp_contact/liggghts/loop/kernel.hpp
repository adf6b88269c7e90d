// SPDX-License-Identifier: GPL-2.0-or-later
// The contacts of a block, computed as lanes. Compiled once per instruction set, which EPDEM_KERNELS names: everything
// is in unnamed namespaces or depends on the width of Lanes, so that no function compiled for a newer processor can
// stand in for one of the same name compiled for an older one.
#include "epdem/friction.hpp"
#include "epdem/laws.hpp"
#include "epdem/tangential.hpp"
#include "epdem/viscous.hpp"
#include "models.hpp"

namespace epdem::liggghts::loop {
namespace {

/// The first `count` numbers of each lane's history.
template <int count>
EPDEM_INLINE void read(double* const* history, Lanes* value) {
  for (int at = count - 4; at > -4; at -= 4) {
    const int first = at < 0 ? 0 : at;  // 3 are left: the fourth is read a second time
    if (at < -1 || count < 4) break;
    const Columns c = columns([=](int l) __attribute__((always_inline)) { return load<Row>(history[l] + first); });
    value[first] = c.a, value[first + 1] = c.b, value[first + 2] = c.c, value[first + 3] = c.d;
  }
  for (int k = 0; k < (count < 4 ? count : count % 4 == 3 ? 0 : count % 4); ++k)
    for (int l = 0; l < lane_count; ++l) value[k][l] = history[l][k];
}

template <int count>
EPDEM_INLINE void write(double* const* history, const Lanes* value) {
  for (int at = count - 4; at > -4; at -= 4) {
    const int first = at < 0 ? 0 : at;
    if (at < -1 || count < 4) break;
    rows({value[first], value[first + 1], value[first + 2], value[first + 3]},
         [=](int l, const Row& row) __attribute__((always_inline)) { store(history[l] + first, row); });
  }
  for (int k = 0; k < (count < 4 ? count : count % 4 == 3 ? 0 : count % 4); ++k)
    for (int l = 0; l < lane_count; ++l) history[l][k] = value[k][l];
}

EPDEM_INLINE Lanes at(const Line& line, int k) { return load<Lanes>(line.a + k); }
EPDEM_INLINE Three at(const Line* lines, int k) { return {at(lines[0], k), at(lines[1], k), at(lines[2], k)}; }

/// Rows of the atoms of lanes k, k + 1, ...
EPDEM_INLINE Three of(const double* base, const int* index) {
  const Columns c = columns([=](int l) __attribute__((always_inline)) { return load<Row>(base + 3 * long(index[l])); });
  return {c.a, c.b, c.c};
}
EPDEM_INLINE Three difference(const double* base, const int* i, const int* j) {
  const Columns c = columns([=](int l) __attribute__((always_inline)) {
    return load<Row>(base + 3 * long(i[l])) - load<Row>(base + 3 * long(j[l]));
  });
  return {c.a, c.b, c.c};
}

EPDEM_INLINE void put(Line* lines, int k, const Three& t) {
  store(lines[0].a + k, t.x);
  store(lines[1].a + k, t.y);
  store(lines[2].a + k, t.z);
}

EPDEM_INLINE Lanes effective_mass(const Block& b, int k, bool freeze) {
  const Lanes mi = at(b.mi, k), mj = at(b.mj, k), m = reduced_finite(mi, mj);
  if (!freeze) return m;
  return select(at(b.frozen_j, k) > 0.0, mi, select(at(b.frozen_i, k) > 0.0, mj, m));
}

/// Friction with partial slip; `memory` before and after.
template <int nodes, bool wall, class Law>
EPDEM_INLINE Three slipping(Block& b, int k, const Contact& c, const Step<Law>& now, const Pass& pass,
                            const Lanes* constant_of, Lanes* memory) {
  SlipState<nodes, Lanes> before;
  __builtin_memcpy(static_cast<void*>(&before), memory, sizeof before);
  const Lanes stiffness = 8.0 * constant_of[shear_modulus];
  const Shear<Lanes> motion{c.en, pass.dt * c.vtr, 0.5 * pass.dt * dot(c.en, wall ? c.omega_i : c.omega_i + c.omega_j),
                            1.0 / pass.dt * c.gammat};
  SlipStep<nodes, Lanes> out;
  const auto step = [&](auto damped) __attribute__((always_inline)) {
    out = partial_slip<nodes, Law::flattens, damped>(before, pressed_by(now, c.Fn), motion, stiffness,
                                                     constant_of[friction]);
  };
  if (pass.damped)
    step(std::true_type{});
  else
    step(std::false_type{});
  if (pass.work) {
    store(b.rubbed.a + k, slip_loss(before, out, motion.slip, stiffness));
    store(b.sprung.a + k, slip_energy(out.after, stiffness));
  }
  __builtin_memcpy(memory, &out.after, sizeof out.after);
  return out.force;
}

/// The largest contact radius and overlap over R*, of contacts k, k + 1, ... below n: no contact is in the lanes
/// behind.
EPDEM_INLINE void largest(Block& b, int k, int n, Lanes radius, Lanes overlap, Lanes R_star) {
  Lanes lane;
  for (int l = 0; l < lane_count; ++l) lane[l] = l;
  const Mask contact = lane < constant<Lanes>(n - k);
  const auto keep = [=](double* most, Lanes value) __attribute__((always_inline)) {
    store(most, max(load<Lanes>(most), select(contact, value / R_star, Lanes{})));
  };
  keep(b.radius_ratio, radius);
  keep(b.overlap_ratio, overlap);
}

/// What adhesion books; outside of the kernels, where it would stand six times.
template <class Law>
[[gnu::noinline]] void book(Block& b, int k, const Law& law, Lanes R_star, const State<Law>& before,
                            const Step<Law>& now, Lanes delta) {
  const auto lost = losses(law, R_star, before, now.after);
  store(b.grown.a + k, lost.plastic);
  store(b.parted.a + k, lost.adhesive);
  store(b.stored.a + k, stored_energy(law, R_star, now.after, delta));
  store(b.radius.a + k, now.radius);
}

/// History of a pair: the law's memory, the step of the last evaluation (not of walls, whose contacts LIGGGHTS ends),
/// the models beside it in LIGGGHTS's order.
template <class Law, Tangential tangential, bool rolls, bool wall>
[[gnu::flatten]] void contacts(Block& b, int n, const Pass& pass) {
  constexpr bool springs = tangential == Tangential::history;
  constexpr int nodes = tangential == Tangential::partial_slip ? 3 : tangential == Tangential::partial_slip_2 ? 2 : 0;
  constexpr int slip_values = springs ? 3 : nodes ? 3 * nodes + 1 : 0;
  constexpr int last_step = memory<Law>, shear = last_step + !wall, roll = shear + slip_values;
  constexpr bool remembers = memory<Law> > 0;
  constexpr int slots = remembers || slip_values || rolls ? roll + 3 * rolls : 0;
  constexpr int needed = law_data + static_cast<int>(sizeof(Law) / sizeof(Lanes)), constants = (needed + 3) / 4 * 4;
  static_assert(constants <= most_constants);
  Lanes of_all[constants], of_each[constants];
  const Lanes* constant_of = of_all;
  for (int c = 0; c < constants; ++c) of_all[c] = constant<Lanes>(b.material[0][c]);
  // Behind the history of this block lies that of the next: what is long is on its way while this one is computed.
  const char* ahead = reinterpret_cast<const char*>(b.history[n - 1]);
  const long span = nodes > 0 ? ahead - reinterpret_cast<const char*>(b.history[0]) : 0;  // apart: of two pages
  const long stride = span > 0 && span < 65536 ? span * lane_count / n : 0;
  for (int k = 0; k < n; k += lane_count) {
    for (long line = 0; line < stride; line += 64) __builtin_prefetch(ahead + line, 1, 2);
    ahead += stride;
    if (pass.several) {
      for (int c = 0; c < constants; c += 4) {
        const Columns four =
            columns([&](int l) __attribute__((always_inline)) { return load<Row>(b.material[k + l] + c); });
        of_each[c] = four.a, of_each[c + 1] = four.b, of_each[c + 2] = four.c, of_each[c + 3] = four.d;
      }
      constant_of = of_each;
    }

    Contact c;
    c.radi = at(b.radi, k);
    c.omega_i = of(pass.omega, b.i + k);
    if constexpr (wall) {
      c.delta = at(b.apart, k);
      surface_of_wall(c, of(pass.v, b.i + k) - at(b.wall_v, k), at(b.overlap, k));
    } else {
      c.radj = at(b.radj, k);
      c.delta = difference(pass.x, b.i + k, b.j + k);
      c.omega_j = of(pass.omega, b.j + k);
      surface(c, difference(pass.v, b.i + k, b.j + k));
    }

    Lanes value[slots ? slots : 1] = {};
    State<Law> before{};
    if constexpr (slots > 0) {
      read<slots>(b.history + k, value);
      if constexpr (!wall) {
        const auto parted = pass.now - value[last_step] > 1.0;  // since the last evaluation: a new contact
        for (int s = 0; s < slots; ++s) value[s] = select(parted, Lanes{}, value[s]);
      }
      if constexpr (remembers) __builtin_memcpy(static_cast<void*>(&before), value, sizeof before);
      if constexpr (adheres<Law>)  // bodies that touch without being attached begin anew in all other models
        for (int s = shear; s < slots; ++s) value[s] = select(before.root > 0.0, value[s], Lanes{});
    }

    Law law;
    __builtin_memcpy(static_cast<void*>(&law), constant_of + law_data, sizeof law);
    const Step<Law> now = step(law, c.reff, before, c.deltan, -c.vn * pass.dt);
    if (pass.strain) largest(b, k, n, now.radius, c.deltan, c.reff);
    if constexpr (adheres<Law>) {
      if (pass.work) book(b, k, law, c.reff, before, now, c.deltan);
    } else if (pass.work) {
      const Lanes stored = elastic_energy(law, c.reff, now, c.deltan);
      store(b.stored.a + k, stored);
      store(b.grown.a + k, plastic_growth(law, c.reff, before, now, stored));
    }

    c.Fn = now.force;
    c.kn = 4.0 / 3.0 * law.E_star * now.radius;
    c.kt = tangential_stiffness(constant_of[shear_modulus], now.radius);
    c.gammat = Lanes{};
    if (pass.damped || pass.viscous) {
      const Lanes mass = wall ? at(b.mi, k) : effective_mass(b, k, pass.freeze);
      if (pass.viscous) c.Fn = damped_force(law, c.reff, before, now, constant_of[dashpot], mass, -c.vn);
      c.gammat = tangential_damping(constant_of[damping], c.kt, mass);
    }

    Three force = c.Fn * c.en, torque_i{}, torque_j{};
    if constexpr (adheres<Law>) {
      c.Fn = sliding_load(law, c.reff, now, c.Fn);
      c.kn = select(c.deltan > 0.0, c.kn, Lanes{});
    } else if (pass.cohesion != Cohesion::off) {
      const Lanes pull = cohesive_force<wall>(c, pass.cohesion, constant_of[cohesion_density]);
      if (pass.cohesion_slides) c.Fn += pull;
      force = force + pull * c.en;
    }
    if constexpr (tangential != Tangential::off) {
      Three Ft;
      if constexpr (springs) {
        Three stretch{value[shear], value[shear + 1], value[shear + 2]};
        Ft = sliding_spring(c, constant_of[friction], pass.damped, pass.dt, stretch);
        value[shear] = stretch.x, value[shear + 1] = stretch.y, value[shear + 2] = stretch.z;
      } else if constexpr (nodes > 0) {
        Ft = slipping<nodes, wall>(b, k, c, now, pass, constant_of, value + shear);
      } else {
        Ft = sliding_dashpot(c, constant_of[friction]);
      }
      const Three lever = cross(c.en, Ft);
      force = force + Ft;
      torque_i = -c.cri * lever;
      if constexpr (!wall) torque_j = -c.crj * lever;
    }
    if constexpr (rolls) {
      Three torque{value[roll], value[roll + 1], value[roll + 2]};
      rolling_spring(c, constant_of[rolling_friction], pass.torsion, pass.dt, torque);
      value[roll] = torque.x, value[roll + 1] = torque.y, value[roll + 2] = torque.z;
      torque_i = torque_i - torque;
      torque_j = torque_j + torque;
    } else if (pass.rolling == Rolling::cdt) {
      const Three torque = rolling_torque<wall>(c, constant_of[rolling_friction], pass.torsion);
      torque_i = torque_i - torque;
      torque_j = torque_j + torque;
    }

    if constexpr (slots > 0) {
      if constexpr (remembers) __builtin_memcpy(value, &now.after, sizeof now.after);
      if constexpr (!wall) value[last_step] = constant<Lanes>(pass.now);
      write<slots>(b.history + k, value);
    }
    put(b.force, k, force);
    put(b.torque_i, k, torque_i);
    if constexpr (!wall) put(b.torque_j, k, torque_j);
  }
}

}  // namespace

/// No kernel for what the plugin does not offer, partial slip of contacts with adhesion, nor for walls with adhesion.
template <class Law, Tangential tangential, bool rolls, bool wall>
constexpr Kernel offered() noexcept {
  if constexpr (adheres<Law> && (wall || tangential >= Tangential::partial_slip))
    return nullptr;
  else
    return &contacts<Law, tangential, rolls, wall>;
}

#define EPDEM_WALLS(Class, model, rolls) \
  {offered<Class<Lanes>, Tangential::model, rolls, false>(), offered<Class<Lanes>, Tangential::model, rolls, true>()}
#define EPDEM_BOTH(Class, model) {EPDEM_WALLS(Class, model, false), EPDEM_WALLS(Class, model, true)}
#define EPDEM_OF_LAW(Class)                                                                                            \
  {EPDEM_BOTH(Class, off), EPDEM_BOTH(Class, no_history), EPDEM_BOTH(Class, history), EPDEM_BOTH(Class, partial_slip), \
   EPDEM_BOTH(Class, partial_slip_2)},
extern const Kernels EPDEM_KERNELS;
const Kernels EPDEM_KERNELS = {{EPDEM_LAWS(EPDEM_OF_LAW)}};
#undef EPDEM_OF_LAW
#undef EPDEM_BOTH
#undef EPDEM_WALLS

}  // namespace epdem::liggghts::loop
