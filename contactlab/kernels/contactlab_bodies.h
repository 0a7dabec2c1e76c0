/* The rebound of two bodies of any shape: velocities and spins in and out.
 *
 * Hertz's contact with Coulomb friction and partial slip. Elastic it is exact to 1e-11 of the speed, several
 * compressions and jams included, where slip keeps its line: bodies whose slip is in a plane of symmetry of both, and
 * bodies whose centres are on the normal; where slip may turn there is a status. With a restitution below 1 the contact
 * is that of Kelvin and Voigt, slip may turn, and 50 springs march. Theory: sections 14 and 15 of
 * `contactlab guide theory`.
 *
 *     const contactlab_rigid rod = {2.0, {...}, {0, 0, 0.4}}, ground = {0};
 *     int status = contactlab_bodies_bounce(&rod, &ground, 0.6, 0.8235, 1, down, velocity, spin, still, none,
 *                                           NULL);
 *
 * It needs contactlab_impact.h and contactlab_march.h beside it. C99 and C++, no allocation, no global.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */
#ifndef CONTACTLAB_BODIES_H
#define CONTACTLAB_BODIES_H

#include "contactlab_impact.h"
#include "contactlab_march.h"

/* Statuses beside those of contactlab_impact.h: the bodies part along the normal, slip may leave its line, a number is
 * none or out of range, and steps find no end of the impact. */
enum {
  CONTACTLAB_BODIES_APART = 16, CONTACTLAB_BODIES_TURNS = 17, CONTACTLAB_BODIES_RANGE = 18, CONTACTLAB_BODIES_ENDLESS = 19
};

/* A body in SI units and in the frame of all vectors: mass, inverse of the inertia tensor about the centre of mass, row
 * by row, and the vector from there to the contact. A body of mass 0 is held: nothing moves or turns it. */
typedef struct { double mass, inverse_inertia[9], arm[3]; } contactlab_rigid;

/* Parts of the inverse mass, and of the slip over the speed, that are rounding; and of the determinant that is none. */
#define CONTACTLAB_BODIES_ROUNDING 1e-12
#define CONTACTLAB_BODIES_SINGULAR 1e-14

