// SPDX-License-Identifier: BSD-3-Clause
// The loops of spheres.hpp as lanes; compiled once per instruction set, as kernel.hpp says.
#pragma once

#include "epdem/compaction.hpp"
#include "epdem/lanes.hpp"
#include "kernels/spheres.hpp"

namespace epdem::kernels {
namespace {

/// Each number of a sphere three times, for the three numbers of its rows.
EPDEM_INLINE void repeat(const double* from, double* to, int n) {
  for (int k = 0; k < n; ++k) to[3 * k] = to[3 * k + 1] = to[3 * k + 2] = from[k];
}

/// y += a x
EPDEM_INLINE void add(double* __restrict y, const double* __restrict a, const double* __restrict x, int n) {
  for (int q = 0; q < n; ++q) y[q] += a[q] * x[q];
}

void half_step(const HalfStep& s) {
  constexpr int most = 128;
  alignas(64) double of_sphere[most], of_number[3 * most];
  for (int first = 0; first < s.n; first += most) {
    const int n = s.n - first < most ? s.n - first : most, row = 3 * first;
    const double *const mass = s.mass + first, *const radius = s.radius + first;
    for (int k = 0; k < n; ++k) of_sphere[k] = s.dt_force / (mass[k] * s.mass_factor);
    repeat(of_sphere, of_number, n);
    add(s.v + row, of_number, s.force + row, 3 * n);
    for (int k = 0; k < n; ++k) of_sphere[k] = s.dt_torque / (radius[k] * radius[k] * mass[k]);
    repeat(of_sphere, of_number, n);
    add(s.omega + row, of_number, s.torque + row, 3 * n);
    if (!s.x) continue;
    double* const __restrict x = s.x + row;
    const double* const __restrict v = s.v + row;
    for (int q = 0; q < 3 * n; ++q) x[q] += s.dt * v[q];
  }
}

bool any_moved(const double* now, const double* before, int n, double square) {
  Mask moved{};
  int k = 0;
  for (; k + lane_count < n; k += lane_count) {  // a row of four numbers begins at a position
    const Columns way = columns([&](int l) __attribute__((always_inline)) {
      return load<Row>(now + 3 * (k + l)) - load<Row>(before + 3 * (k + l));
    });
    moved |= way.a * way.a + way.b * way.b + way.c * way.c > square;
  }
  bool found = any(moved);
  for (; k < n; ++k) {
    const double *const x = now + 3 * k, *const y = before + 3 * k;
    const double dx = x[0] - y[0], dy = x[1] - y[1], dz = x[2] - y[2];
    found |= dx * dx + dy * dy + dz * dz > square;
  }
  return found;
}

/// Arrays of whole numbers that are kept or dropped together.
template <class T, int count>
struct Arrays {
  T* of[count];
};

/// Writes the numbers of the lanes in the mask one after the other and returns how many these are; lane_count numbers
/// can be written. An array may be written onto itself.
template <int count>
EPDEM_INLINE int kept(Mask mask, const Arrays<const int, count>& from, const Arrays<int, count>& to) {
#if defined __AVX512VL__
  const __mmask8 bits = _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
  for (int c = 0; c < count; ++c) {
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from.of[c]));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.of[c]), _mm256_maskz_compress_epi32(bits, all));
  }
  return __builtin_popcount(bits);
#else
  int n = 0, all[count][lane_count];
  for (int c = 0; c < count; ++c) __builtin_memcpy(all[c], from.of[c], sizeof all[c]);
  for (int l = 0; l < lane_count; ++l) {
    for (int c = 0; c < count; ++c) to.of[c][n] = all[c][l];
    n -= static_cast<int>(mask[l]);
  }
  return n;
#endif
}

/// Which of the next lanes are among n.
EPDEM_INLINE Mask among(int n) {
  static constexpr double lanes[] = {0, 1, 2, 3, 4, 5, 6, 7};
  return load<Lanes>(lanes) < constant<Lanes>(n);
}

