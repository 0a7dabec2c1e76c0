/* Friction of two spheres with partial slip, elastic or with loss: springs on a doubling grid.
 *
 * Mindlin's partial slip along any path of load and displacement, with N springs in 2 + 3 N numbers a
 * contact, from nothing but the present contact. No path gains energy. Theory, accuracy and measurements:
 * section 13 of `contactlab guide theory`.
 *
 *     double state[CONTACTLAB_SPRINGS_STATE(8)] = {0};             // no contact: all zero
 *     work = contactlab_springs_step(state, 8, moved, normal, radius, limit, unit, modulus, force);
 *
 * Where the normal force is damped, contactlab_springs_damped_step gives shear its share of the loss.
 *
 * C99 and C++, no allocation, no global. Define CONTACTLAB_REAL as float before the include for single
 * precision. Do not compile with -ffast-math: NaN would not be seen.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */
#ifndef CONTACTLAB_SPRINGS_H
#define CONTACTLAB_SPRINGS_H

#include <math.h>

#ifndef CONTACTLAB_REAL
#define CONTACTLAB_REAL double
#endif

/* Length of the state of a contact with n springs: A and b in m, then w of each spring, three numbers
 * in m. Where the two bodies change places, A and b keep their signs and every w changes its own. */
#define CONTACTLAB_SPRINGS_STATE(n) (2 + 3 * (n))

/* Contacts whose radius is below this times the unit just touch: no friction. */
#define CONTACTLAB_SPRINGS_TOUCH ((CONTACTLAB_REAL) 1e-30)

/* Returns how many of n springs, at 1/2, 3/2, ... cells, are within u cells of the axis. */
static inline int contactlab_springs_within(CONTACTLAB_REAL u, int n)
{
  return u < n ? (int) (u + (CONTACTLAB_REAL) 0.5) : n;
}

/* Widens each of n cells by a quarter: a new one has the mean w of what it covers, zero beyond the old grid.
 * Returns the energy lost over 2 G*, in m^3. */
static inline CONTACTLAB_REAL contactlab_springs_widen(CONTACTLAB_REAL *state, int n)
{
  CONTACTLAB_REAL *w = state + 2, sum = 0;
  int j, k;
  for (j = 0; j < n; ++j) { /* five cells become four, of 4/5 and 1/5, 3/5 and 2/5, ... of two neighbours */
    const CONTACTLAB_REAL share = (CONTACTLAB_REAL) 0.2 * (CONTACTLAB_REAL) (4 - j % 4);
    const int first = j + j / 4;
    for (k = 0; k < 3; ++k) {
      const CONTACTLAB_REAL inner = first < n ? w[3 * first + k] : 0, outer = first + 1 < n ? w[3 * first + 3 + k] : 0;
      w[3 * j + k] = share * inner + (1 - share) * outer;
      sum += share * (1 - share) * (inner - outer) * (inner - outer);
    }
  }
  state[0] *= (CONTACTLAB_REAL) 1.25;
  return sum * state[0] / (2 * n);
}

/* Fits the grid to the contact radius b, so that A/4 < b <= A; with loss it grows by quarters, else it doubles.
 * Returns the energy lost over 2 G*, in m^3: merged springs lose some, springs beyond a halved grid all of theirs. */
static inline CONTACTLAB_REAL contactlab_springs_fit(CONTACTLAB_REAL *state, int n, CONTACTLAB_REAL b,
                                                     CONTACTLAB_REAL unit, int lossy)
{
  CONTACTLAB_REAL *w = state + 2, lost = 0, sum;
  int i, exponent;
  if (!(state[0] > 0)) {
    const double fraction = frexp((double) (b / unit), &exponent);
    state[0] = unit * (CONTACTLAB_REAL) ldexp(1.0, fraction == 0.5 ? exponent - 1 : exponent);
  }
  while (lossy && b > state[0]) lost += contactlab_springs_widen(state, n);
  for (; b > state[0]; state[0] *= 2) { /* neighbours merge, the outer half starts from zero */
    for (sum = 0, i = 0; i < 3 * (n / 2); ++i) {
      const CONTACTLAB_REAL inner = w[i / 3 * 6 + i % 3], outer = w[i / 3 * 6 + 3 + i % 3];
      sum += (inner - outer) * (inner - outer);
      w[i] = (inner + outer) / 2;
    }
    for (; i < 3 * n; ++i) w[i] = 0;
    lost += sum * state[0] / (4 * n);
  }
  for (; b <= state[0] / 4; state[0] /= 2) { /* cells split into equal halves */
    for (sum = 0, i = 3 * (n / 2); i < 3 * n; ++i) sum += w[i] * w[i];
    lost += sum * state[0] / (2 * n);
    for (i = 3 * n - 1; i >= 0; --i) w[i] = w[i / 6 * 3 + i % 3];
  }
  return lost;
}

