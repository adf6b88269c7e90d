// SPDX-License-Identifier: BSD-3-Clause
// The contacts of a block, computed as lanes. Compiled once per instruction set, which EPDEM_KERNELS names: everything
// is in unnamed namespaces or depends on the width of Lanes, so that no function compiled for a newer processor can
// stand in for one of the same name compiled for an older one.
#include <cstdint>

#include "epdem/contact.hpp"
#include "epdem/laws.hpp"
#include "kernels/block.hpp"
#include "kernels/sphere_lanes.hpp"

namespace epdem::kernels {
namespace {

/// `count` numbers of each lane's history, from number `from` on.
template <int count>
EPDEM_INLINE void read(double* const* history, Lanes* value, int from = 0) {
  for (int at = count - 4; at > -4; at -= 4) {
    const int first = at < 0 ? 0 : at;  // 3 are left: the fourth is read a second time
    if (at < -1 || count < 4) break;
    const Columns c =
        columns([=](int l) __attribute__((always_inline)) { return load<Row>(history[l] + from + first); });
    value[first] = c.a, value[first + 1] = c.b, value[first + 2] = c.c, value[first + 3] = c.d;
  }
  for (int k = 0; k < (count < 4 ? count : count % 4 == 3 ? 0 : count % 4); ++k)
    for (int l = 0; l < lane_count; ++l) value[k][l] = history[l][from + k];
}

template <int count>
EPDEM_INLINE void write(double* const* history, const Lanes* value, int from = 0) {
  for (int at = count - 4; at > -4; at -= 4) {
    const int first = at < 0 ? 0 : at;
    if (at < -1 || count < 4) break;
    rows({value[first], value[first + 1], value[first + 2], value[first + 3]},
         [=](int l, const Row& row) __attribute__((always_inline)) { store(history[l] + from + first, row); });
  }
  for (int k = 0; k < (count < 4 ? count : count % 4 == 3 ? 0 : count % 4); ++k)
    for (int l = 0; l < lane_count; ++l) history[l][from + k] = value[k][l];
}

EPDEM_INLINE Lanes at(const Line& line, int k) { return load<Lanes>(line.a + k); }
EPDEM_INLINE Vec<Lanes> at(const Line* lines, int k) { return {at(lines[0], k), at(lines[1], k), at(lines[2], k)}; }

/// Rows of the atoms of lanes k, k + 1, ...
EPDEM_INLINE Vec<Lanes> of(const double* base, const int* index) {
  const Columns c = columns([=](int l) __attribute__((always_inline)) { return load<Row>(base + 3 * long(index[l])); });
  return {c.a, c.b, c.c};
}
EPDEM_INLINE Vec<Lanes> difference(const double* base, const int* i, const int* j) {
  const Columns c = columns([=](int l) __attribute__((always_inline)) {
    return load<Row>(base + 3 * long(i[l])) - load<Row>(base + 3 * long(j[l]));
  });
  return {c.a, c.b, c.c};
}

/// BodySums of the spheres of lanes k, k + 1, ..., which lie side by side.
EPDEM_INLINE BodySums<Lanes> sums_of(const double* base, const int* index) {
  static_assert(body_values == 4);
  const Columns c =
      columns([=](int l) __attribute__((always_inline)) { return load<Row>(base + body_values * long(index[l])); });
  return {c.a, c.b, c.c, c.d};
}

EPDEM_INLINE void put(Line* lines, int k, Vec<Lanes> t) {
  store(lines[0].a + k, t.x);
  store(lines[1].a + k, t.y);
  store(lines[2].a + k, t.z);
}

EPDEM_INLINE Lanes effective_mass(const Block& b, int k, bool freeze) {
  const Lanes mi = at(b.mass_i, k), mj = at(b.mass_j, k), m = reduced_finite(mi, mj);
  if (!freeze) return m;
  return select(at(b.frozen_j, k) > 0.0, mi, select(at(b.frozen_i, k) > 0.0, mj, m));
}

/// The largest contact radius and overlap, each times `factor`, of contacts k, k + 1, ... below n: no contact is in the
/// lanes behind.
EPDEM_INLINE void largest(Block& b, int k, int n, Lanes radius, Lanes overlap, Lanes factor) {
  Lanes lane;
  for (int l = 0; l < lane_count; ++l) lane[l] = l;
  const Mask contact = lane < constant<Lanes>(n - k);
  const auto keep = [=](double* most, Lanes value) __attribute__((always_inline)) {
    store(most, max(load<Lanes>(most), select(contact, factor * value, Lanes{})));
  };
  keep(b.radius_ratio, radius);
  keep(b.overlap_ratio, overlap);
}

/// Writes energies and the largest strain of contacts k, k + 1, ... of n into their block. tallies: whether energies
/// can be requested.
template <bool tallies>
struct Recorder {
  Block& b;
  const int k, n;
  const Pass& pass;