/// The next of n candidates; the lanes behind the last repeat it and are not valid.
struct Candidates {
  int repeated[lane_count];
  const int* index;
  Columns at;  // positions and radii
  Mask valid;

  EPDEM_INLINE Candidates(const NearTest& t, const int* candidates, int n) : index(candidates) {
    if (n < lane_count) {
      for (int l = 0; l < lane_count; ++l) repeated[l] = candidates[l < n ? l : n - 1];
      index = repeated;
    }
    valid = among(n);
    at = columns([&](int l)
                     __attribute__((always_inline)) { return load<Row>(t.spheres + 4 * static_cast<long>(index[l])); });
  }

  /// Writes the candidates in the mask and returns their number.
  EPDEM_INLINE int keep(Mask mask, int* found) const { return kept<1>(mask & valid, {{index}}, {{found}}); }
};

int near_sphere(const NearTest& t, int of, const int* candidates, int n, int* found) {
  const double* const s = t.spheres + 4 * static_cast<long>(of);
  int count = 0;
  for (int k = 0; k < n; k += lane_count) {
    const Candidates c(t, candidates + k, n - k);
    const Lanes dx = s[0] - c.at.a, dy = s[1] - c.at.b, dz = s[2] - c.at.c;
    const Lanes reach = (s[3] + c.at.d) * t.factor + t.skin;
    count += c.keep(dx * dx + dy * dy + dz * dz <= reach * reach, found + count);
  }
  int above = 0;
  for (int k = 0; k < count; ++k) {
    found[above] = found[k];
    above += found[k] > of;
  }
  return above;
}

template <bool as_listed>
int near_triangle(const NearTest& t, const TrianglePlanes& planes, const int* candidates, int n, int* found) {
  int count = 0;
  for (int k = 0; k < n; k += lane_count) {
    const Candidates c(t, candidates + k, n - k);
    const Lanes reach = c.at.d * t.factor + t.skin;
    const auto height = [&](int plane) __attribute__((always_inline)) {
      const double *const p = planes.point[plane], *const normal = planes.normal[plane];
      return normal[0] * (c.at.a - p[0]) + normal[1] * (c.at.b - p[1]) + normal[2] * (c.at.c - p[2]);
    };
    const Lanes above = height(0), room = reach * reach - (as_listed ? Lanes{} : above * above);
    Mask near = fabs(above) <= reach;
    if (!any(near)) continue;
    for (int edge = 1; edge < 4; ++edge) {
      const Lanes beyond = height(edge);
      near &= (beyond <= 0.0) | (beyond * beyond <= room);
    }
    count += c.keep(near, found + count);
  }
  return count;
}

template <bool marks_gaps>
int next_pairs(PairSearch& s, int* i, int* j, int* place) {
  const int last = s.count - s.tested < pairs_at_once ? s.count : s.tested + pairs_at_once;
  int found = 0;
  // places as one vector: the parts of an array of whole numbers would be stored one by one
  typedef int Places __attribute__((vector_size(4 * lane_count)));
  static constexpr int first[] = {0, 1, 2, 3, 4, 5, 6, 7};
  Places next;
  __builtin_memcpy(&next, first, sizeof next);
  next += s.tested;
  for (int k = s.tested; k < last; k += lane_count) {
    const int *const of = s.i + k, *const with = s.j + k;
    const Columns d = columns([=](int l) __attribute__((always_inline)) {
      return load<Row>(s.x + 3 * long(of[l])) - load<Row>(s.x + 3 * long(with[l]));
    });
    Lanes radius_i, radius_j;
    int places[lane_count];
    for (int l = 0; l < lane_count; ++l) radius_i[l] = s.radius[of[l]];
    for (int l = 0; l < lane_count; ++l) radius_j[l] = s.radius[with[l]];
    const Lanes sum = radius_i + radius_j, rsq = d.a * d.a + d.b * d.b + d.c * d.c;
    Mask meet = rsq < s.factor * sum * sum;
    Places place_of = next;
    if constexpr (marks_gaps) {
      const Mask apart = !(rsq < sum * sum);
      place_of ^= __builtin_convertvector(apart, Places);
      if (s.sums && any(meet & apart)) {
        static_assert(offsetof(BodySums<double>, growth) == 0);
        Lanes growth_i, growth_j;
        for (int l = 0; l < lane_count; ++l) growth_i[l] = s.sums[body_values * long(of[l])];
        for (int l = 0; l < lane_count; ++l) growth_j[l] = s.sums[body_values * long(with[l])];
        const Lanes reach = sum + (radius_i * growth_i + radius_j * growth_j);
        Places last;
        __builtin_memcpy(&last, s.in_contact + k, sizeof last);
        const Places known = last >= s.pass - 1;
        // more than the round-off of the test that decides
        meet &= (rsq < (1.0 + 1e-12) * (reach * reach)) | __builtin_convertvector(known, Mask);
      }
    }
    __builtin_memcpy(places, &place_of, sizeof places);
    next += lane_count;
    found += kept<3>(meet & among(last - k), {{of, with, places}}, {{i + found, j + found, place + found}});
  }
  s.tested = last;
  return found;
}