/* Sets what is left of a deflection after x relaxation times, e^-x, and 1 - (1 - e^-x)/x. Returns 1 - e^-x. */
static inline CONTACTLAB_REAL contactlab_springs_relaxed(CONTACTLAB_REAL x, CONTACTLAB_REAL *left, CONTACTLAB_REAL *ramp)
{
  if (x < (CONTACTLAB_REAL) 0.03) { /* series: the differences would lose all digits */
    *ramp = x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6 * (1 - x / 7)))));
    *left = 1 - x + x * *ramp;
    return x - x * *ramp;
  }
  *left = (CONTACTLAB_REAL) exp((double) -x);
  *ramp = 1 - (1 - *left) / x;
  return 1 - *left;
}

/* Cuts the deflection w of a spring that slips. Its force is at most its limit, so that w is within a length
 * `reach` of what is left of the one held; where w grows, within `least`, or energy could be gained. */
static inline void contactlab_springs_bounded(CONTACTLAB_REAL *w, const CONTACTLAB_REAL *held, CONTACTLAB_REAL left,
                                              CONTACTLAB_REAL reach, CONTACTLAB_REAL least)
{
  CONTACTLAB_REAL move[3], square = 0, had = 0, has = 0, kept = 0, small;
  int k;
  for (k = 0; k < 3; ++k) {
    move[k] = w[k] - left * held[k];
    square += move[k] * move[k];
  }
  if (!(square <= reach * reach)) {
    const CONTACTLAB_REAL share = reach / (CONTACTLAB_REAL) sqrt((double) square);
    for (k = 0; k < 3; ++k) w[k] = left * held[k] + share * move[k];
  }
  if (!(least < reach && square > least * least)) return;
  small = least / (CONTACTLAB_REAL) sqrt((double) square);
  for (k = 0; k < 3; ++k) {
    const CONTACTLAB_REAL x = left * held[k] + small * move[k];
    had += held[k] * held[k];
    has += w[k] * w[k];
    kept += x * x;
  }
  if (had < kept) had = kept;
  if (has > had) {
    const CONTACTLAB_REAL share = (CONTACTLAB_REAL) sqrt((double) (had / has));
    for (k = 0; k < 3; ++k) w[k] *= share;
  }
}

/* Takes one step of a contact whose normal force is damped. Returns the energy lost in shear in J.
 *
 * state    numbers of the contact, CONTACTLAB_SPRINGS_STATE(n) of them; changed
 * n        springs, even
 * moved    displacement of the first body relative to the second in this step, at the contact, in m
 * normal   unit normal of the contact at the end of the step; either sense
 * radius   contact radius sqrt(R overlap) at the end of the step, in m; 0 out of contact
 * limit    mu times the normal force at the end of the step, in N, at least 0
 * unit     any fixed length of the pair, in m, such as its radius: A begins as a power of two times it
 * modulus  2 G*, 1/G* = sum (2 - nu)/(4 G), in Pa; 8 G* with the G* of discrete-element codes
 * force    friction on the first body, in N; the second has the opposite; set
 * elastic  mu times the elastic part of the normal force, Hertz's, in N, at least 0
 * damping  of the whole contact against slip while it sticks, in N s/m, at least 0: shear loss times
 *          G* over E* times the damping of the normal force; 0: elastic shear, as by contactlab_springs_step
 * velocity slip velocity at the end of the step, as well as it is known, in m/s; else that of moved
 * time     length of the step in s
 *
 * A number that is not finite, a negative limit, elastic or damping, a unit, modulus or time that is not
 * positive, or an odd n make force and work NaN, until the contact ends. */
