/* The elastic impact of two bodies of any shape whose slip keeps its line: exact, by fronts of slip.
 *
 * Hertz's contact with Coulomb friction and partial slip, solved from event to event by Taylor series: psi2 and the
 * rebound to 1e-12. Friction may change the approach (lam, eta), several compressions included; spheres have
 * lam = eta = 0. Theory: sections 5 and 14 of `contactlab guide theory`; `fronts/path.py` is the same in Python.
 *
 *     contactlab_impact out;
 *     int status = contactlab_impact_follow(0.8, 1.3, 0.19, 1.7, CONTACTLAB_IMPACT_EXACT, 20000, &out);
 *
 * contactlab_impact_watched is the same and shows each step, for a history: contactlab_impact_at.
 *
 * The variable is x with dT = 2 u dx, T the time times v1 over the largest approach of Hertz's impact. u is the contact
 * radius and V the rate of approach, both over Hertz's; s the sign in which the edge slips or would, k = V - s psi,
 * J = (2/3)(P - s F), and c the radius within which all sticks:
 *
 *     u' = V    V' = -2.5 u [(1 + s lam) u^3 - 1.5 s lam J]    J' = 2 u c k
 *     k' = 2.5 u [(2 chi + s eta - 1 - s lam) u^3 - (3 chi - 1.5 s lam) J]
 *
 * C99 and C++, no allocation, no global.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */
#ifndef CONTACTLAB_IMPACT_H
#define CONTACTLAB_IMPACT_H

#include <math.h>
#include <string.h>

enum {
  CONTACTLAB_IMPACT_DONE = 0,
  CONTACTLAB_IMPACT_UNSETTLED = 1, /* it neither ends nor settles in so many steps */
  CONTACTLAB_IMPACT_OUTGROWN = 2,  /* velocities, as of a jam, outgrow the numbers */
  CONTACTLAB_IMPACT_MEMORY = 3,    /* it slips back and forth more often than its memory holds */
  CONTACTLAB_IMPACT_RANGE = 4      /* a number is none, or out of range: no bodies have it */
};

/* 1 + s lam from which the time of gross slip is Hertz's; below it the difference of two such times would cancel. */
#define CONTACTLAB_IMPACT_SHALLOW 0.01

/* Error of a step for an answer to 1e-12. */
#define CONTACTLAB_IMPACT_EXACT 5e-13

/* What an impact leaves: V and psi2 - psi1; friction work over 2.5 mu^2 v1^2/(2 kappa W_nn); T; the largest u; how
 * often the approach grew; and steps. */
typedef struct { double rate, change, work, time, radius; int compressions, steps; } contactlab_impact;

/* Last coefficient of a series, the number of its coefficients, and pieces of memory: an impact of many steps in which
 * bodies that hardly move jam leaves more, at most one a step. */
enum { CONTACTLAB_IMPACT_ORDER = 16, CONTACTLAB_IMPACT_TERMS = 17, CONTACTLAB_IMPACT_PIECES = 256 };

typedef double contactlab_impact_series[CONTACTLAB_IMPACT_TERMS];

/* The numbers in the equations, for slip of one sign. */
typedef struct { double press, relief, drive, spring; } contactlab_impact_laws;

/* A piece of memory: drawn while all stuck, with u, V, k, J at its outer end and its length in x; or locked out of slip
 * of one sign, between two radii. The outermost piece is the last. */
typedef struct { int drawn, sign; double radius, rate, margin, lack, length, inner; } contactlab_impact_piece;

/* A step of an impact that is watched: the phase, how many phases came before, and the sign s; psi - psi1 and the work
 * where the step begins; and the series of u, V, k, J, c and T in a variable from 0 to `length`. */
typedef struct {
  int phase, part, sign;
  double change, work, length;
  const double *radius, *rate, *margin, *lack, *stick, *time;
} contactlab_impact_step;

/* An instant: T, u, V and c; psi, and F over the largest mu P of Hertz's impact. */
typedef struct { double time, radius, rate, stick, psi, force; } contactlab_impact_instant;

/* What is called with each step, whose series are gone after the call, and a pointer of the caller's. */
typedef void contactlab_impact_watch(void *context, const contactlab_impact_step *step);

typedef struct {
  double chi, lam, eta, tolerance;
  int most, sign, pieces, part;
  contactlab_impact_watch *watch;
  void *context;
  double radius, rate, margin, lack; /* u, V, k, J */
  contactlab_impact_laws laws;
  contactlab_impact out;
  contactlab_impact_piece *memory;
  int room;
} contactlab_impact_course;

/* Phases, by what the contact does: all sticks; the edge slips into a piece of either kind; all slips. */
enum { CONTACTLAB_IMPACT_STICK, CONTACTLAB_IMPACT_DRAWN, CONTACTLAB_IMPACT_LOCKED, CONTACTLAB_IMPACT_GROSS };

/* ------------------------------------------------------------------------------------------------------- series */