static inline double contactlab_bodies_dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void contactlab_bodies_cross(const double *a, const double *b, double *out)
{
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Adds to v and w the changes by an impulse at the contact, both masses divided by `unit`. */
static inline void contactlab_bodies_push(const contactlab_rigid *body, const double *impulse, double unit, double *v,
                                          double *w)
{
  double moment[3];
  int k;
  if (!(body->mass > 0)) return;
  contactlab_bodies_cross(body->arm, impulse, moment);
  for (k = 0; k < 3; ++k) {
    v[k] += 1 / body->mass / unit * impulse[k];
    w[k] += contactlab_bodies_dot(body->inverse_inertia + 3 * k, moment) / unit;
  }
}

/* The inverse mass W in 1/kg times f: what the contact points gain over each other by an impulse f and its opposite. */
static inline void contactlab_bodies_yield(const contactlab_rigid *const *bodies, const double *f, double *out)
{
  int i, k;
  for (k = 0; k < 3; ++k) out[k] = 0;
  for (i = 0; i < 2; ++i) {
    double v[3] = {0, 0, 0}, w[3] = {0, 0, 0}, rim[3];
    contactlab_bodies_push(bodies[i], f, 1, v, w);
    contactlab_bodies_cross(w, bodies[i]->arm, rim);
    for (k = 0; k < 3; ++k) out[k] += v[k] + rim[k];
  }
}

/* kappa, the tangential over the normal stiffness, of Young's moduli and Poisson's ratios: 2 (1 - nu)/(2 - nu) for like
 * bodies. Only the ratio of the moduli counts. */
static inline double contactlab_bodies_stiffness(double young, double poisson, double other_young, double other_poisson)
{
  const double one = (1 + poisson) / young, other = (1 + other_poisson) / other_young;
  return 2 * (one * (1 - poisson) + other * (1 - other_poisson)) / (one * (2 - poisson) + other * (2 - other_poisson));
}

/* n and two tangents, unit vectors as rows. */
static inline void contactlab_bodies_axes(const double *n, double *axes)
{
  double any[3] = {0, 0, 0}, size;
  int k, least = 0;
  for (k = 1; k < 3; ++k) least = fabs(n[k]) < fabs(n[least]) ? k : least;
  any[least] = 1;
  for (k = 0; k < 3; ++k) axes[k] = n[k];
  contactlab_bodies_cross(n, any, axes + 3);
  size = sqrt(contactlab_bodies_dot(axes + 3, axes + 3));
  for (k = 0; k < 3; ++k) axes[3 + k] /= size;
  contactlab_bodies_cross(n, axes + 3, axes + 6);
}

/* Finds the line t along which slip stays, zero where nothing slips, and whether friction changes the approach. Returns
 * a status. `pull` is the part of W n along the surface, `slip` that of the velocity. */
static inline int contactlab_bodies_line(const contactlab_rigid *const *bodies, const double *n, double pressed,
                                         const double *pull, const double *slip, double approach, double *t,
                                         int *coupled)
{
  const double little = CONTACTLAB_BODIES_ROUNDING, size = sqrt(contactlab_bodies_dot(pull, pull));
  const double slips = sqrt(contactlab_bodies_dot(slip, slip));
  double across[3], yielded[3], along = 0, axes[9];
  int k;
  contactlab_bodies_axes(n, axes);
  for (k = 3; k < 9; k += 3) { /* the mean tangential mobility */
    contactlab_bodies_yield(bodies, axes + k, yielded);
    along += 0.5 * contactlab_bodies_dot(yielded, axes + k);
  }
  *coupled = size > little * sqrt(pressed * along);
  for (k = 0; k < 3; ++k) t[k] = 0;
  if (!*coupled && !(slips > little * (fabs(approach) + slips))) return CONTACTLAB_IMPACT_DONE;
  for (k = 0; k < 3; ++k) t[k] = *coupled ? pull[k] / size : slip[k] / slips;
  contactlab_bodies_cross(n, t, across);
  if (fabs(contactlab_bodies_dot(slip, across)) > little * (approach + fabs(contactlab_bodies_dot(slip, t))))
    return CONTACTLAB_BODIES_TURNS;
  contactlab_bodies_yield(bodies, t, yielded);
  along = *coupled ? 1 : 1 + approach / slips; /* across its line slip changes by a share of itself */
  if (fabs(contactlab_bodies_dot(yielded, across)) > little * along * contactlab_bodies_dot(yielded, t))
    return CONTACTLAB_BODIES_TURNS;
  return CONTACTLAB_IMPACT_DONE;
}

/* a = A v1/(C^2 R) of a restitution from 0.01 to 1 (theory, section 15), to 2e-10 of e. */
static inline double contactlab_bodies_relaxation(double e)
{
  static const double terms[13] = {1.1117603234, 2.2069240894e-2, 1.693150355e-3, -6.0396428493e-4, 1.2285619681e-4,
    -2.0696505414e-5, 2.8178510532e-6, -1.6950910388e-7, -8.1828646693e-8, 5.0365173402e-8, -2.0123813399e-8,
    7.0226410944e-9, -2.3074047795e-9};
  const double x = (cbrt(e) - 0.6) / 0.4;
  double last = 0, before = 0;
  int k;
  for (k = 12; k > 0; --k) { /* Clenshaw's sum of Chebyshev polynomials */
    const double next = 2 * x * last - before + terms[k];
    before = last;
    last = next;
  }
  return expm1(-0.6 * log(e)) / (x * last - before + terms[0]);
}

/* Marches an impact with a restitution: W along n and two tangents, and rates, in units of W_nn and the approach. Leaves
 * the impulse in their units. */
static inline int contactlab_bodies_march(const double *W, const double *rates, double friction, double stiffness,
                                          double restitution, double *impulse, contactlab_impact *left)
{
  enum { SPRINGS = 50, LEAST = 200, MOST = 20000, LONGEST = 60, DEEPEST = 16, COURSE = 2 };
  const int row[2] = {0, 1}, column[1] = {0};
  const double deepest = DEEPEST, modulus = 15.0 / 16.0; /* the approach, R and the duration are 1, 1 and Hertz's */
  double work[CONTACTLAB_MARCH_WORK(1, SPRINGS)], duration = 0, steps;
  contactlab_march_sample samples[COURSE];
  contactlab_march_contact c;
  contactlab_march_progress progress;
  contactlab_march_run run;
  contactlab_march_end end;
  int k, status;
  memset(&c, 0, sizeof c);
  for (k = 0; k < 3; ++k) c.velocity[k] = rates[k];
  c.friction = friction;
  c.radius = c.cross = c.speed = c.share = 1;
  c.modulus = modulus;
  c.shear = 2 * modulus * stiffness;
  c.time = contactlab_bodies_relaxation(restitution);
  c.span = contactlab_march_course(c.time, COURSE, samples);
  for (k = 0; k < COURSE; ++k) duration += samples[k].kick;
  /* twice the steps that resolve the contact as large as without friction */
  steps = ceil(4 * duration * sqrt(2 * modulus * c.span * (W[0] + stiffness * (W[4] + W[8]))));
  if (!(steps <= MOST)) return CONTACTLAB_BODIES_RANGE;
  if (steps < LEAST) steps = LEAST;
  {
    const contactlab_march_scene scene = {1, &c, row, column, W, 2, SPRINGS, 1, 1, duration / steps, ceil(0.4 * steps),
                                          LONGEST * steps, &deepest, &progress, work, &end};
    status = contactlab_march_begin(&run, &scene);
  }
  while (status == CONTACTLAB_MARCH_GOING) status = contactlab_march_on(&run, MOST);
  if (status) return status == CONTACTLAB_MARCH_INPUT ? CONTACTLAB_BODIES_RANGE : CONTACTLAB_BODIES_ENDLESS;
  for (k = 0; k < 3; ++k) impulse[k] = end.impulse[k];
  left->rate = 1 + end.change[0];
  left->change = sqrt(end.change[1] * end.change[1] + end.change[2] * end.change[2]) * stiffness / friction;
  left->work = end.work * 2 * stiffness / (2.5 * friction * friction);
  left->time = end.duration;
  left->radius = end.radius;
  left->compressions = (int) end.compressions;
  left->steps = (int) run.steps;
  return CONTACTLAB_IMPACT_DONE;
}

/* Sets velocities and spins of two bodies to those after their collision. SI units; vectors have three numbers
 * in one frame.
 *
 * one, other       the bodies
 * friction         coefficient, at least 0
 * stiffness        kappa, from contactlab_bodies_stiffness; of round contacts the curvature does not count
 * restitution      e of the contact without friction, from 0.01 to 1, 1 is elastic: that of the bodies follows from it
 * normal           from the first body into the other; any length
 * velocity, spin   of the first body's centre of mass, in m/s and rad/s; other_velocity, other_spin of the other's
 * left             the end of the impact in the units of theory section 1, or null. It lasts left->time d/v, d the
 *                  largest approach of Hertz's impact at the speed v, (15 m v^2/(16 E sqrt(R)))^0.4, m = 1/W_nn
 *
 * Returns a status: 0 is an answer, else nothing is changed. Of bodies whose centres are on the normal spin about it
 * passes through. Masses may be of any size up to 1e130 kg. */
static inline int contactlab_bodies_bounce(const contactlab_rigid *one, const contactlab_rigid *other, double friction,
                                           double stiffness, double restitution, const double *normal,
                                           double *velocity, double *spin, double *other_velocity, double *other_spin,
                                           contactlab_impact *left)
{
  const contactlab_rigid *bodies[2];
  const double *speeds[2], *turns[2];
  contactlab_impact out = {-1, 0, 0, 2.9432751843247043, 1, 1, 0};
  double n[3], t[3], slip[3] = {0, 0, 0}, pull[3], yielded[3], impulse[3], sum = 0;
  double pressed, approach, size, drag = 0, mobility = 1, push;
  int i, k, coupled, status;
  bodies[0] = one;
  bodies[1] = other;
  speeds[0] = velocity;
  speeds[1] = other_velocity;
  turns[0] = spin;
  turns[1] = other_spin;
  for (i = 0; i < 2; ++i) {
    double rim[3];
    if (!(bodies[i]->mass >= 0 && bodies[i]->mass <= 1e130)) return CONTACTLAB_BODIES_RANGE;
    contactlab_bodies_cross(turns[i], bodies[i]->arm, rim);
    for (k = 0; k < 3; ++k) {
      slip[k] += (i ? -1 : 1) * (speeds[i][k] + rim[k]);
      sum += fabs(speeds[i][k]) + fabs(turns[i][k]) + fabs(bodies[i]->arm[k]);
    }
    for (k = 0; k < 9; ++k) sum += 1e-130 * fabs(bodies[i]->inverse_inertia[k]);
  }
  size = fmax(fabs(normal[0]), fmax(fabs(normal[1]), fabs(normal[2]))); /* squares may be no numbers */
  for (k = 0; k < 3; ++k) n[k] = normal[k] / size;
  size = sqrt(contactlab_bodies_dot(n, n));
  for (k = 0; k < 3; ++k) n[k] /= size;
  if (!(size > 0 && sum <= 1e60 && friction >= 0 && friction <= 1e60)) return CONTACTLAB_BODIES_RANGE;
  if (!(stiffness >= 0.1 && stiffness <= 10 && restitution >= 0.01 && restitution <= 1)) return CONTACTLAB_BODIES_RANGE;
  contactlab_bodies_yield(bodies, n, pull);
  pressed = contactlab_bodies_dot(n, pull);
  approach = contactlab_bodies_dot(n, slip);
  if (!(pressed > 1e-200 && pressed < 1e200)) return CONTACTLAB_BODIES_RANGE;
  if (!(approach > 1e-100)) return CONTACTLAB_BODIES_APART;
  for (k = 0; k < 3; ++k) {
    slip[k] -= approach * n[k];
    pull[k] -= pressed * n[k];
  }
  push = -(1 + restitution) * approach;
  out.rate = -restitution;
  for (k = 0; k < 3; ++k) t[k] = 0;
  if (friction > 0 && restitution < 1) {
    double axes[9], W[9], rates[3], kick[3];
    contactlab_bodies_axes(n, axes);
    for (k = 0; k < 3; ++k) {
      contactlab_bodies_yield(bodies, axes + 3 * k, yielded);
      for (i = 0; i < 3; ++i) W[3 * i + k] = contactlab_bodies_dot(axes + 3 * i, yielded) / pressed;
      rates[k] = k ? contactlab_bodies_dot(axes + 3 * k, slip) / approach : 1;
    }
    status = contactlab_bodies_march(W, rates, friction, stiffness, restitution, kick, &out);
    if (status) return status;
    push = -kick[0] * approach;
    for (k = 0; k < 3; ++k) t[k] = -approach * (kick[1] * axes[3 + k] + kick[2] * axes[6 + k]);
    drag = 1;
  } else if (friction > 0) {
    const double unit = friction * approach / stiffness; /* of psi */
    double change, pulled = 0, psi1, chi;
    status = contactlab_bodies_line(bodies, n, pressed, pull, slip, approach, t, &coupled);
    if (status) return status;
    contactlab_bodies_yield(bodies, t, yielded);
    mobility = contactlab_bodies_dot(t, yielded) / pressed;
    if (coupled) pulled = contactlab_bodies_dot(t, pull) / pressed;
    if (contactlab_bodies_dot(t, t) > 0) {
      if (!(mobility - pulled * pulled > CONTACTLAB_BODIES_SINGULAR * mobility)) return CONTACTLAB_BODIES_RANGE;
      chi = 0.5 * stiffness * mobility;
      psi1 = contactlab_bodies_dot(slip, t) / unit;
      if (!coupled) psi1 = fmin(psi1, 4 * chi + 1); /* it slips throughout */
      if (!(fabs(psi1) <= 1e100)) return CONTACTLAB_BODIES_RANGE;
      status = contactlab_impact_follow(psi1, chi, friction * pulled, stiffness * pulled / friction,
                                        CONTACTLAB_IMPACT_EXACT, 20000, &out);
      if (status) return status == CONTACTLAB_IMPACT_RANGE ? CONTACTLAB_BODIES_RANGE : status;
      change = out.change * unit;
      push = approach * (out.rate - 1);
      drag = (change - pulled * push) / (mobility - pulled * pulled);
      push -= pulled * drag;
    }
  }
  for (k = 0; k < 3; ++k) impulse[k] = push * n[k] + drag * t[k];
  contactlab_bodies_push(one, impulse, pressed, velocity, spin);
  for (k = 0; k < 3; ++k) impulse[k] = -impulse[k];
  contactlab_bodies_push(other, impulse, pressed, other_velocity, other_spin);
  if (left) *left = out;
  return CONTACTLAB_IMPACT_DONE;
}

/* A contact between some bodies: their places, the second -1 for a wall; the vectors from their centres of mass to the
 * contact; and n, t1 and t2, unit vectors as rows, n from the first into the second. Arms of the bodies do not count. */
typedef struct { int first, second; double arm[3], other_arm[3], axes[9]; } contactlab_touch;

/* The side of a contact on a body, with its arm: 1 if the body is the first, -1 if the second, 0 if neither. */
static inline int contactlab_bodies_side(const contactlab_rigid *bodies, int place, const contactlab_touch *touch,
                                         contactlab_rigid *at)
{
  const int side = place < 0 ? 0 : touch->first == place ? 1 : touch->second == place ? -1 : 0;
  int k;
  if (!side) return 0;
  *at = bodies[place];
  for (k = 0; k < 3; ++k) at->arm[k] = side > 0 ? touch->arm[k] : touch->other_arm[k];
  return side;
}

/* Writes W of some contacts as a contactlab_march_scene takes it: row (contacts + 1), and of each block of 3 x 3 that is
 * not zero its column and 9 numbers, with room for `most` blocks. Returns how many there are, or -1 if there are more. */
static inline int contactlab_bodies_blocks(const contactlab_rigid *bodies, int contacts, const contactlab_touch *touches,
                                           int most, int *row, int *column, double *block)
{
  int i, j, k, l, b, count = 0;
  row[0] = 0;
  for (i = 0; i < contacts; row[++i] = count)
    for (j = 0; j < contacts; ++j) {
      const int shared[2] = {touches[i].first, touches[i].second};
      double each[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
      int found = i == j;
      for (b = 0; b < 2; ++b) {
        contactlab_rigid here, there;
        const int side = contactlab_bodies_side(bodies, shared[b], touches + i, &here);
        const int sides = side * contactlab_bodies_side(bodies, shared[b], touches + j, &there);
        if (!sides) continue;
        found = 1;
        for (l = 0; l < 3; ++l) {
          double v[3] = {0, 0, 0}, w[3] = {0, 0, 0}, rim[3];
          contactlab_bodies_push(&there, touches[j].axes + 3 * l, 1, v, w);
          contactlab_bodies_cross(w, here.arm, rim);
          for (k = 0; k < 3; ++k) v[k] += rim[k];
          for (k = 0; k < 3; ++k) each[3 * k + l] += sides * contactlab_bodies_dot(touches[i].axes + 3 * k, v);
        }
      }
      if (!found) continue;
      if (count == most) return -1;
      column[count] = j;
      for (k = 0; k < 9; ++k) block[9 * count + k] = each[k];
      ++count;
    }
  return count;
}

/* Rate of approach and slip along t1 and t2 at a contact; vectors of bodies are rows of 3. */
static inline void contactlab_bodies_rates(const contactlab_touch *touch, const double *velocities, const double *spins,
                                           double *rates)
{
  double v[3] = {0, 0, 0}, rim[3];
  int k, b;
  for (b = 0; b < 2; ++b) {
    const int place = b ? touch->second : touch->first;
    if (place < 0) continue;
    contactlab_bodies_cross(spins + 3 * place, b ? touch->other_arm : touch->arm, rim);
    for (k = 0; k < 3; ++k) v[k] += (b ? -1 : 1) * (velocities[3 * place + k] + rim[k]);
  }
  for (k = 0; k < 3; ++k) rates[k] = contactlab_bodies_dot(touch->axes + 3 * k, v);
}

/* Adds to velocities and spins of bodies the changes by an impulse at a contact, P and F along t1 and t2. */
static inline void contactlab_bodies_part(const contactlab_rigid *bodies, const contactlab_touch *touch,
                                          const double *impulse, double *velocities, double *spins)
{
  double push[3];
  int k, b;
  for (b = 0; b < 2; ++b) {
    const int place = b ? touch->second : touch->first;
    contactlab_rigid at;
    const int side = contactlab_bodies_side(bodies, place, touch, &at);
    if (!side) continue;
    for (k = 0; k < 3; ++k)
      push[k] = -side * (impulse[0] * touch->axes[k] + impulse[1] * touch->axes[3 + k] + impulse[2] * touch->axes[6 + k]);
    contactlab_bodies_push(&at, push, 1, velocities + 3 * place, spins + 3 * place);
  }
}

#endif
