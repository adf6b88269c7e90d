// SPDX-License-Identifier: BSD-3-Clause
// Logarithm, exponential and power in all lanes at once, with the bits of one contact: libm's functions take one lane
// each. The polynomials are sums of pairs: the terms of a long chain would wait for each other.
#pragma once

#include "lanes.hpp"

namespace epdem {

namespace detail {

template <class T>
using Bits = std::conditional_t<is_vector<T>, Words, unsigned long long>;
template <class To, class From>
EPDEM_INLINE To bits_as(const From& x) noexcept {
  To y;
  ::memcpy(&y, &x, sizeof y);
  return y;
}

inline constexpr double ln2_high = 0x1.62e42fefap-1, ln2_low = 0x1.cf79abc9e3b3ap-40;  // their sum is ln 2
inline constexpr unsigned long long one_as_bits = 0x3ff0000000000000;

}  // namespace detail

/// ln x of a normal number x > 0; relative error below 5e-16, 0 at 1. Any other number gives one without meaning and
/// does not trap.
template <class T>
EPDEM_INLINE T logarithm(const T& number) noexcept {
  if constexpr (std::is_same_v<T, long double>) {
    return log(number);
  } else {
    using namespace detail;
    // number = 2^e m, m in [1/sqrt 2, sqrt 2): the exponent's bits below the mantissa of 2^52 are the number e + 1023
    constexpr unsigned long long mantissa = 0xfffffffffffff, big = 0x4330000000000000;
    constexpr unsigned long long root = 0x3fe6a09e667f3bcd;  // of 1/2
    const Bits<T> x = bits_as<Bits<T>>(number) + (one_as_bits - root);
    const T e = bits_as<T>((x >> 52) | big) - (4503599627370496.0 + 1023.0);
    const T m = bits_as<T>((x & mantissa) + root);
    // ln m = 2 (f + f^3/3 + ...), f^2 < 0.0295: minimax polynomial of what follows f, over f^3
    const T f = (m - 1.0) / (m + 1.0), g = f * f, g2 = g * g;
    const T low = (0.3333333333333335 + 0.19999999999949722 * g) + (0.14285714313001635 + 0.11111105565129939 * g) * g2;
    const T high = (0.09091444727837474 + 0.07665855309105386 * g) + 0.07308292712444311 * g2;
    return e * ln2_high + (2.0 * f + (2.0 * f * g * (low + high * (g2 * g2)) + e * ln2_low));
  }
}

/// exp y for |y| < 708; relative error below 3e-16, 1 at 0.
template <class T>
EPDEM_INLINE T exponential(const T& y) noexcept {
  if constexpr (std::is_same_v<T, long double>) {
    return exp(y);
  } else {
    using namespace detail;
    // y = n ln 2 + r: adding 1.5 2^52 rounds, and leaves n in the last bits
    const T rounded = y * 1.4426950408889634 + 6755399441055744.0, n = rounded - 6755399441055744.0;
    const T r = (y - n * ln2_high) - n * ln2_low;
    // minimax polynomial of (exp r - 1 - r)/r^2, |r| < 0.347
    const T r2 = r * r, r4 = r2 * r2;
    const T c0 = (0.5000000000000001 + 0.16666666666666669 * r) + (0.04166666666662413 + 0.008333333333330062 * r) * r2;
    const T c1 = (0.0013888888917213717 + 0.00019841269863053618 * r) +
                 (2.4801521295954376e-05 + 2.7557268459997064e-06 * r) * r2;
    const T c2 = 2.7620088445409746e-07 + 2.510038549551032e-08 * r;
    const T grown = 1.0 + (r + r2 * (c0 + (c1 + c2 * r4) * r4));
    return grown * bits_as<T>((bits_as<Bits<T>>(rounded) << 52) + one_as_bits);
  }
}

/// base^h for 1 <= base and 0 <= h <= 1/2; relative error below 1e-15 (1 + ln base). h = 0 gives 1 exactly.
template <class T>
EPDEM_INLINE T power(const T& base, const T& h) noexcept {
  return exponential<T>(h * logarithm(base));
}

}  // namespace epdem