/* Coefficient n of the product a b. */
static inline double contactlab_impact_product(const double *a, const double *b, int n)
{
  double even = 0, odd = 0;
  int i = 0;
  for (; i + 1 <= n; i += 2) {
    even += a[i] * b[n - i];
    odd += a[i + 1] * b[n - i - 1];
  }
  if (i <= n) even += a[i] * b[n - i];
  return even + odd;
}

/* Coefficient n of the square of a. */
static inline double contactlab_impact_square(const double *a, int n)
{
  const int half = (n + 1) / 2;
  double total = 0;
  int i;
  for (i = 0; i < half; ++i) total += a[i] * a[n - i];
  return n % 2 ? 2 * total : 2 * total + a[n / 2] * a[n / 2];
}

/* Coefficient n of the product a b, without a_n b_0. */
static inline double contactlab_impact_lower(const double *a, const double *b, int n)
{
  double total = 0;
  int i;
  for (i = 0; i < n; ++i) total += a[i] * b[n - i];
  return total;
}

/* Value at t of a series whose last coefficient is `last`. */
static inline double contactlab_impact_value(const double *a, int last, double t)
{
  double total = 0;
  int n;
  for (n = last; n >= 0; --n) total = total * t + a[n];
  return total;
}

/* First and second derivative at t. */
static inline void contactlab_impact_slopes(const double *a, int last, double t, double *slope, double *bend)
{
  int n;
  *slope = *bend = 0;
  for (n = last; n > 0; --n) {
    *bend = *bend * t + *slope;
    *slope = *slope * t + n * a[n];
  }
}

/* V' and k' of a contact, order by order, from its u and J. */
typedef struct { contactlab_impact_series square, fourth, rate, margin; } contactlab_impact_forces;

static inline void contactlab_impact_force(contactlab_impact_forces *f, const contactlab_impact_laws *laws,
                                           const double *u, const double *lack, int n)
{
  double fourth, held;
  f->square[n] = contactlab_impact_square(u, n);
  f->fourth[n] = fourth = contactlab_impact_square(f->square, n);
  held = contactlab_impact_product(u, lack, n);
  f->rate[n] = -2.5 * (laws->press * fourth - laws->relief * held);
  f->margin[n] = 2.5 * (laws->drive * fourth - laws->spring * held);
}

/* How many series a phase has, T the last: u V k J x T; u V k J c V1 k1 x1 T; u V k J c T; u V k J T. */
static inline int contactlab_impact_rows(int phase)
{
  return phase == CONTACTLAB_IMPACT_DRAWN ? 9 : phase == CONTACTLAB_IMPACT_GROSS ? 5 : 6;
}

static inline void contactlab_impact_along_stick(const contactlab_impact_laws *laws, contactlab_impact_series *rows)
{
  double *U = rows[0], *V = rows[1], *K = rows[2], *J = rows[3], *T = rows[5];
  contactlab_impact_forces f;
  int n;
  rows[4][1] = 1;
  for (n = 0; n < CONTACTLAB_IMPACT_ORDER; ++n) {
    const double share = 1.0 / (n + 1);
    contactlab_impact_force(&f, laws, U, J, n);
    J[n + 1] = 2 * share * contactlab_impact_product(f.square, K, n);
    T[n + 1] = 2 * share * U[n];
    U[n + 1] = share * V[n];
    V[n + 1] = share * f.rate[n];
    K[n + 1] = share * f.margin[n];
  }
}

static inline void contactlab_impact_along_gross(const contactlab_impact_laws *laws, contactlab_impact_series *rows)
{
  double *U = rows[0], *V = rows[1], *K = rows[2], *J = rows[3], *T = rows[4];
  contactlab_impact_forces f;
  int n;
  for (n = 0; n < CONTACTLAB_IMPACT_ORDER; ++n) {
    const double share = 1.0 / (n + 1);
    contactlab_impact_force(&f, laws, U, J, n);
    T[n + 1] = 2 * share * U[n];
    U[n + 1] = share * V[n];
    V[n + 1] = share * f.rate[n];
    K[n + 1] = share * f.margin[n];
  }
}

/* A zone slips that was locked out of the other sign: m + 2c^2 and J - (4/3) c^3 are constant, and 2 c dc = u k dx. The
 * variable is x or, for `inmost` fronts, one in which dx = 2 c and dc = u k: as c^2 goes through zero, c ends. */
