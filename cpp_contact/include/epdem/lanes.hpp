// SPDX-License-Identifier: BSD-3-Clause
// The numbers that laws are written on: double for one contact, long double for the study of round-off, and Lanes, a
// vector, for many contacts at once. A condition on T is a bool, or a mask with one answer per lane. The only file that
// knows instruction sets: Lanes is as wide as those allow that the including file is compiled for.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

// A device takes one contact per thread: its compilers have no vectors of GCC, and the functions of <cmath> are global.
#if defined __CUDACC__ || defined __CUDA__ || defined __HIP__ || defined __HIPCC_RTC__
#define EPDEM_DEVICE
#define EPDEM_UNROLL
#else
#define EPDEM_UNROLL _Pragma("GCC unroll 64")  // by itself GCC unrolls loops of up to 16 turns
#ifdef __SSE2__
#include <immintrin.h>
#endif
#endif

#define EPDEM_INLINE [[gnu::always_inline]] inline

namespace epdem {

#if defined EPDEM_DEVICE
using ::cbrt;
using ::exp;
using ::expm1;
using ::fabs;
using ::log;
using ::sqrt;
#else
using std::cbrt;
using std::exp;
using std::expm1;
using std::fabs;
using std::log;
using std::sqrt;
#endif

template <class T>
inline constexpr bool is_vector = false;
/// The same number in every lane.
template <class T>
EPDEM_INLINE T constant(double x) noexcept {
  return T{} + x;
}

EPDEM_INLINE bool any(bool m) noexcept { return m; }
template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
EPDEM_INLINE T select(bool m, T a, T b) noexcept {
  return m ? a : b;
}
#if defined EPDEM_DEVICE

using Words = unsigned long long;

#else

#if defined __AVX512F__
constexpr int lane_count = 8;
#elif defined __AVX__
constexpr int lane_count = 4;
#else
constexpr int lane_count = 2;
#endif

typedef double Lanes __attribute__((vector_size(8 * lane_count)));
using Mask = decltype(Lanes{} < Lanes{});
typedef unsigned long long Words __attribute__((vector_size(8 * lane_count)));

template <>
inline constexpr bool is_vector<Lanes> = true;

EPDEM_INLINE bool any(Mask m) noexcept {
#if defined __AVX512DQ__
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(m)) != 0;
#elif defined __AVX__
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(m)) != 0;
#elif defined __SSE2__
  return _mm_movemask_pd(reinterpret_cast<__m128d>(m)) != 0;
#else
  long long found = 0;
  for (int l = 0; l < lane_count; ++l) found |= m[l];
  return found != 0;
#endif
}

EPDEM_INLINE Lanes select(Mask m, Lanes a, Lanes b) noexcept { return m ? a : b; }

EPDEM_INLINE Lanes fabs(Lanes x) noexcept {
  constexpr long long all_but_sign = 0x7fffffffffffffff;
  return reinterpret_cast<Lanes>(reinterpret_cast<Mask>(x) & all_but_sign);
}

EPDEM_INLINE Lanes sqrt(Lanes x) noexcept {
#if defined __AVX512F__
  return _mm512_maskz_sqrt_pd(0xff, x);  // the plain one warns of a number that GCC leaves unset
#elif defined __AVX__
  return _mm256_sqrt_pd(x);
#elif defined __SSE2__
  return _mm_sqrt_pd(x);
#else
  for (int l = 0; l < lane_count; ++l) x[l] = std::sqrt(x[l]);
  return x;
#endif
}

// The library's functions, lane by lane: the same bits as for one contact. A lane that holds NaN costs no call.
#define EPDEM_LANE_BY_LANE(f)                          \
  [[gnu::noinline]] inline Lanes f(Lanes x) noexcept { \
    for (int l = 0; l < lane_count; ++l)               \
      if (x[l] == x[l]) x[l] = std::f(x[l]);           \
    return x;                                          \
  }
EPDEM_LANE_BY_LANE(cbrt)
EPDEM_LANE_BY_LANE(expm1)
#undef EPDEM_LANE_BY_LANE

/// Four numbers that lie side by side in memory.
typedef double Row __attribute__((vector_size(32)));

/// `lane_count` rows and their columns: row(l) gives the row of lane l.
struct Columns {
  Lanes a, b, c, d;
};

#if defined __AVX__

typedef long long Order __attribute__((vector_size(8 * lane_count)));

/// Rows of four as columns, or columns as rows: it is its own inverse. AVX-512 does it in both halves of its vectors.
EPDEM_INLINE Columns transposed(const Columns& r) noexcept {
#if defined __AVX512F__
  const Order even{0, 8, 2, 10, 4, 12, 6, 14}, odd{1, 9, 3, 11, 5, 13, 7, 15};
  const Order low{0, 1, 8, 9, 4, 5, 12, 13}, high{2, 3, 10, 11, 6, 7, 14, 15};
#else
  const Order even{0, 4, 2, 6}, odd{1, 5, 3, 7}, low{0, 1, 4, 5}, high{2, 3, 6, 7};
#endif
  const Lanes t0 = __builtin_shuffle(r.a, r.b, even), t1 = __builtin_shuffle(r.a, r.b, odd);
  const Lanes t2 = __builtin_shuffle(r.c, r.d, even), t3 = __builtin_shuffle(r.c, r.d, odd);
  return {__builtin_shuffle(t0, t2, low), __builtin_shuffle(t1, t3, low), __builtin_shuffle(t0, t2, high),
          __builtin_shuffle(t1, t3, high)};
}