/// BodySums of the spheres whose rows row(l) names.
template <class RowOf>
EPDEM_INLINE Lanes close_sums_of(const BodyRows r, RowOf row) {
  static_assert(dent_sums == 6 && body_values == 4 && memory_values == 5);
  const auto four = [=](const double* from, int stride) __attribute__((always_inline)) {
    return columns([=](int l) __attribute__((always_inline)) { return load<Row>(from + stride * row(l)); });
  };
  const auto put = [=](double* to, int stride, const Columns& of) __attribute__((always_inline)) {
    rows(of, [=](int l, const Row& numbers) __attribute__((always_inline)) { store(to + stride * row(l), numbers); });
  };
  const Columns dents = four(r.sums, dent_sums);
  if (!any((dents.a > 0.0) | (dents.c > 0.0) | (dents.d > 0.0))) {  // as where no sphere touches another
    put(r.bodies, body_values, Columns{});
    put(r.memory, r.memory_stride, Columns{});
    put(r.memory + 1, r.memory_stride, Columns{});
    return Lanes{};
  }
  const Columns last_dents = four(r.sums + 2, dent_sums);
  const Columns kept = four(r.memory, r.memory_stride), last_kept = four(r.memory + 1, r.memory_stride);
  BodyMemory<Lanes> memory{kept.a, kept.b, kept.c, kept.d, last_kept.d};
  const Dent<Lanes> sums{dents.a, dents.b, dents.c, dents.d, last_dents.c, last_dents.d};
  const BodySums<Lanes> now = sums_of_step(sums, memory);
  put(r.bodies, body_values, {now.growth, now.area, now.pressure, now.parted});
  put(r.memory, r.memory_stride, {memory.pressure, memory.full, memory.parted, memory.last});
  put(r.memory + 1, r.memory_stride, {memory.full, memory.parted, memory.last, memory.old});
  for (int l = 0; l < lane_count; ++l) __builtin_memset(r.sums + dent_sums * row(l), 0, dent_sums * sizeof(double));
  return now.growth;
}

double close_sums(const BodyRows& rows) {
  const BodyRows r = rows;
  Lanes largest{};
  long k = 0;
  for (; k + lane_count <= r.n; k += lane_count)
    largest = max(largest, close_sums_of(r, [=](int l) __attribute__((always_inline)) { return k + l; }));
  const long last = r.n - 1;  // stands in the lanes behind it once more
  if (k <= last)
    largest = max(largest,
                  close_sums_of(r, [=](int l) __attribute__((always_inline)) { return k + l < last ? k + l : last; }));
  double most = 0.0;
  for (int l = 0; l < lane_count; ++l) most = largest[l] > most ? largest[l] : most;
  return most;
}

}  // namespace
}  // namespace epdem::kernels