static inline void contactlab_impact_along_locked(const contactlab_impact_laws *laws, contactlab_impact_series *rows,
                                                  int inmost)
{
  double *U = rows[0], *V = rows[1], *K = rows[2], *J = rows[3], *C = rows[4], *T = rows[5];
  contactlab_impact_series gone, run;
  contactlab_impact_forces f;
  int n;
  for (n = 0; n < CONTACTLAB_IMPACT_ORDER; ++n) {
    const double share = 1.0 / (n + 1), twice = 2 * share;
    contactlab_impact_force(&f, laws, U, J, n);
    gone[n] = contactlab_impact_product(U, K, n);
    if (inmost) {
      U[n + 1] = twice * contactlab_impact_product(V, C, n);
      V[n + 1] = twice * contactlab_impact_product(f.rate, C, n);
      K[n + 1] = twice * contactlab_impact_product(f.margin, C, n);
      T[n + 1] = 2 * twice * contactlab_impact_product(U, C, n);
      C[n + 1] = share * gone[n];
      run[n] = 2 * contactlab_impact_product(C, gone, n);
      J[n + 1] = twice * contactlab_impact_product(C, run, n);
    } else {
      U[n + 1] = share * V[n];
      V[n + 1] = share * f.rate[n];
      K[n + 1] = share * f.margin[n];
      T[n + 1] = twice * U[n];
      run[n] = (0.5 * gone[n] - contactlab_impact_lower(run, C, n)) / C[0];
      C[n + 1] = share * run[n];
      J[n + 1] = twice * contactlab_impact_product(C, gone, n);
    }
  }
}

/* The edge slips into memory that was drawn while all stuck, which obeys the equations of sticking and is followed
 * backwards beside the motion: c, V1, k1, and what is left of it in x1. As m is constant along both,
 * dx : dx1 = c k1 : u k. The variable is x, or x1 where `back`; where slip begins (`fresh`) both k are zero. */
static inline void contactlab_impact_along_drawn(const contactlab_impact_laws *laws, contactlab_impact_series *rows,
                                                 int fresh, int back)
{
  double *U = rows[0], *V = rows[1], *K = rows[2], *J = rows[3];
  double *C = rows[4], *V1 = rows[5], *K1 = rows[6], *X1 = rows[7], *T = rows[8];
  double *u = back ? C : U, *v = back ? V1 : V, *k = back ? K1 : K;
  double *u1 = back ? U : C, *v1 = back ? V : V1, *k1 = back ? K : K1;
  const double way = back ? -1 : 1;
  contactlab_impact_series gone = {0}, other = {0}, run = {0}, slope = {0};
  contactlab_impact_forces lead, trail;
  int n;
  for (n = 0; n < CONTACTLAB_IMPACT_ORDER; ++n) {
    const double share = 1.0 / (n + 1), ahead = way * share;
    contactlab_impact_force(&lead, laws, u, J, n);
    contactlab_impact_force(&trail, laws, u1, J, n);
    u[n + 1] = ahead * v[n];
    v[n + 1] = ahead * lead.rate[n];
    k[n + 1] = ahead * lead.margin[n];
    if (!fresh) {
      gone[n] = way * contactlab_impact_product(u, k, n);
      other[n] = contactlab_impact_product(u1, k1, n);
      run[n] = (gone[n] - contactlab_impact_lower(run, other, n)) / other[0];
      k1[n + 1] = share * contactlab_impact_product(trail.margin, run, n);
    } else { /* (c K1) dx1/dx = u K with K = k/x; the coefficient sought stands in K1 too */
      if (n == 0) {
        slope[0] = -trail.margin[0];
        other[0] = -C[0] * trail.margin[0];
        run[0] = -1;
      } else {
        const double known = contactlab_impact_lower(U, K, n + 1), own = share * trail.margin[0];
        const double part = share * contactlab_impact_lower(run, trail.margin, n);
        const double rest = C[0] * part + contactlab_impact_lower(slope, C, n);
        run[n] = (known - contactlab_impact_lower(other, run, n) + rest) / (other[0] - C[0] * own);
        slope[n] = part + own * run[n];
        other[n] = rest + C[0] * own * run[n];
      }
      k1[n + 1] = slope[n];
      gone[n] = contactlab_impact_product(u, k, n);
    }
    u1[n + 1] = share * contactlab_impact_product(v1, run, n);
    v1[n + 1] = share * contactlab_impact_product(trail.rate, run, n);
    J[n + 1] = 2 * share * contactlab_impact_product(C, gone, n);
    T[n + 1] = 2 * share * (back ? contactlab_impact_product(U, run, n) : U[n]);
    X1[n + 1] = back ? (n ? 0 : -1) : share * run[n];
  }
}

/* -------------------------------------------------------------------------------------------------------- events */

/* The root between a and b by the Illinois method. */
static inline double contactlab_impact_root(const double *series, int last, double a, double b, double at_a, double at_b)
{
  double t = a;
  int i, side = 0;
  if (at_a <= 0) return a;
  for (i = 0; i < 80; ++i) {
    double here;
    t = (at_a * b - at_b * a) / (at_a - at_b);
    here = contactlab_impact_value(series, last, t);
    if (fabs(here) < 1e-17 || b - a < 1e-16) break;
    if (here > 0) {
      a = t;
      at_a = here;
      if (side > 0) at_b *= 0.5;
      side = 1;
    } else {
      b = t;
      at_b = here;
      if (side < 0) at_a *= 0.5;
      side = -1;
    }
  }
  return t;
}