  template <class Law, class Energies>
  void normal(const ContactConstants<Law>& pair, Lanes R_star, const Step<Law>& now, Lanes overlap,
              const Energies& energies) const {
    if (rarely(pass.strain)) largest(b, k, n, now.radius, overlap, larger_share(pair.bodies) / R_star);
    if constexpr (tallies) {
      if (!rarely(pass.work)) return;
      const NormalEnergies<Lanes> e = energies(pass.holds);
      store(b.stored_energy.a + k, e.stored);
      store(b.plastic_work_step.a + k, e.plastic_work_step);
      store(b.contact_radius.a + k, now.radius);
      if constexpr (adheres<Law>) store(b.adhesion_loss.a + k, e.adhesion_loss);
    }
  }

  template <class Work>
  void friction(const Work& work) const {
    if (!rarely(pass.work)) return;
    const FrictionWork<Lanes> w = work();
    store(b.friction_work.a + k, w.lost);
    store(b.spring_energy.a + k, w.stored);
  }
};

/// Whether a pair parted since its last evaluation.
EPDEM_INLINE Mask parted(double now, Lanes last_step) { return now - last_step > 1.0; }

/// History of rolling friction behind `first` values of other models, read and written only where a model needs it.
/// Rows of four are faster than three numbers. with_step: no other model of a pair has a history, and the value before
/// is the step of the last evaluation; else the kernel writes the value before later.
template <int first, bool with_step>
struct RollingHistory {
  const Block* block = nullptr;
  const Pass* pass = nullptr;
  int k = 0;  // of the first lane

  EPDEM_INLINE operator Vec<Lanes>() const {
    Lanes value[4];
    read<3 + row>(block->history + k, value, first - row);
    const Vec<Lanes> all{value[row], value[row + 1], value[row + 2]};
    if constexpr (with_step) return select(parted(pass->now, value[0]), Vec<Lanes>{}, all);
    return all;
  }
  EPDEM_INLINE void operator=(const Vec<Lanes>& v) const {
    const Lanes step = constant<Lanes>(pass->now);
    const Lanes value[4] = {row ? step : v.x, row ? v.x : v.y, row ? v.y : v.z, v.z};
    write<3 + row>(block->history + k, value, first - row);
  }
  void clear(Mask lanes) const {
    for (int l = 0; l < lane_count; ++l)
      for (int x = 0; x < 3; ++x)
        if (lanes[l]) block->history[k + l][first + x] = 0.0;
  }

 private:
  static constexpr int row = first > 0;
};

/// A contact that grows, whose values after the step are written before friction: they take no registers there.
template <bool wall>
struct StoredGrowth : Growing<wall, Lanes> {
  Block* block;
  int k, at;  // the first lane; the first value in a history

