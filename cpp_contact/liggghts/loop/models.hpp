// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's own models beside the law, on lanes: the operations of its headers in their order, so that the bits agree.
#pragma once

#include "block.hpp"
#include "epdem/partial_slip.hpp"

namespace epdem::liggghts::loop {
namespace {

using epdem::select;

using Three = epdem::Vec<Lanes>;

EPDEM_INLINE Three operator*(double s, const Three& a) { return {s * a.x, s * a.y, s * a.z}; }
EPDEM_INLINE Three operator/(const Three& a, Lanes s) { return {a.x / s, a.y / s, a.z / s}; }
EPDEM_INLINE Three operator-(const Three& a) { return {-a.x, -a.y, -a.z}; }
EPDEM_INLINE Lanes magnitude(const Three& a) { return sqrt(dot(a, a)); }
template <class M>
EPDEM_INLINE Three select(M m, const Three& a, const Three& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

/// A contact as LIGGGHTS's models see it; names are theirs.
struct Contact {
  Lanes radi, radj, r, rinv, radsum, deltan, cri, crj, vn;
  Three delta, en, vtr, omega_i, omega_j, roll;  // roll: what rolling friction resists
  Lanes Fn, kn, kt, gammat, reff;
};

/// What surface default makes of the relative velocity and of `spin`, the sum of radius times spin over the distance.
EPDEM_INLINE Three sliding(const Contact& c, const Three& v, const Three& spin) {
  const Three vt = v - c.vn * c.en;
  const Three& d = c.delta;
  return {vt.x - (d.z * spin.y - d.y * spin.z), vt.y - (d.x * spin.z - d.z * spin.x),
          vt.z - (d.y * spin.x - d.x * spin.y)};
}

/// surface default, of two spheres.
EPDEM_INLINE void surface(Contact& c, const Three& v) {
  c.r = sqrt(dot(c.delta, c.delta));
  c.rinv = 1.0 / c.r;
  c.en = c.rinv * c.delta;
  c.vn = dot(v, c.en);
  c.radsum = c.radi + c.radj;
  c.deltan = c.radsum - c.r;
  c.cri = c.radi - 0.5 * c.deltan;
  c.crj = c.radj - 0.5 * c.deltan;
  c.reff = reduced_finite(c.radi, c.radj);
  c.vtr = sliding(c, v, c.rinv * (c.cri * c.omega_i + c.crj * c.omega_j));
  c.roll = c.omega_i - c.omega_j;
}

/// The same of a sphere and a wall, whose overlap LIGGGHTS's loop has found.
EPDEM_INLINE void surface_of_wall(Contact& c, const Three& v, Lanes overlap) {
  c.r = c.radi - overlap;
  c.rinv = 1.0 / c.r;
  c.en = c.rinv * c.delta;
  c.vn = dot(v, c.en);
  c.deltan = c.radi - c.r;
  c.cri = c.radi - 0.5 * overlap;
  c.reff = c.radi;
  c.roll = c.rinv * (c.cri * c.omega_i);
  c.vtr = sliding(c, v, c.roll);
}

/// cohesion sjkr, sjkr2: a force along the normal.
template <bool wall>
EPDEM_INLINE Lanes cohesive_force(const Contact& c, Cohesion model, Lanes density) {
  const Lanes &r = c.r, &ri = c.radi, &rj = c.radj;
  if constexpr (wall) return -density * (model == Cohesion::sjkr ? (ri * ri - r * r) * pi : pi * 2. * ri * (ri - r));
  if (model == Cohesion::sjkr) {
    const Lanes area = -pi / 4 * ((r - ri - rj) * (r + ri - rj) * (r - ri + rj) * (r + ri + rj)) / (r * r);
    return -density * area;
  }
  return -density * (pi * 2. * (2. * ri * rj / (ri + rj)) * (ri + rj - r));
}

/// tangential no_history.
EPDEM_INLINE Three sliding_dashpot(const Contact& c, Lanes friction) {
  const Lanes v = magnitude(c.vtr), limit = friction * fabs(c.Fn);
  return (-select(limit < c.gammat * v, limit / v, c.gammat)) * c.vtr;
}

/// Whether a lane may be above its limit, without a root: all that are far below it stay as they are.
EPDEM_INLINE bool near_limit(Lanes squared, Lanes limit) { return any(!(squared <= 0.9 * limit * limit)); }

/// tangential history: spring with dashpot, cut off by friction; `stretch` before and after.
EPDEM_INLINE Three sliding_spring(const Contact& c, Lanes friction, bool damped, double dt, Three& stretch) {
  stretch = stretch + dt * c.vtr;
  stretch = stretch - dot(stretch, c.en) * c.en;
  const Three spring = -(c.kt * stretch);
  const Lanes most = friction * fabs(c.Fn);
  Three force = damped ? spring - c.gammat * c.vtr : spring;
  if (near_limit(dot(spring, spring), most)) {
    const Lanes pull = c.kt * magnitude(stretch);
    const auto slides = pull > most;
    const Three slipping = (most / pull) * spring;
    stretch = select(slides, (-slipping) / c.kt, stretch);
    force = select(slides, slipping, force);
  }
  return force;
}

/// rolling_friction cdt: the torque on j.
template <bool wall>
EPDEM_INLINE Three rolling_torque(const Contact& c, Lanes friction, bool torsion) {
  const Three& w = c.roll;
  const Lanes speed = magnitude(w);
  Three torque;
  if constexpr (wall)
    torque = c.reff * (((friction * (c.deltan * c.kn)) * w) / speed);
  else
    torque = (friction * c.kn * c.deltan * c.reff / speed) * w;
  if (!torsion) torque = torque - dot(torque, c.en) * c.en;
  return select(speed > 0.0, torque, Three{});
}

/// rolling_friction epsd2: a spring, cut off; `torque` before and after is that on j.
EPDEM_INLINE void rolling_spring(const Contact& c, Lanes friction, bool torsion, double dt, Three& torque) {
  Three w = c.roll;
  if (!torsion) w = w - dot(w, c.en) * c.en;
  torque = torque + (dt * (c.kt * c.reff * c.reff)) * w;
  const Lanes most = fabs(c.Fn) * c.reff * friction;
  if (near_limit(dot(torque, torque), most)) {
    const Lanes now = magnitude(torque);
    torque = select(now > most, (most / now) * torque, torque);
  }
}

}  // namespace
}  // namespace epdem::liggghts::loop
