/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * C interface of the contact laws. SI units. No function keeps state, allocates or throws.
 * Functions that can fail return an epdem_status; epdem_message() says what it means. Numbers whose powers leave the
 * range of a double (a radius of 1e-300 m) give results that are not finite.
 */
#ifndef EPDEM_H
#define EPDEM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EPDEM_ABI 10
#define EPDEM_MAX_PARAMETERS 8

typedef enum { EPDEM_OK = 0, EPDEM_UNKNOWN_LAW = 1, EPDEM_BAD_PARAMETER = 2, EPDEM_BAD_INPUT = 3 } epdem_status;

typedef struct {
  double force;     /* [N] */
  double radius;    /* contact radius [m] */
  double delta_max; /* what the contact remembers after this step [m] */
} epdem_step_result;

typedef struct {
  double R_star;    /* [m] */
  double m_star;    /* [kg] */
  double speed;     /* approach speed [m/s] */
  double time_step; /* [s] */
  double gap;       /* before first touch [m]; negative: overlap at the start */
  int64_t steps;    /* largest number of steps */
  double viscous;   /* epdem_viscous_number of the pair, 0: no dashpot */
} epdem_impact_input;

typedef struct {
  double rebound_speed; /* [m/s]; 0 if bodies that adhere are still in contact at the end */
  double force_max;     /* largest sample [N] */
  double overlap_max;   /* largest sample [m] */
  double last_overlap;  /* at the last loaded sample [m] */
  int64_t first, last;  /* first and last step with a force, -1 if none */
  int64_t steps;        /* taken */
} epdem_impact_output;

/* Identity of the library. */
int epdem_abi(void);
const char* epdem_version(void);
const char* epdem_message(int status);
size_t epdem_size_of(const char* struct_name); /* 0 if there is no such struct */

/* What each law declares of itself: a JSON array, in the order of the index of a law. Of a law: name, id (of the
 * LIGGGHTS model "ep/" + name, stored in restart files), title, sources (short names of publications, separated by
 * semicolons), condition (on its parameters together, or null), parameters, strength (the parameter at which a body
 * yields, or null), default_ratio (strength over the yield stress of the softer body), memory (doubles that a host
 * keeps from step to step), yields, flattens (unloading is not Hertz's), adheres (bodies attract each other, the step
 * takes the closing speed), without_adhesion (the law for work 0, or null). Of a parameter: name, property (LIGGGHTS
 * property/global), symbol, unit, default (or null), may_vanish (0 is a value), of_pair (of two surfaces, not of a
 * body), below (where its range ends, or null). */
const char* epdem_declarations(void);

/* n steps, each from its own R_star, delta_max and delta (with adhesion: of a contact that has stood since it reached
 * delta_max, at rest); `parameters` in the order of the declaration, then one more number of finite strain: the
 * mean curvature of both bodies, weighted by their shares of the strain, times R*: 1/2 for bodies of equal strength, 1
 * for a sphere on a rigid plane, 0 for a rigid sphere on a plane. */
int epdem_step(int law, double E_star, const double* parameters, size_t n, const double* R_star,
               const double* delta_max, const double* delta, epdem_step_result* out);

/* Overlap of first yield (inf: never) and, of contacts that reached delta_max, the overlap at which the force returns
 * to 0 (the dent; 0 before yield), both [m]. Of laws without adhesion; EPDEM_UNKNOWN_LAW of others. */
int epdem_yield(int law, double E_star, const double* parameters, size_t n, const double* R_star,
                const double* delta_max, double* yield_overlap, double* dent);

/* Dashpot number of a restitution at low speed in [0.14, 1]; NaN outside. */
double epdem_viscous_number(double restitution);

/* The backbone of n contacts of radii R_star at their overlaps: force [N], radius [m], work [J], plastic work of a
 * contact that got there [J]. */
int epdem_backbone(int law, double E_star, const double* parameters, size_t n, const double* R_star,
                   const double* delta, double* force, double* radius, double* work, double* plastic_work);

/* n independent two-body impacts. overlap, force and velocity may be NULL, or hold n * stride samples
 * (stride >= steps + 1 of every impact); the samples after the end of an impact are left as they were. */
int epdem_impacts(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                  epdem_impact_output* out, size_t stride, double* overlap, double* force, double* velocity);

/* n oblique impacts of solid spheres (or one on a plane) in a plane: slip[i] is the velocity of the surfaces against
 * each other before, slip_after[i] after [m/s]; nodes: 2 or 3 of partial slip, or 0 for one spring. */
int epdem_oblique(int law, double E_star, const double* parameters, double G_star, double mu, int nodes, size_t n,
                  const epdem_impact_input* in, const double* slip, double* slip_after);

/* One contact through n steps of a prescribed motion, each of 9 numbers: overlap [m], closing speed times the time step
 * [m], normal (3, unit), slip of the surfaces in the step (3) [m], rotation about the normal in it, mean of both [rad];
 * out: of each step normal force and friction (3) on the body that the normal points to [N]. nodes as above. */
int epdem_motion(int law, double E_star, const double* parameters, double R_star, double G_star, double mu, int nodes,
                 size_t n, const double* motion, double* out);

/* The same impacts computed in long double and rounded once, at the end: the difference is round-off. */
int epdem_impacts_long_double(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                              epdem_impact_output* out);

/* `count` impacts of one contact that keeps its memory, each at the rebound speed of the one before; speeds may be
 * NULL or takes `count` rebound speeds [m/s]; out is the last impact, with the steps of all impacts. */
int epdem_bounces(int law, double E_star, const double* parameters, const epdem_impact_input* first, int64_t count,
                  epdem_impact_output* out, double* speeds);

#ifdef __cplusplus
}
#endif
#endif