#endif

template <class F>
EPDEM_INLINE Columns columns(F row) noexcept {
#if defined __AVX512F__
  const auto two = [&](int l) __attribute__((always_inline)) {
    return static_cast<Lanes>(
        _mm512_insertf64x4(_mm512_castpd256_pd512(static_cast<__m256d>(row(l))), static_cast<__m256d>(row(l + 4)), 1));
  };
  return transposed({two(0), two(1), two(2), two(3)});
#elif defined __AVX__
  return transposed({row(0), row(1), row(2), row(3)});
#else
  const Row p = row(0), q = row(1);
  return {Lanes{p[0], q[0]}, Lanes{p[1], q[1]}, Lanes{p[2], q[2]}, Lanes{p[3], q[3]}};
#endif
}

/// The way back: write(l, row).
template <class F>
EPDEM_INLINE void rows(const Columns& from, F write) noexcept {
#if defined __AVX512F__
  const auto two = [&](int l, Lanes r) __attribute__((always_inline)) {
    write(l, static_cast<Row>(_mm512_castpd512_pd256(r)));
    write(l + 4, static_cast<Row>(_mm512_extractf64x4_pd(r, 1)));
  };
  const Columns r = transposed(from);
  two(0, r.a);
  two(1, r.b);
  two(2, r.c);
  two(3, r.d);
#elif defined __AVX__
  const Columns r = transposed(from);
  write(0, r.a);
  write(1, r.b);
  write(2, r.c);
  write(3, r.d);
#else
  write(0, Row{from.a[0], from.b[0], from.c[0], from.d[0]});
  write(1, Row{from.a[1], from.b[1], from.c[1], from.d[1]});
#endif
}

#endif

/// A condition that rarely holds: the compiler keeps the registers for the other branch.
EPDEM_INLINE bool rarely(bool x) noexcept { return __builtin_expect(x, false); }

/// As std::min and std::max.
template <class T>
EPDEM_INLINE T min(T a, T b) noexcept {
  return select(b < a, b, a);
}
template <class T>
EPDEM_INLINE T max(T a, T b) noexcept {
  return select(a < b, b, a);
}
#if !defined EPDEM_DEVICE && defined __SSE2__
// one instruction, which GCC does not choose because of -0.0 and NaN: where b is not the smaller or larger one, it
// gives a
EPDEM_INLINE Lanes min(Lanes a, Lanes b) noexcept {
#if defined __AVX512F__
  return _mm512_maskz_min_pd(0xff, b, a);
#elif defined __AVX__
  return _mm256_min_pd(b, a);
#else
  return _mm_min_pd(b, a);
#endif
}
EPDEM_INLINE Lanes max(Lanes a, Lanes b) noexcept {
#if defined __AVX512F__
  return _mm512_maskz_max_pd(0xff, b, a);
#elif defined __AVX__
  return _mm256_max_pd(b, a);
#else
  return _mm_max_pd(b, a);
#endif
}
#endif

/// `x` in the lanes of the mask, NaN in the others: for an argument of a library function that only they need.
template <class M, class T>
EPDEM_INLINE T only(M mask, T x) noexcept {
  return select(mask, x, constant<T>(std::numeric_limits<double>::quiet_NaN()));
}

/// Number k of a class that has numbers of type T alone.
template <class T, class Numbers>
EPDEM_INLINE T number_at(const Numbers& all, std::size_t k) noexcept {
  T x;
  ::memcpy(&x, reinterpret_cast<const char*>(&all) + k * sizeof x, sizeof x);
  return x;
}
template <class Numbers, class T>
EPDEM_INLINE void put_number(Numbers& all, std::size_t k, const T& x) noexcept {
  ::memcpy(reinterpret_cast<char*>(&all) + k * sizeof x, &x, sizeof x);
}

/// The first `count` numbers one by one: a copy as a whole would go through memory.
template <class T, std::size_t count, class From, class To>
EPDEM_INLINE void copy_numbers(const From& from, To& to) noexcept {
  EPDEM_UNROLL for (std::size_t k = 0; k < count; ++k) put_number(to, k, number_at<T>(from, k));
}

/// All numbers where the mask says so, else 0.
template <class T, class M, class Numbers>
EPDEM_INLINE void keep_where(M mask, Numbers& all) noexcept {
  if constexpr (!std::is_empty_v<Numbers>) {
    EPDEM_UNROLL for (std::size_t k = 0; k < sizeof(Numbers) / sizeof(T); ++k)
        put_number(all, k, select(mask, number_at<T>(all, k), T{}));
  }
}

/// Room for numbers that are set one by one: to set all of them before takes time, where few are used or all follow.
template <class Numbers>
union Unset {
  Numbers numbers;
  Unset() noexcept {}
};

template <class T>
EPDEM_INLINE T load(const double* p) noexcept {
  T x;
  ::memcpy(&x, p, sizeof x);
  return x;
}
template <class T>
EPDEM_INLINE void store(double* p, const T& x) noexcept {
  ::memcpy(p, &x, sizeof x);
}

}  // namespace epdem