static inline CONTACTLAB_REAL contactlab_springs_damped_step(CONTACTLAB_REAL *state, int n,
    const CONTACTLAB_REAL *moved, const CONTACTLAB_REAL *normal, CONTACTLAB_REAL radius, CONTACTLAB_REAL limit,
    CONTACTLAB_REAL unit, CONTACTLAB_REAL modulus, CONTACTLAB_REAL *force, CONTACTLAB_REAL elastic,
    CONTACTLAB_REAL damping, const CONTACTLAB_REAL *velocity, CONTACTLAB_REAL time)
{
  CONTACTLAB_REAL *w = state + 2, work = 0, lost = 0, most = 0, stored = 0, leans = 0, turned = 1;
  CONTACTLAB_REAL cell, u, v, growth, along, lag = 0, jump = 0;
  CONTACTLAB_REAL d[3], held[3], f[3], pull[3] = {0, 0, 0}, total[3] = {0, 0, 0};
  CONTACTLAB_REAL gone = 0, left = 0, ramp = 0;
  int i, k, touching, touched;
  const CONTACTLAB_REAL size = state[0];
  const CONTACTLAB_REAL all = moved[0] + moved[1] + moved[2] + normal[0] + normal[1] + normal[2] + radius + limit
      + modulus + unit + (unit > 0 ? radius / unit : 0) + elastic + damping + velocity[0] + velocity[1] + velocity[2] + time;
  if (n < 2 || n % 2 || !(all - all == 0 && unit > 0 && modulus > 0 && limit >= 0 && elastic >= 0 && damping >= 0
                          && time > 0)) {
    for (i = 0; i < 3 * n; ++i) w[i] = NAN;
    force[0] = force[1] = force[2] = NAN;
    state[0] = state[1] = 1; /* a contact, whose springs are NaN */
    return NAN;
  }
  if (damping > 0 && radius > 0) {
    lag = damping / (modulus * radius);
    /* Where damping pulls, the contact shrinks before the overlap does. */
    if (limit < elastic) radius *= (CONTACTLAB_REAL) cbrt((double) (limit / elastic));
  }
  if (radius > unit * CONTACTLAB_SPRINGS_TOUCH) lost = contactlab_springs_fit(state, n, radius, unit, lag > 0);
  else radius = 0;
  force[0] = force[1] = force[2] = 0;
  if (!(state[0] > 0)) return 0;

  cell = state[0] / n;
  u = radius * (n / state[0]); /* b after and before the step, in cells */
  v = state[1] * (n / state[0]);
  growth = u - v;
  touching = contactlab_springs_within(u, n);
  touched = state[0] == size ? contactlab_springs_within(v, n) : n; /* springs that may hold something */
  if (lag > 0) {
    gone = contactlab_springs_relaxed(time / lag, &left, &ramp);
    if (limit > elastic) { /* damping that presses adds the same limit to every spring */
      jump = limit < (CONTACTLAB_REAL) 1e9 * elastic ? limit / elastic - 1 : (CONTACTLAB_REAL) 1e9;
      jump *= u * u * 2 / 3;
    }
  }
  if (touching > 0) { /* limits in proportion to b^2 - r^2 + jump, together the limit of the contact */
    const CONTACTLAB_REAL m = (CONTACTLAB_REAL) touching;
    most = limit / (modulus * cell * (m * u * u - m * (4 * m * m - 1) / 12 + m * jump));
  }
  along = moved[0] * normal[0] + moved[1] * normal[1] + moved[2] * normal[2];
  for (k = 0; k < 3; ++k) d[k] = moved[k] - along * normal[k];
  if (lag > 0) {
    along = velocity[0] * normal[0] + velocity[1] * normal[1] + velocity[2] * normal[2];
    for (k = 0; k < 3; ++k) pull[k] = lag * (velocity[k] - along * normal[k]);
  }
  for (i = 0; i < touched; ++i) {
    const CONTACTLAB_REAL *x = w + 3 * i, out = x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2];
    stored += x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    leans += out * out;
  }
  /* Springs are projected on the plane of the contact; a turn of the plane keeps their energy. */
  if (leans < stored) turned = (CONTACTLAB_REAL) sqrt((double) (stored / (stored - leans)));

  for (i = 0; i < touching || i < touched; ++i, w += 3) {
    const CONTACTLAB_REAL r = i + (CONTACTLAB_REAL) 0.5;
    const CONTACTLAB_REAL l = i < touching ? most * (u * u - r * r + jump) : 0;
    /* A spring that the contact reaches in the step moves from then on only. */
    const CONTACTLAB_REAL part = growth > 0 && r > v ? (u - r) / growth : 1;
    CONTACTLAB_REAL square = 0;
    along = w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
    for (k = 0; k < 3; ++k) {
      held[k] = turned * (w[k] - along * normal[k]);
      w[k] = held[k] + part * d[k];
      square += w[k] * w[k];
    }
    if (lag > 0 && i < touching) {
      const CONTACTLAB_REAL before = most * ((r < v ? v * v - r * r : 0) + jump);
      CONTACTLAB_REAL part_left = left, part_ramp = ramp, part_gone = gone;
      if (part < 1) part_gone = contactlab_springs_relaxed(part * time / lag, &part_left, &part_ramp);
      contactlab_springs_bounded(w, held, part_left, before * part_gone + (l - before) * part_ramp, l * part_gone);
      for (square = 0, k = 0; k < 3; ++k) {
        const CONTACTLAB_REAL grown = w[k] - held[k];
        work += 2 * lag / time * grown * d[k] + (held[k] + w[k]) * (part * d[k] - grown);
        f[k] = w[k] + pull[k];
        square += f[k] * f[k];
      }
      if (!(square <= l * l)) {
        const CONTACTLAB_REAL share = l / (CONTACTLAB_REAL) sqrt((double) square);
        for (k = 0; k < 3; ++k) f[k] *= share;
      }
      for (k = 0; k < 3; ++k) total[k] += f[k];
      continue;
    }
    if (!(square <= l * l)) { /* cut to its limit; the work of a spring: its mean w times its slip */
      const CONTACTLAB_REAL share = l / (CONTACTLAB_REAL) sqrt((double) square);
      for (k = 0; k < 3; ++k) {
        const CONTACTLAB_REAL kept = share * w[k];
        work += (w[k] - kept) * (held[k] + kept);
        w[k] = kept;
      }
    }
    for (k = 0; k < 3; ++k) total[k] += w[k];
  }
  for (k = 0; k < 3; ++k) force[k] = -modulus * cell * total[k];
  state[1] = radius;
  if (radius == 0) { /* nothing is left of the contact, NaN neither */
    for (i = 0; i < 2 + 3 * n; ++i) state[i] = 0;
    force[0] = force[1] = force[2] = 0;
  }
  work *= modulus * cell / 2;
  if (work < 0) work = 0;
  return work + modulus * lost;
}

