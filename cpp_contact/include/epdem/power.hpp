// SPDX-License-Identifier: GPL-2.0-or-later
// A power of a number >= 1 in all lanes at once, with the bits of one contact: libm's exp and log take one lane each.
#pragma once

#include "lanes.hpp"

namespace epdem {

namespace detail {

template <class T>
using Bits = std::conditional_t<is_vector<T>, Words, unsigned long long>;
template <class To, class From>
EPDEM_INLINE To bits_as(const From& x) noexcept {
  To y;
  __builtin_memcpy(&y, &x, sizeof y);
  return y;
}

inline constexpr double ln2_high = 0x1.62e42fefap-1, ln2_low = 0x1.cf79abc9e3b3ap-40;  // their sum is ln 2

}  // namespace detail

/// base^h for 1 <= base and 0 <= h <= 1/2; relative error below 1e-15 (1 + ln base). h = 0 gives 1
/// exactly. Any other base gives a number without meaning and does not trap.
template <class T>
EPDEM_INLINE T power(const T& base, const T& h) noexcept {
  if constexpr (std::is_same_v<T, long double>) {
    return exp(h * log(base));
  } else {
    using namespace detail;
    // base = 2^e m, m in [1/sqrt 2, sqrt 2): the exponent's bits below the mantissa of 2^52 are the number e + 1023
    constexpr unsigned long long mantissa = 0xfffffffffffff, one = 0x3ff0000000000000, big = 0x4330000000000000;
    constexpr unsigned long long root = 0x3fe6a09e667f3bcd;  // of 1/2
    const Bits<T> x = bits_as<Bits<T>>(base) + (one - root);
    const T e = bits_as<T>((x >> 52) | big) - (4503599627370496.0 + 1023.0);
    const T m = bits_as<T>((x & mantissa) + root);
    const T f = (m - 1.0) / (m + 1.0), g = f * f;
    T series = T{} + 1.0 / 21.0;  // of ln m = 2 (f + f^3/3 + ...), f^2 < 0.0295
    for (int k = 19; k > 1; k -= 2) series = series * g + 1.0 / k;
    const T y = h * (e * ln2_high + (2.0 * f + (2.0 * f * g * series + e * ln2_low)));
    // y = n ln 2 + r: adding 1.5 2^52 rounds, and leaves n in the last bits
    const T rounded = y * 1.4426950408889634 + 6755399441055744.0, n = rounded - 6755399441055744.0;
    const T r = (y - n * ln2_high) - n * ln2_low;
    T grown = T{} + 1.0 / 6227020800.0;  // exp r, |r| < 0.35
    constexpr double inverse[] = {1.0 / 479001600.0,
                                  1.0 / 39916800.0,
                                  1.0 / 3628800.0,
                                  1.0 / 362880.0,
                                  1.0 / 40320.0,
                                  1.0 / 5040.0,
                                  1.0 / 720.0,
                                  1.0 / 120.0,
                                  1.0 / 24.0,
                                  1.0 / 6.0,
                                  0.5,
                                  1.0,
                                  1.0};
    for (const double c : inverse) grown = grown * r + c;
    return grown * bits_as<T>((bits_as<Bits<T>>(rounded) << 52) + one);
  }
}

}  // namespace epdem