  EPDEM_INLINE void keep() const {
    Block& b = *block;
    write<growth_values>(b.history + k, reinterpret_cast<const Lanes*>(&this->state), at);
    static_assert(sizeof b.dents_i == dent_sums * sizeof(Line));
    const Dents<Lanes>& d = this->dents;
    for (int s = 0; s < dent_sums; ++s) store(b.dents_i[s].a + k, number_at<Lanes>(d.i, s));
    if constexpr (!wall)
      for (int s = 0; s < dent_sums; ++s) store(b.dents_j[s].a + k, number_at<Lanes>(d.j, s));
  }
};

/// History of a contact: the values of the law, of pairs the step of the last evaluation (hosts end the contacts of
/// walls), friction, rolling friction, with compaction the values of GrowthState.
/// Without `tallies` no step computes energies or repeats the last step.
template <class Law, class Friction, bool wall, bool grows = false, bool tallies = true>
[[gnu::flatten]] void contacts(Block& b, int n, const Pass& pass) {
  constexpr int law_values = history_size<Law>, friction_values = values_of<Friction, Lanes>;
  constexpr int last_step = law_values, sliding = law_values + !wall, rolling = sliding + friction_values;
  constexpr int values = law_values || friction_values ? rolling : 0, grown_values = grows ? growth_values : 0;
  [[maybe_unused]] const int growth_at = rolling + (grows && has_history(Rollings{}, pass.rolling) ? 3 : 0);
  ContactSettings settings = pass;
  if constexpr (!tallies) settings.repeats = false;
  using Pair = ContactConstants<Law>;
  constexpr int bodies_at = offsetof(Pair, bodies) / sizeof(Lanes), all_constants = sizeof(Pair) / sizeof(Lanes);
  static_assert(all_constants <= most_constants && offsetof(Pair, law) == law_data * sizeof(Lanes));
  static_assert(sizeof(BodyShares<Lanes>) == 4 * sizeof(Lanes) && bodies_at + 4 == all_constants);
  Pair pair{};
  for (int c = 0; c < all_constants; ++c) put_number(pair, c, constant<Lanes>(b.material[0][c]));
  // The history of the next block lies behind the history of this block: fetch a long history during the computation.
  const auto ahead = reinterpret_cast<std::uintptr_t>(b.history[n - 1]);
  const auto behind = reinterpret_cast<std::uintptr_t>(b.history[0]);
  // histories of two pages lie apart
  const std::uintptr_t span = friction_values > 3 && ahead - behind < 65536 ? ahead - behind : 0;
  const std::uintptr_t stride = span * lane_count / n;
  for (int k = 0; k < n; k += lane_count) {
    for (std::uintptr_t line = 0; line < stride; line += 64)
      __builtin_prefetch(reinterpret_cast<const void*>(ahead + k / lane_count * stride + line), 1, 2);
    if (pass.several) {
      const auto read_four = [&](int c) __attribute__((always_inline)) {
        const Columns four =
            columns([&](int l) __attribute__((always_inline)) { return load<Row>(b.material[k + l] + c); });
        put_number(pair, c, four.a), put_number(pair, c + 1, four.b), put_number(pair, c + 2, four.c);
        put_number(pair, c + 3, four.d);
      };
      for (int c = 0; c < bodies_at; c += 4) read_four(c);
      if (grows || is_confined<Law> || pass.strain) read_four(bodies_at);
    }

    Kinematics<Lanes> c;
    const Vec<Lanes> spin_i = of(pass.omega, b.i + k);
    if constexpr (wall) {
      const Vec<Lanes> from_wall = at(b.from_wall, k), v = of(pass.v, b.i + k) - at(b.wall_v, k);
      c = at_wall(at(b.radius_i, k), at(b.overlap, k), from_wall, v, spin_i);
    } else {
      const Vec<Lanes> d = difference(pass.x, b.i + k, b.j + k), spin_j = of(pass.omega, b.j + k);
      const Vec<Lanes> v = difference(pass.v, b.i + k, b.j + k);
      c = between_spheres(at(b.radius_i, k), at(b.radius_j, k), d, v, spin_i, spin_j);
    }

    Lanes value[values + grown_values ? values + grown_values : 1];
    using Growth = std::conditional_t<grows, StoredGrowth<wall>, NoGrowth>;
    ContactHistory<Law, Friction, RollingHistory<rolling, !wall && values == 0>, Growth> history;
    history.rolling = {&b, &pass, k};
    if constexpr (values > 0) {
      read<values>(b.history + k, value);
      if constexpr (grows) read<grown_values>(b.history + k, value + values, growth_at);
      if constexpr (!wall) {
        const Mask is_new = parted(pass.now, value[last_step]);
        if (rarely(any(is_new))) {
          for (Lanes& one : value) one = select(is_new, Lanes{}, one);
          if (has_history(Rollings{}, pass.rolling)) history.rolling.clear(is_new);
        }
      }
      copy_numbers<Lanes, law_values>(value[0], history.law);
      copy_numbers<Lanes, friction_values>(value[sliding], history.friction);
    }
    if constexpr (grows) {
      history.growth.block = &b;
      history.growth.k = k;
      history.growth.at = growth_at;
      history.growth.radius_i = c.radius_i;
      history.growth.radius_j = c.radius_j;
      history.growth.curvature_i = 1.0 / c.radius_i;
      if constexpr (!wall) history.growth.curvature_j = 1.0 / c.radius_j;
      history.growth.i = sums_of(pass.sums, b.i + k);
      if constexpr (!wall) history.growth.j = sums_of(pass.sums, b.j + k);
      copy_numbers<Lanes, grown_values>(value[values], history.growth.state);
    }

    const auto mass = [&]() __attribute__((always_inline)) {
      return wall ? at(b.mass_i, k) : effective_mass(b, k, pass.freeze);
    };
    ContactLoads<Lanes> loads;  // assigned below: GCC leaves in memory what it initialises with the result
    loads = contact<Friction, wall>(pair, settings, c, history, mass, Recorder<tallies>{b, k, n, pass});

    if constexpr (values > 0) {
      copy_numbers<Lanes, law_values>(history.law, value[0]);
      copy_numbers<Lanes, friction_values>(history.friction, value[sliding]);
      if constexpr (!wall) value[last_step] = constant<Lanes>(pass.now);
      write<values>(b.history + k, value);
    }
    put(b.force, k, loads.force);
    put(b.torque_i, k, loads.torque_i);
    if constexpr (!wall) put(b.torque_j, k, loads.torque_j);
  }
}

/// No kernel for what no host offers: contacts with adhesion that have partial slip.
template <class Law, class Friction, bool wall>
constexpr Kernel offered() noexcept {
  if constexpr (adheres<Law> && !Friction::of_liggghts)
    return nullptr;
  else
    return &contacts<Law, Friction, wall>;
}

template <class Law>
constexpr void fill(Kernels& kernels) noexcept {
  constexpr int law = detail::place<Law>();
  Frictions::each([&](auto model, int friction) {
    using Friction = decltype(model);
    kernels.of[law][friction][0] = offered<Law, Friction, false>();
    kernels.of[law][friction][1] = offered<Law, Friction, true>();
    if constexpr (compacts<Law> && (!adheres<Law> || Friction::of_liggghts)) {
      constexpr bool complete = adheres<Law>;  // one kernel for both: few scenes have it
      kernels.grown[law][friction][0][0] = &contacts<Law, Friction, false, true, complete>;
      kernels.grown[law][friction][0][1] = &contacts<Law, Friction, false, true, true>;
      kernels.grown[law][friction][1][0] = &contacts<Law, Friction, true, true, complete>;
      kernels.grown[law][friction][1][1] = &contacts<Law, Friction, true, true, true>;
    }
  });
}

constexpr Kernels all() noexcept {
  Kernels kernels{};
#define EPDEM_FILL(Class) fill<Class<Lanes>>(kernels);
  EPDEM_LAWS(EPDEM_FILL)
#undef EPDEM_FILL
  kernels.spheres = {half_step,         any_moved,        near_sphere, near_triangle<true>, near_triangle<false>,
                     next_pairs<false>, next_pairs<true>, close_sums};
  return kernels;
}

}  // namespace

extern const Kernels EPDEM_KERNELS;
constexpr Kernels EPDEM_KERNELS = all();

}  // namespace epdem::kernels
