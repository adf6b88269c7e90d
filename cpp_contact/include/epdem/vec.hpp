// SPDX-License-Identifier: BSD-3-Clause
// Vectors in space, of one contact (double) or of many lanes.
#pragma once

#include "lanes.hpp"

namespace epdem {

template <class T>
struct Vec {
  T x, y, z;
};

template <class T>
EPDEM_INLINE Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
EPDEM_INLINE Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
EPDEM_INLINE Vec<T> operator-(const Vec<T>& a) noexcept {
  return {-a.x, -a.y, -a.z};
}
template <class T>
EPDEM_INLINE Vec<T> operator*(const T& c, const Vec<T>& a) noexcept {
  return {c * a.x, c * a.y, c * a.z};
}
template <class T, class = std::enable_if_t<!std::is_same_v<T, double>>>
EPDEM_INLINE Vec<T> operator*(double c, const Vec<T>& a) noexcept {
  return {c * a.x, c * a.y, c * a.z};
}
template <class T>
EPDEM_INLINE Vec<T> operator/(const Vec<T>& a, const T& c) noexcept {
  return {a.x / c, a.y / c, a.z / c};
}
template <class T>
EPDEM_INLINE T dot(const Vec<T>& a, const Vec<T>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
EPDEM_INLINE Vec<T> cross(const Vec<T>& a, const Vec<T>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
EPDEM_INLINE T length(const Vec<T>& a) noexcept {
  return sqrt(dot(a, a));
}
template <class M, class T>
EPDEM_INLINE Vec<T> select(M mask, const Vec<T>& a, const Vec<T>& b) noexcept {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

}  // namespace epdem