/* Takes one step of a contact. Returns the friction work in J.
 *
 * state    numbers of the contact, CONTACTLAB_SPRINGS_STATE(n) of them; changed
 * n        springs, even
 * moved    displacement of the first body relative to the second in this step, at the contact, in m
 * normal   unit normal of the contact at the end of the step; either sense
 * radius   contact radius b at the end of the step, in m; 0 out of contact
 * limit    mu times the normal force at the end of the step, in N, at least 0
 * unit     any fixed length of the pair, in m, such as its radius: A is a power of two times it
 * modulus  2 G*, 1/G* = sum (2 - nu)/(4 G), in Pa; 8 G* with the G* of discrete-element codes
 * force    friction on the first body, in N; the second has the opposite; set
 *
 * A number that is not finite, a negative limit, a unit or modulus that is not positive, or an odd n make
 * force and work NaN, until the contact ends. */
static inline CONTACTLAB_REAL contactlab_springs_step(CONTACTLAB_REAL *state, int n, const CONTACTLAB_REAL *moved,
    const CONTACTLAB_REAL *normal, CONTACTLAB_REAL radius, CONTACTLAB_REAL limit, CONTACTLAB_REAL unit,
    CONTACTLAB_REAL modulus, CONTACTLAB_REAL *force)
{
  return contactlab_springs_damped_step(state, n, moved, normal, radius, limit, unit, modulus, force, limit, 0, moved, 1);
}

#endif