/* Where a dip between two places is lowest, by Newton's method kept within them. */
static inline double contactlab_impact_lowest(const double *series, int last, double low, double high)
{
  double t = 0.5 * (low + high);
  int i;
  for (i = 0; i < 8; ++i) {
    double slope, bend, next;
    contactlab_impact_slopes(series, last, t, &slope, &bend);
    if (slope < 0) low = t;
    else high = t;
    next = bend > 0 ? t - slope / bend : low;
    t = low < next && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

/* The first place up to `end` at which a series is negative, seen at eight places; -1 if there is none. */
static inline double contactlab_impact_fall(const double *series, int last, double end)
{
  const double step = end / 8;
  double most = 0, before = series[0];
  int n, look, falls = series[1] < 0;
  for (n = last; n >= 0; --n) most = most * end + fabs(series[n]);
  if (2 * series[0] > most) return -1; /* the first term is more than all others together */
  for (look = 1; look <= 8; ++look) {
    const double t = step * look, here = contactlab_impact_value(series, last, t);
    const int fell = falls;
    if (here < 0) return contactlab_impact_root(series, last, t - step, t, before, here);
    if (look < 8) {
      falls = here < before;
    } else {
      double slope, bend;
      contactlab_impact_slopes(series, last, t, &slope, &bend);
      falls = slope < 0;
    }
    if (!falls && (fell || (look == 8 && here < before))) { /* a dip, perhaps below zero, here or just before */
      const double start = fmax(t - 2 * step, 0), lowest = contactlab_impact_lowest(series, last, start, t);
      const double least = contactlab_impact_value(series, last, lowest);
      if (least < 0)
        return contactlab_impact_root(series, last, start, lowest, contactlab_impact_value(series, last, start), least);
    }
    before = here;
  }
  return -1;
}

/* Work in a step of length t: Gauss's rule for -u k x' (u - c)^2 (2u + c), where u k x' = c k1 x1' in drawn memory. */
static inline double contactlab_impact_work(int phase, int form, contactlab_impact_series *rows, double t)
{
  static const double node[4] = {0.18343464249564978, 0.525532409916329, 0.7966664774136267, 0.9602898564975362};
  static const double weight[4] = {0.36268378337836199, 0.31370664587788727, 0.22238103445337448, 0.10122853629037626};
  const int last = CONTACTLAB_IMPACT_ORDER;
  double total = 0;
  int i;
  for (i = 0; i < 8; ++i) {
    const double x = t * 0.5 * (i < 4 ? 1 - node[i] : 1 + node[i - 4]);
    const double u = contactlab_impact_value(rows[0], last, x), k = contactlab_impact_value(rows[2], last, x);
    const double c = contactlab_impact_value(rows[4], last, x);
    double power = -u * k;
    if (phase == CONTACTLAB_IMPACT_DRAWN && form == 1) power = c * contactlab_impact_value(rows[6], last, x);
    if (phase == CONTACTLAB_IMPACT_LOCKED && form == 1) power *= 2 * c;
    total += 0.5 * weight[i % 4] * power * (u - c) * (u - c) * (2 * u + c);
  }
  return t * total;
}

/* How far all series of a step hold but that of time; -1 if they are not finite. */
static inline double contactlab_impact_length(contactlab_impact_series *rows, int count, double tolerance)
{
  const int order = CONTACTLAB_IMPACT_ORDER;
  double last = 0, before = 0, total = 0, length = 1;
  int i;
  for (i = 0; i < count - 1; ++i) {
    const double allowed = fmax(tolerance, 1e-14 * fabs(rows[i][0]));
    const double size = fabs(rows[i][order]) / allowed, larger = fabs(rows[i][order - 1]) / allowed;
    if (size > last) last = size;
    if (larger > before) before = larger;
    total += size + larger;
  }
  if (!(total < INFINITY)) return -1;
  if (last > 0) length = fmin(length, pow(last, -1.0 / order));
  if (before > 0) length = fmin(length, pow(before, -1.0 / (order - 1)));
  return 0.9 * length;
}

/* The first series of a phase to fall below zero, its place in *t, which comes as the length of the step; -1 if none
 * does. At the border of two phases a series begins at zero: the fall of the series over the variable counts. */
static inline int contactlab_impact_event(int phase, int form, contactlab_impact_series *rows, double end, double *t)
{
  const int order = CONTACTLAB_IMPACT_ORDER;
  contactlab_impact_series falling[3];
  int begins[3] = {0, 0, 0}, count = 1, event = -1, i, n;
  for (n = 0; n <= order; ++n) {
    falling[0][n] = phase == CONTACTLAB_IMPACT_STICK ? rows[2][n] : -rows[2][n];
    if (phase == CONTACTLAB_IMPACT_STICK) falling[1][n] = rows[1][n] - (rows[2][n] - rows[1][n]);
    else if (phase != CONTACTLAB_IMPACT_GROSS) {
      falling[1][n] = phase == CONTACTLAB_IMPACT_DRAWN ? rows[7][n] : rows[4][n];
      falling[2][n] = rows[0][n] - rows[4][n];
    }
  }
  begins[0] = rows[2][0] == 0;
  if (phase != CONTACTLAB_IMPACT_GROSS) {
    count = 2;
  } else if (!form) { /* slip ends with the contact */
    memcpy(falling[0], rows[0], sizeof falling[0]);
    begins[0] = rows[0][0] == 0;
  }
  if (phase == CONTACTLAB_IMPACT_DRAWN || phase == CONTACTLAB_IMPACT_LOCKED) {
    if (phase == CONTACTLAB_IMPACT_LOCKED) falling[1][0] -= end;
    begins[2] = rows[0][0] == rows[4][0];
    falling[2][begins[2]] += 4e-15; /* an edge that is, or goes, less beyond the front does so by rounding */
    count = 3;
  }
  for (i = 0; i < count; ++i) {
    const double found = contactlab_impact_fall(falling[i] + begins[i], order - begins[i], *t);
    if (found >= 0) {
      *t = found;
      event = i;
    }
  }
  return event;
}

/* Shows a step, whose work is the sum so far. */
static inline void contactlab_impact_show(const contactlab_impact_course *I, int phase, contactlab_impact_series *rows,
                                          double work, double length)
{
  static const contactlab_impact_series zero = {0};
  const double psi = I->rate - I->margin; /* where the phase began */
  contactlab_impact_step step;
  step.phase = phase;
  step.part = I->part;
  step.sign = I->sign;
  step.change = I->out.change + I->sign * (rows[1][0] - rows[2][0] - psi);
  step.work = work;
  step.length = length;
  step.radius = rows[0];
  step.rate = rows[1];
  step.margin = rows[2];
  step.lack = rows[3];
  step.stick = phase == CONTACTLAB_IMPACT_STICK ? rows[0] : phase == CONTACTLAB_IMPACT_GROSS ? zero : rows[4];
  step.time = rows[contactlab_impact_rows(phase) - 1];
  I->watch(I->context, &step);
}

/* Follows a phase to its event: state in and out, T and work its last two numbers; `end` is where c ends it.
 * Returns the event, or minus a status. */
static inline int contactlab_impact_phase(contactlab_impact_course *I, int phase, int form, double end, double *state)
{
  const int count = contactlab_impact_rows(phase), order = CONTACTLAB_IMPACT_ORDER;
  contactlab_impact_series rows[9];
  int event = -1, i;
  while (event < 0) {
    double t, before = state[0], rate = state[1];
    if (I->out.steps >= I->most) return -CONTACTLAB_IMPACT_UNSETTLED;
    for (i = 0; i < count; ++i) {
      memset(rows[i], 0, sizeof rows[i]);
      rows[i][0] = state[i];
    }
    if (phase == CONTACTLAB_IMPACT_STICK) {
      contactlab_impact_along_stick(&I->laws, rows);
    } else if (phase == CONTACTLAB_IMPACT_GROSS) {
      contactlab_impact_along_gross(&I->laws, rows);
    } else if (phase == CONTACTLAB_IMPACT_DRAWN) {
      form = state[2] == 0 && state[6] == 0 ? 2 : fabs(state[0] * state[2]) > fabs(state[4] * state[6]);
      contactlab_impact_along_drawn(&I->laws, rows, form == 2, form == 1);
    } else {
      form = state[4] * state[4] < 0.1 * fabs(state[0] * state[2]);
      contactlab_impact_along_locked(&I->laws, rows, form);
    }
    t = contactlab_impact_length(rows, count, I->tolerance);
    if (t < 0) return -CONTACTLAB_IMPACT_OUTGROWN;
    event = contactlab_impact_event(phase, form, rows, end, &t);
    if (I->watch) contactlab_impact_show(I, phase, rows, state[count], t);
    if (phase == CONTACTLAB_IMPACT_DRAWN || phase == CONTACTLAB_IMPACT_LOCKED)
      state[count] += contactlab_impact_work(phase, form, rows, t);
    for (i = 0; i < count; ++i) state[i] = contactlab_impact_value(rows[i], order, t);
    I->out.radius = fmax(I->out.radius, fmax(before, state[0]));
    if (rate > 0 && state[1] <= 0) {
      const double top = contactlab_impact_fall(rows[1], order, t);
      I->out.radius = fmax(I->out.radius, contactlab_impact_value(rows[0], order, top < 0 ? t : top));
    }
    I->out.compressions += rate <= 0 && state[1] > 0;
    I->out.steps += 1;
  }
  ++I->part;
  return event;
}

/* -------------------------------------------------------------------------------------------------------- parts */

static inline contactlab_impact_laws contactlab_impact_laws_of(int sign, double chi, double lam, double eta)
{
  contactlab_impact_laws laws;
  laws.press = 1 + sign * lam;
  laws.relief = 1.5 * sign * lam;
  laws.drive = 2 * chi + sign * eta - laws.press;
  laws.spring = 3 * chi - laws.relief;
  return laws;
}

/* Looks from the other sign of slip. */
static inline void contactlab_impact_turn(contactlab_impact_course *I)
{
  I->sign = -I->sign;
  I->laws = contactlab_impact_laws_of(I->sign, I->chi, I->lam, I->eta);
  I->margin = 2 * I->rate - I->margin;
  I->lack = 4.0 / 3 * I->radius * I->radius * I->radius - I->lack;
}

/* Follows a phase from the state of the contact, with `own` numbers of the phase between J and T, and back. */
static inline int contactlab_impact_run(contactlab_impact_course *I, int phase, int form, double end, double *own)
{
  const int count = contactlab_impact_rows(phase);
  const double psi = I->rate - I->margin;
  double state[10] = {I->radius, I->rate, I->margin, I->lack};
  int event;
  memcpy(state + 4, own, (size_t)(count - 5) * sizeof *own);
  state[count - 1] = I->out.time;
  state[count] = I->out.work;
  event = contactlab_impact_phase(I, phase, form, end, state);
  if (event < 0) return event;
  I->radius = state[0];
  I->rate = state[1];
  I->margin = state[2];
  I->lack = state[3];
  I->out.change += I->sign * (I->rate - I->margin - psi);
  I->out.time = state[count - 1];
  I->out.work = state[count];
  memcpy(own, state + 4, (size_t)(count - 5) * sizeof *own);
  return event;
}

static inline int contactlab_impact_remember(contactlab_impact_course *I, contactlab_impact_piece piece)
{
  if (I->pieces == I->room) return CONTACTLAB_IMPACT_MEMORY;
  I->memory[I->pieces++] = piece;
  return CONTACTLAB_IMPACT_DONE;
}

/* Time T from u = 0 to u at the rate V in a contact without stick whose V^2 + press u^5 is `left`, as Hertz's:
 * Gauss's rule in the phase (theory section 3). */
static inline double contactlab_impact_hertz_time(double press, double left, double radius, double rate)
{
  static const double node[8] = {0.09501250983763744, 0.2816035507792589, 0.45801677765722739, 0.61787624440264375,
                                 0.75540440835500303, 0.86563120238783174, 0.94457502307323258, 0.98940093499164993};
  static const double weight[8] = {0.18945061045506850, 0.18260341504492359, 0.16915651939500254, 0.14959598881657673,
                                   0.12462897125553387, 0.09515851168249278, 0.06225352393864789, 0.02715245941175409};
  const double whole = 2.9432751843247043, top = pow(left / press, 0.2), speed = sqrt(left), u = radius / top;
  const double factor = sqrt((1 + u * (1 + u * (1 + u * (1 + u)))) / (1 + u));
  const double phase = atan2(u, rate / speed / factor), rising = fmin(phase, 3.141592653589793 - phase);
  double total = 0;
  int i;
  for (i = 0; i < 16; ++i) {
    const double s = sin(0.5 * rising * (i < 8 ? 1 - node[i] : 1 + node[i - 8]));
    total += weight[i % 8] * s / sqrt((1 + s * (1 + s * (1 + s * (1 + s)))) / (1 + s));
  }
  total *= rising; /* half the interval times 2 u/g */
  return top * top / speed * (phase <= 1.5707963267948966 ? total : whole - total);
}

enum { CONTACTLAB_IMPACT_STUCK, CONTACTLAB_IMPACT_SLIPS, CONTACTLAB_IMPACT_SLIDES, CONTACTLAB_IMPACT_ENDS };

/* All sticks; the edge begins to slip where k, or its like of the other sign, is zero. */
static inline int contactlab_impact_stuck(contactlab_impact_course *I, int *next)
{
  contactlab_impact_piece piece = {1, 0, 0, 0, 0, 0, 0, 0};
  double length = 0;
  int event = contactlab_impact_run(I, CONTACTLAB_IMPACT_STICK, 0, 0, &length);
  if (event < 0) return -event;
  if (fabs(I->rate) < 1e-14) { /* both are zero at maximum compression: the forces say which sign */
    const double cube = I->radius * I->radius * I->radius;
    I->rate = 0;
    event = (I->laws.drive + I->laws.press) * cube < (I->laws.spring + I->laws.relief) * I->lack;
  }
  if (event == 1) contactlab_impact_turn(I);
  I->margin = 0;
  piece.sign = I->sign;
  piece.radius = I->radius;
  piece.rate = I->rate;
  piece.lack = I->lack;
  piece.length = length;
  *next = CONTACTLAB_IMPACT_SLIPS;
  return contactlab_impact_remember(I, piece);
}

/* Slip has stopped: its zone locks. In unloading the edge slips on with the other sign. */
static inline int contactlab_impact_stopped(contactlab_impact_course *I, double front, int *next)
{
  contactlab_impact_piece piece = {0, 0, 0, 0, 0, 0, 0, 0};
  int status;
  I->margin = 0;
  piece.sign = I->sign;
  piece.radius = I->radius;
  piece.lack = I->lack;
  piece.inner = front;
  status = contactlab_impact_remember(I, piece);
  *next = I->rate > 1e-14 ? CONTACTLAB_IMPACT_STUCK : CONTACTLAB_IMPACT_SLIPS;
  if (*next == CONTACTLAB_IMPACT_SLIPS) {
    I->rate = fmin(I->rate, 0);
    contactlab_impact_turn(I);
  }
  return status;
}

/* The edge slips into the outermost piece, until slip stops (0), the piece is spent (1) or the edge meets the front. */
static inline int contactlab_impact_edge(contactlab_impact_course *I, int *next)
{
  contactlab_impact_piece *piece;
  double front;
  int event;
  while (I->pieces && !I->memory[I->pieces - 1].drawn && I->memory[I->pieces - 1].sign == I->sign)
    --I->pieces; /* one zone, which slips as a whole */
  *next = CONTACTLAB_IMPACT_SLIDES;
  if (!I->pieces) return CONTACTLAB_IMPACT_DONE;
  *next = CONTACTLAB_IMPACT_SLIPS;
  piece = &I->memory[I->pieces - 1];
  if (piece->drawn) {
    double own[4];
    if (piece->sign != I->sign) {
      piece->margin = 2 * piece->rate - piece->margin;
      piece->lack = 4.0 / 3 * piece->radius * piece->radius * piece->radius - piece->lack;
      piece->sign = I->sign;
    }
    I->lack = piece->lack;
    own[0] = piece->radius;
    own[1] = piece->rate;
    own[2] = piece->margin;
    own[3] = piece->length;
    event = contactlab_impact_run(I, CONTACTLAB_IMPACT_DRAWN, 0, 0, own);
    if (event < 0) return -event;
    front = piece->radius = own[0];
    piece->rate = own[1];
    piece->margin = own[2];
    piece->length = own[3];
    piece->lack = I->lack;
  } else {
    front = piece->radius;
    I->lack = 4.0 / 3 * front * front * front - piece->lack;
    event = contactlab_impact_run(I, CONTACTLAB_IMPACT_LOCKED, 0, piece->inner, &front);
    if (event < 0) return -event;
    piece->radius = front;
  }
  if (event == 1) {
    --I->pieces;
  } else if (event == 0) {
    return contactlab_impact_stopped(I, front, next);
  } else {
    I->radius = front;
    contactlab_impact_turn(I);
  }
  return CONTACTLAB_IMPACT_DONE;
}

/* All slips, J = 0: V^2 + (1 + s lam) u^5 is constant, and k rises as V falls. */
static inline int contactlab_impact_slide(contactlab_impact_course *I, int *next)
{
  const double press = I->laws.press, drive = I->laws.drive, rate = I->rate, margin = I->margin;
  const double depth = pow(I->radius, 5), left = rate * rate + press * depth;
  const double end = left >= 0 ? -sqrt(left) : NAN;
  double stop = INFINITY, after = 0, last, fall, work, rise, radius;
  int stops = 0;
  I->lack = 0;
  if (drive > 0) {
    stop = rate + margin * press / drive;
    after = depth - margin * (rate + stop) / drive;
    /* where press is negative V grows, through zero if it can */
    stops = press <= 0 && (left < 0 || rate >= 0) ? 1 : after > 0 && (press > 0 || stop < 0);
  }
  last = stops ? stop : end;
  if (stops) {
    fall = rate - last;
    work = 0.4 * margin * margin / drive;
    rise = -margin;
  } else {
    /* over press, which may be zero; in unloading the difference would cancel */
    const double share = rate < 0 ? -depth / (rate + last) : (rate - last) / press;
    after = 0;
    fall = press * share;
    work = 0.8 * share * (-margin - 0.5 * drive * share);
    rise = drive * share;
  }
  radius = pow(fmax(after, 0), 0.2);
  if (press > CONTACTLAB_IMPACT_SHALLOW && !I->watch) {
    I->out.time += contactlab_impact_hertz_time(press, left, radius, last);
    I->out.time -= contactlab_impact_hertz_time(press, left, I->radius, rate);
    if (rate > 0 && last <= 0) I->out.radius = fmax(I->out.radius, pow(left / press, 0.2));
  } else if (depth > 0 || rate > 0) {
    double state[6] = {I->radius, rate, margin, 0, I->out.time, I->out.work};
    const int event = contactlab_impact_phase(I, CONTACTLAB_IMPACT_GROSS, stops, 0, state);
    if (event < 0) return -event;
    I->out.time = state[4];
  }
  I->out.change -= I->sign * (fall + rise);
  I->out.work += work;
  I->out.radius = fmax(I->out.radius, radius);
  I->radius = radius;
  I->rate = last;
  I->margin = margin + rise;
  *next = CONTACTLAB_IMPACT_ENDS;
  return stops ? contactlab_impact_stopped(I, 0, next) : CONTACTLAB_IMPACT_DONE;
}

/* Whether the arguments are numbers that bodies have; rounding may take lam eta to 2 chi. */
static inline int contactlab_impact_has(double psi1, double chi, double lam, double eta, double tolerance, int most)
{
  return fabs(psi1) < INFINITY && chi > 0 && chi < INFINITY && fabs(lam) < INFINITY && fabs(eta) < INFINITY
      && lam * eta <= 2 * chi * (1 + 1e-12) && tolerance > 0 && tolerance < 1 && most > 0;
}

/* As contactlab_impact_watched, with a memory of `room` pieces; as many as `most` hold any impact. */
static inline int contactlab_impact_within(double psi1, double chi, double lam, double eta, double tolerance, int most,
                                           contactlab_impact_watch *watch, void *context,
                                           contactlab_impact_piece *memory, int room, contactlab_impact *out)
{
  contactlab_impact_course course, *I = &course;
  const contactlab_impact none = {1, 0, 0, 0, 0, 1, 0};
  int next, status = CONTACTLAB_IMPACT_DONE;
  *out = none;
  if (!contactlab_impact_has(psi1, chi, lam, eta, tolerance, most)) return CONTACTLAB_IMPACT_RANGE;
  I->chi = chi;
  I->lam = lam;
  I->eta = eta;
  I->tolerance = tolerance;
  I->most = most;
  I->watch = watch;
  I->context = context;
  I->memory = memory;
  I->room = room;
  I->sign = psi1 >= 0 ? 1 : -1;
  I->pieces = I->part = 0;
  I->radius = I->lack = 0;
  I->rate = 1;
  I->margin = 1 - fabs(psi1);
  I->laws = contactlab_impact_laws_of(I->sign, chi, lam, eta);
  I->out = none;
  next = I->margin < 0 || (I->margin == 0 && I->laws.drive <= 0) ? CONTACTLAB_IMPACT_SLIDES : CONTACTLAB_IMPACT_STUCK;
  while (status == CONTACTLAB_IMPACT_DONE && next != CONTACTLAB_IMPACT_ENDS) {
    if (next == CONTACTLAB_IMPACT_STUCK) status = contactlab_impact_stuck(I, &next);
    else if (next == CONTACTLAB_IMPACT_SLIPS) status = contactlab_impact_edge(I, &next);
    else status = contactlab_impact_slide(I, &next);
  }
  I->out.rate = I->rate;
  *out = I->out;
  if (status == CONTACTLAB_IMPACT_DONE && !(fabs(out->rate) + fabs(out->change) < INFINITY))
    status = CONTACTLAB_IMPACT_OUTGROWN;
  return status;
}

/* As contactlab_impact_follow, and calls `watch` with each step unless it is null. */
static inline int contactlab_impact_watched(double psi1, double chi, double lam, double eta, double tolerance, int most,
                                            contactlab_impact_watch *watch, void *context, contactlab_impact *out)
{
  contactlab_impact_piece memory[CONTACTLAB_IMPACT_PIECES];
  return contactlab_impact_within(psi1, chi, lam, eta, tolerance, most, watch, context, memory,
                                  CONTACTLAB_IMPACT_PIECES, out);
}

/* Follows one impact to separation. Returns a status, and what it leaves in `out`.
 *
 * psi1, chi, lam, eta: theory section 14; finite, chi > 0 and lam eta < 2 chi. tolerance: error of a step, between 0
 * and 1. most: steps after which it is given up, at least 1; a hard impact takes 30, one of kappa = 1e6 some 10,000.
 * Other numbers have the status CONTACTLAB_IMPACT_RANGE, and `out` is the impact before first touch. */
static inline int contactlab_impact_follow(double psi1, double chi, double lam, double eta, double tolerance, int most,
                                           contactlab_impact *out)
{
  return contactlab_impact_watched(psi1, chi, lam, eta, tolerance, most, NULL, NULL, out);
}

/* Returns an instant of a step, at t from 0 to its length. */
static inline contactlab_impact_instant contactlab_impact_at(const contactlab_impact_step *step, double t)
{
  const int last = CONTACTLAB_IMPACT_ORDER;
  contactlab_impact_instant at;
  at.time = contactlab_impact_value(step->time, last, t);
  at.radius = contactlab_impact_value(step->radius, last, t);
  at.rate = contactlab_impact_value(step->rate, last, t);
  at.stick = contactlab_impact_value(step->stick, last, t);
  at.psi = step->sign * (at.rate - contactlab_impact_value(step->margin, last, t));
  at.force = step->sign * (at.radius * at.radius * at.radius - 1.5 * contactlab_impact_value(step->lack, last, t));
  return at;
}

#endif
