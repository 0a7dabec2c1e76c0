/* Impacts with friction in steps, normal and tangential forces together: bodies of any shape, one contact or several.
 *
 * Hertz's contact, circular or elliptic, elastic or of Kelvin and Voigt, and springs for partial slip that share its
 * loss. The same marches as in Python (`march/together.py`, `springs/doubling.py`, `turning.py`, `viscous.py`,
 * `jaeger/step.py`), one scene after another: theory, sections 13 to 16 of `contactlab guide theory`.
 *
 *     contactlab_march_contact contact = {...};
 *     contactlab_march_progress progress;
 *     contactlab_march_run run;
 *     contactlab_march_end end;
 *     double work[CONTACTLAB_MARCH_WORK(1, 50)];
 *     int row[2] = {0, 1}, column[1] = {0}, status;
 *     status = contactlab_march_begin(&run, 1, &contact, row, column, W, 2, 50, 0, 1, step, 0, most, NULL, &progress, work,
 *                                     &end);
 *     while (status == CONTACTLAB_MARCH_GOING) status = contactlab_march_on(&run, 1000);
 *
 * Springs gain no energy; steps do, by their own error of second order. C99 and C++, no allocation, no global; every
 * loop is bounded by springs, contacts, steps. Several threads may march several scenes. Do not compile with
 * -ffast-math: NaN would not be seen.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */
#ifndef CONTACTLAB_MARCH_H
#define CONTACTLAB_MARCH_H

#include <math.h>
#include <string.h>

#if defined(__cplusplus) || defined(_MSC_VER)
#define CONTACTLAB_RESTRICT __restrict
#else
#define CONTACTLAB_RESTRICT restrict
#endif

enum {
  CONTACTLAB_MARCH_DONE = 0,
  CONTACTLAB_MARCH_LONG = 1,  /* it does not end in so many steps, or a contact closes too often */
  CONTACTLAB_MARCH_NAN = 2,   /* a velocity is not finite */
  CONTACTLAB_MARCH_DEEP = 3,  /* friction presses a contact deeper than the steps resolve */
  CONTACTLAB_MARCH_INPUT = 4, /* a number, or a count, that has no meaning */
  CONTACTLAB_MARCH_GOING = 5  /* it is not at its end: march on */
};

/* Numbers of work space: of c contacts with n springs each. */
#define CONTACTLAB_MARCH_WORK(c, n) ((4 * (size_t) (c) + 12) * (size_t) (((n) + 7) / 8 * 8))

#define CONTACTLAB_MARCH_EARLY 0.29289321881345254  /* share of a step after which springs are cut first */
#define CONTACTLAB_MARCH_WEIGHT 2.414213562373095   /* what that cut weighs at the end */
#define CONTACTLAB_MARCH_TINY 1e-300
#define CONTACTLAB_MARCH_TOUCH 1e-30
#define CONTACTLAB_MARCH_SLOWEST 1e-3  /* least rate at which a lossy contact is asked for its relaxation time */
#define CONTACTLAB_MARCH_STIFF 0.05    /* feedback of friction on the slip velocity from which it is solved for */
#define CONTACTLAB_MARCH_CLOSING 1e-6  /* rate over the largest approach below which surfaces do not near */
#define CONTACTLAB_MARCH_SLIDES 1e-6   /* slip over it from which a loaded contact slides at the start */
#define CONTACTLAB_MARCH_HOLDS 1e-7    /* force over the greatest from which a contact holds up the end */
#define CONTACTLAB_MARCH_BEFORE 1.5    /* steps before a touch at which a flight ends: rounding decides none */
#define CONTACTLAB_MARCH_OFTEN 50      /* touches of a contact after which a scene is given up */
#define CONTACTLAB_MARCH_DOUBLINGS 64  /* of a grid in one step */
enum { CONTACTLAB_MARCH_TURNS = 3 };

/* A contact at the start, SI. t1, t2 are the principal axes of an elliptic contact. */
typedef struct {
  double velocity[3]; /* rate of approach, slip along t1 and t2 */
  double gap;         /* between the surfaces; 0 at first touch */
  double pull[3];     /* acceleration by constant forces */
  double friction;    /* mu */
  double radius;      /* R of the pair: P = (4/3) E* R^.5 z^1.5 */
  double modulus;     /* E* */
  double shear;       /* 2 G* along t1 */
  double cross;       /* G* along t2 over that along t1: 1 of a circle */
  double span;        /* contact radius of the approach without friction: springs span 1.05 times it */
  double speed;       /* largest rate of approach of the scene */
  double time;        /* A, relaxation time; only with loss */
  double share;       /* relaxation time in shear over that in pressure: 1 */
  double loaded;      /* 1: it carries the constant forces at the start, whatever its gap; else 0 */
} contactlab_march_contact;

/* A contact at the end. */
typedef struct {
  double change[3];  /* of velocity */
  double impulse[3]; /* P, F along t1, t2 */
  double work, shear, normal; /* friction work, loss in shear and in pressure, J */
  double duration, radius, approach, force; /* contact time, greatest radius, approach, normal force */
  double compressions, touches, first, last; /* turns to approach; meetings; first and last touch, s */
  double closed, pushed, moment[3]; /* 1: it is closed; time of constant forces, s; impulse times its time, N s^2 */
} contactlab_march_end;

/* A contact in progress; w are two rows of springs. */
typedef struct {
  double size, radius, steep;              /* A, b, and limit over b^2 - r^2 */
  double edge, excess, time, weight;       /* with loss: b^2, j, A, limit over the sum of l */
  double lead[2], share[2];                /* A times slip, force over Coulomb's limit */
  double *w;
} contactlab_march_springs;

/* Excess of a force over its limit, along both axes: to the closest point in the energy of the springs. */
static inline void contactlab_march_beyond(double x, double y, double limit, double cross, double *over)
{
  const double square = x * x + y * y;
  over[0] = over[1] = 0.0;
  if (!(square > limit * limit)) return;
  if (cross == 1.0) {
    const double k = 1.0 - limit / (sqrt(square) + CONTACTLAB_MARCH_TINY);
    over[0] = x * k;
    over[1] = y * k;
  } else {
    const double size = sqrt(square), unit = 1.0 / fmax(limit, size / 1e60 + CONTACTLAB_MARCH_TINY);
    double u = x * unit, v = y * unit, scale;
    const double p = u * u, q = v * v;
    double both = p + q, g = (sqrt(both) - 1.0) * both / (p + cross * q);
    int i;
    for (i = 0; i < 2; ++i) {
      const double one = 1.0 / (1.0 + g), two = 1.0 / (1.0 + cross * g), first = p * one * one, second = q * two * two;
      both = first + second;
      g += (sqrt(both) - 1.0) * both / (first * one + cross * second * two);
    }
    u /= 1.0 + g;
    v /= 1.0 + cross * g;
    scale = limit / sqrt(u * u + v * v);
    over[0] = x - scale * u;
    over[1] = y - scale * v;
  }
}

/* Rows of springs are as long as the next multiple of 8, and springs beyond n have the limit 0: loops over rows without
 * branches, which a compiler makes instructions of several numbers of (GCC: -O3 -fno-math-errno). */
enum { CONTACTLAB_MARCH_LANES = 8 };
#define CONTACTLAB_MARCH_ROW(n) (((n) + 7) / 8 * 8)

static inline double contactlab_march_clip(double x, double limit)
{
  const double high = x > limit ? limit : x;
  return high < -limit ? -limit : high;
}

/* Excesses of a row of vectors, `share` times each. */
static inline void contactlab_march_over(int n, const double *CONTACTLAB_RESTRICT x, const double *CONTACTLAB_RESTRICT y, const double *CONTACTLAB_RESTRICT limit,
                                         double cross, double share, double *CONTACTLAB_RESTRICT ox, double *CONTACTLAB_RESTRICT oy)
{
  int i;
  if (cross == 1.0) {
    for (i = 0; i < n; ++i) {
      const double square = x[i] * x[i] + y[i] * y[i], k = 1.0 - limit[i] / (sqrt(square) + CONTACTLAB_MARCH_TINY);
      const double part = square > limit[i] * limit[i] ? share * k : 0.0;
      ox[i] = x[i] * part;
      oy[i] = y[i] * part;
    }
  } else {
    double over[2];
    for (i = 0; i < n; ++i) {
      contactlab_march_beyond(x[i], y[i], limit[i], cross, over);
      ox[i] = share * over[0];
      oy[i] = share * over[1];
    }
  }
}

/* Cuts a row of numbers, or of vectors, to their limits; `ox` and `oy` are room for two rows. */
static inline void contactlab_march_cut(int axes, int n, double *CONTACTLAB_RESTRICT x, double *CONTACTLAB_RESTRICT y, const double *CONTACTLAB_RESTRICT limit, double cross,
                                        double *CONTACTLAB_RESTRICT ox, double *CONTACTLAB_RESTRICT oy)
{
  int i;
  if (axes == 1) for (i = 0; i < n; ++i) x[i] = contactlab_march_clip(x[i], limit[i]);
  else {
    contactlab_march_over(n, x, y, limit, cross, 1.0, ox, oy);
    for (i = 0; i < n; ++i) {
      x[i] -= ox[i];
      y[i] -= oy[i];
    }
  }
}

/* The sum of a row, in eight parts. */
static inline double contactlab_march_total(int n, const double *x)
{
  double s[CONTACTLAB_MARCH_LANES] = {0.0};
  int i, l;
  for (i = 0; i < n; i += CONTACTLAB_MARCH_LANES)
    for (l = 0; l < CONTACTLAB_MARCH_LANES; ++l) s[l] += x[i + l];
  return ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
}

/* Doubles what n springs span until it holds `reach`; returns the energy lost over 2 G*. */
static inline double contactlab_march_fit(int axes, int n, double *w, double *size, double reach, double cross)
{
  const int m = CONTACTLAB_MARCH_ROW(n);
  double lost = 0.0;
  int i, k;
  for (k = 0; reach > *size && k < CONTACTLAB_MARCH_DOUBLINGS; ++k) {
    double sum = 0.0;
    for (i = 0; i < n / 2; ++i) {
      const double d = w[2 * i] - w[2 * i + 1];
      sum += d * d;
      w[i] = 0.5 * (w[2 * i] + w[2 * i + 1]);
      if (axes == 2) {
        const double e = w[m + 2 * i] - w[m + 2 * i + 1];
        sum += e * e / cross;
        w[m + i] = 0.5 * (w[m + 2 * i] + w[m + 2 * i + 1]);
      }
    }
    for (; i < n; ++i) {
      w[i] = 0.0;
      if (axes == 2) w[m + i] = 0.0;
    }
    lost += 0.25 * (*size / n) * sum;
    *size *= 2.0;
  }
  return lost;
}

/* A step of springs without loss; `room` holds 3 rows. Returns the friction work. */
static inline double contactlab_march_elastic(int axes, int n, const contactlab_march_contact *c,
    contactlab_march_springs *s, const double *moved, double radius, double load, double *CONTACTLAB_RESTRICT room, double *force)
{
  const int row = CONTACTLAB_MARCH_ROW(n);
  const double limit = c->friction * load, before = s->radius, growth = radius - before, cross = c->cross, was_steep = s->steep;
  const double mx = moved[0], my = axes == 2 ? cross * moved[1] : 0.0, b = radius <= CONTACTLAB_MARCH_TOUCH * c->radius ? 0.0 : radius;
  const double square = b * b, earlier = before * before, per_growth = growth > 0.0 ? growth : 1.0, least = growth > 0.0 ? 0.0 : 1.0;
  double *CONTACTLAB_RESTRICT x = s->w, *CONTACTLAB_RESTRICT y = s->w + row, *CONTACTLAB_RESTRICT most = room, *CONTACTLAB_RESTRICT part = room + row, *CONTACTLAB_RESTRICT lost = room + 2 * row;
  double merged = 0.0, cell, stiffness, total, steep, work;
  int i, inside = row;
  if (b > s->size) merged = contactlab_march_fit(axes, n, s->w, &s->size, b, cross);
  cell = s->size / n;
  stiffness = c->shear * cell;
  {
    const double far = (b > before ? b : before) / cell + 1.0;
    if (far < n) inside = CONTACTLAB_MARCH_ROW((int) far);
  }
  for (i = 0; i < inside; ++i) {
    const double r = (i + 0.5) * cell, in = square - r * r, p = (b - r) / per_growth, q = p > 1.0 ? 1.0 : p;
    most[i] = in > 0.0 ? in : 0.0;
    part[i] = q > least ? q : least;
  }
  total = stiffness * contactlab_march_total(inside, most);
  steep = limit / (total + (total == 0.0));
  if (axes == 1) {
    for (i = 0; i < inside; ++i) {
      const double m = most[i] * steep, old = x[i], trial = old + part[i] * mx, high = trial > m ? m : trial, now = high < -m ? -m : high;
      lost[i] = (trial - now) * (old + now);
      x[i] = now;
    }
  } else if (cross == 1.0) {
    for (i = 0; i < inside; ++i) {
      const double r = (i + 0.5) * cell, in = earlier - r * r, was = in > 0.0 ? in * was_steep : 0.0, m = most[i] * steep;
      const double mid = was + CONTACTLAB_MARCH_EARLY * (m - was), dx = part[i] * mx, dy = part[i] * my;
      const double ax = x[i] + CONTACTLAB_MARCH_EARLY * dx, ay = y[i] + CONTACTLAB_MARCH_EARLY * dy, s2 = ax * ax + ay * ay;
      const double k = 1.0 - mid / (sqrt(s2) + CONTACTLAB_MARCH_TINY), k2 = s2 > mid * mid ? CONTACTLAB_MARCH_WEIGHT * k : 0.0;
      const double ux = ax * k2, uy = ay * k2, tx = x[i] + dx - ux, ty = y[i] + dy - uy, t2 = tx * tx + ty * ty;
      const double j = 1.0 - m / (sqrt(t2) + CONTACTLAB_MARCH_TINY), j2 = t2 > m * m ? j : 0.0;
      const double nx = tx - tx * j2, ny = ty - ty * j2;
      lost[i] = (ux + tx * j2) * (x[i] + nx) + (uy + ty * j2) * (y[i] + ny);
      x[i] = nx;
      y[i] = ny;
    }
  } else {
    for (i = 0; i < inside; ++i) {
      const double r = (i + 0.5) * cell, in = earlier - r * r, was = in > 0.0 ? in * was_steep : 0.0, m = most[i] * steep;
      const double dx = part[i] * mx, dy = part[i] * my;
      double e[2], o[2], ax, ay;
      contactlab_march_beyond(x[i] + CONTACTLAB_MARCH_EARLY * dx, y[i] + CONTACTLAB_MARCH_EARLY * dy,
                              was + CONTACTLAB_MARCH_EARLY * (m - was), cross, e);
      ax = x[i] + dx - CONTACTLAB_MARCH_WEIGHT * e[0];
      ay = y[i] + dy - CONTACTLAB_MARCH_WEIGHT * e[1];
      contactlab_march_beyond(ax, ay, m, cross, o);
      ax -= o[0];
      ay -= o[1];
      lost[i] = (CONTACTLAB_MARCH_WEIGHT * e[0] + o[0]) * (x[i] + ax) + (CONTACTLAB_MARCH_WEIGHT * e[1] + o[1]) / cross * (y[i] + ay);
      x[i] = ax;
      y[i] = ay;
    }
  }
  work = 0.5 * stiffness * contactlab_march_total(inside, lost);
  force[0] = stiffness * contactlab_march_total(inside, x);
  force[1] = axes == 2 ? stiffness * contactlab_march_total(inside, y) : 0.0;
  if (b <= 0.0) {
    memset(s->w, 0, (size_t) (axes * row) * sizeof *s->w);
    force[0] = force[1] = 0.0;
  }
  s->radius = b;
  s->steep = steep;
  return (work > 0.0 ? work : 0.0 * work) + c->shear * merged;
}

/* b and j of a contact of radius b under a load, in units of the grid and of Hertz's load. */
static inline void contactlab_march_limits(double b, double load, double *edge, double *excess)
{
  const double j = b > 0.0 ? (load - b * b * b) / (1.5 * (b + CONTACTLAB_MARCH_TINY)) : 0.0;
  *edge = j < 0.0 ? cbrt(load) : b;
  *excess = j > 0.0 ? j : 0.0;
}

/* Tangential motion of a step with loss, scaled but for time and force. */
typedef struct {
  double move[2], drift, acted, slip[2], force[2], mobility, limit, acting, scale, cross;
} contactlab_march_drive;

/* How many of n springs an edge at b^2 holds. */
static inline int contactlab_march_held(int n, double cell, double edge)
{
  const double far = sqrt(edge > 0.0 ? edge : 0.0) / cell + 0.5;
  int k = far < n ? (int) far : n;
  while (k < n && edge - ((k + 0.5) * cell) * ((k + 0.5) * cell) > 0.0) ++k;
  while (k > 0 && !(edge - ((k - 0.5) * cell) * ((k - 0.5) * cell) > 0.0)) --k;
  return k;
}

/* A step of springs with loss, from `s` to `out`; `room` holds 12 rows. */
static inline void contactlab_march_lossy(int axes, int n, const contactlab_march_springs *s,
    contactlab_march_springs *out, double edge, double excess, double time, const contactlab_march_drive *d, int grows,
    double *room, double *force, double *work, double *loss)
{
  const int row = CONTACTLAB_MARCH_ROW(n);
  double *CONTACTLAB_RESTRICT held = room, *CONTACTLAB_RESTRICT old = room + 2 * row, *CONTACTLAB_RESTRICT pulled = room + 4 * row, *CONTACTLAB_RESTRICT w = out->w;
  double *CONTACTLAB_RESTRICT least = room + 6 * row, *CONTACTLAB_RESTRICT most = room + 7 * row, *CONTACTLAB_RESTRICT ox = room + 8 * row, *CONTACTLAB_RESTRICT oy = room + 9 * row;
  double *CONTACTLAB_RESTRICT tx = room + 10 * row, *CONTACTLAB_RESTRICT ty = room + 11 * row, one[2], at[2], sum[2], slip[2], size = s->size, ratio = 1.0;
  const double middle = s->time > 0.0 ? 0.5 * (s->time + time) : time, lead = time * d->scale;
  const double decay = fmin(d->drift / fmax(middle, CONTACTLAB_MARCH_TINY), 1e300), growth = edge - s->edge;
  const double gone = -expm1(-decay), bent = 1.0 - gone / fmax(decay, CONTACTLAB_MARCH_TINY);
  const double early = CONTACTLAB_MARCH_EARLY * decay / (1.0 + CONTACTLAB_MARCH_EARLY * decay);
  const double turned[2] = {d->move[0], axes == 2 ? d->cross * d->move[1] : 0.0};
  const double pull[2] = {turned[0] / decay, turned[1] / decay};
  double total, per, weight, gained, cell, stiff, earlier, later, lost;
  const double cross = d->cross, edge0 = s->edge, excess0 = s->excess, lead0 = s->lead[0], lead1 = s->lead[1], move1 = d->move[1];
  int i, k, first, count, inside, grown = 0, hard, turn;
  memcpy(held, s->w, (size_t) (axes * row) * sizeof *held);
  if (grows && sqrt(edge) > size) {
    double unit = s->size;
    grown = 1;
    for (i = 0; i < row; ++i) {
      const double r = (i + 0.5) * (unit / n);
      least[i] = i < n && edge0 - r * r > 0.0 ? edge0 - r * r + excess0 : 0.0;
      old[i] = s->w[i] + lead0;
    }
    if (axes == 2) for (i = 0; i < row; ++i) old[row + i] = s->w[row + i] + lead1;
    contactlab_march_cut(axes, row, old, old + row, least, cross, ox, oy);
    contactlab_march_fit(axes, n, old, &unit, sqrt(edge), cross);
    contactlab_march_fit(axes, n, held, &size, sqrt(edge), cross);
    ratio = size / s->size;
  }
  cell = size / n;
  first = contactlab_march_held(n, cell, edge0);
  count = contactlab_march_held(n, cell, edge);
  for (i = 0; i < row; ++i) {
    const double r = (i + 0.5) * cell, q = r * r, a = edge0 - q, b = edge - q;
    least[i] = a > 0.0 ? a + excess0 : 0.0;
    most[i] = b > 0.0 ? b + excess : 0.0;
  }
  for (i = n; i < row; ++i) least[i] = most[i] = 0.0;
  if (axes == 1) {
    const double kept = 1.0 - gone, move = turned[0];
    for (i = 0; i < row; ++i) {
      const double h = held[i], span = least[i] * gone + (most[i] - least[i]) * bent, free = h * kept, trial = h + move;
      const double low = free - span, high = free + span, raised = trial < low ? low : trial;
      w[i] = raised > high ? high : raised;
    }
  } else {
    const double ax = CONTACTLAB_MARCH_EARLY * turned[0] + pull[0], ay = CONTACTLAB_MARCH_EARLY * turned[1] + pull[1];
    for (i = 0; i < row; ++i) {
      tx[i] = held[i] + ax;
      ty[i] = held[row + i] + ay;
      pulled[i] = least[i] + CONTACTLAB_MARCH_EARLY * (most[i] - least[i]);
    }
    contactlab_march_over(row, tx, ty, pulled, cross, CONTACTLAB_MARCH_WEIGHT * early, ox, oy);
    for (i = 0; i < row; ++i) {
      w[i] = held[i] + turned[0] - ox[i];
      w[row + i] = held[row + i] + turned[1] - oy[i];
      tx[i] = w[i] + pull[0];
      ty[i] = w[row + i] + pull[1];
    }
    contactlab_march_over(row, tx, ty, most, cross, early, ox, oy);
    for (i = 0; i < row; ++i) {
      w[i] -= ox[i];
      w[row + i] -= oy[i];
    }
  }
  for (i = first; i < count; ++i) { /* springs that enter, each for its part of the step */
    const double r = (i + 0.5) * cell, q = r * r, last = most[i], p = (edge - q) / growth;
    const double part = p > 1.0 ? 1.0 : p, begun = excess + (excess0 - excess) * part, kept = exp(-decay * (1.0 - part));
    const double own = part * decay, went = -expm1(-own), curved = 1.0 - went / fmax(own, CONTACTLAB_MARCH_TINY);
    if (axes == 1) {
      const double h = held[i] * kept, room_of = begun * went + (last - begun) * curved, free = h * (1.0 - went), trial = h + part * turned[0];
      const double raised = trial < free - room_of ? free - room_of : trial;
      w[i] = raised > free + room_of ? free + room_of : raised;
    } else {
      const double hx = held[i] * kept, hy = held[row + i] * kept, dx = part * turned[0], dy = part * turned[1];
      const double share = CONTACTLAB_MARCH_EARLY * own / (1.0 + CONTACTLAB_MARCH_EARLY * own);
      double e[2], o[2], tx1, ty1;
      contactlab_march_beyond(hx + CONTACTLAB_MARCH_EARLY * dx + pull[0], hy + CONTACTLAB_MARCH_EARLY * dy + pull[1],
                              begun + CONTACTLAB_MARCH_EARLY * (last - begun), cross, e);
      tx1 = hx + dx - CONTACTLAB_MARCH_WEIGHT * share * e[0];
      ty1 = hy + dy - CONTACTLAB_MARCH_WEIGHT * share * e[1];
      contactlab_march_beyond(tx1 + pull[0], ty1 + pull[1], last, cross, o);
      w[i] = tx1 - share * o[0];
      w[row + i] = ty1 - share * o[1];
    }
  }
  total = contactlab_march_total(row, most);
  per = total > 0.0 ? 1.0 / total : 1.0;
  weight = d->limit * per;
  stiff = lead * d->mobility * d->acting * per;
  hard = stiff * count > CONTACTLAB_MARCH_STIFF;
  for (k = 0; k < 2; ++k) {
    one[k] = d->acting > 0.0 ? d->force[k] / d->acting : 0.0;
    slip[k] = at[k] = d->slip[k];
  }
  inside = grown ? row : CONTACTLAB_MARCH_ROW(first > count ? first : count);
  for (turn = 0; turn < (hard ? (int) CONTACTLAB_MARCH_TURNS : 1); ++turn) {
    const double p = lead * at[0], q = axes == 2 ? lead * cross * at[1] : 0.0;
    int stuck = 0;
    slip[0] = at[0];
    slip[1] = at[1];
    if (axes == 1) {
      for (i = 0; i < inside; ++i) pulled[i] = contactlab_march_clip(w[i] + p, most[i]);
      if (hard) for (i = 0; i < count; ++i) stuck += fabs(w[i] + p) < most[i];
    } else {
      for (i = 0; i < inside; ++i) {
        pulled[i] = w[i] + p;
        pulled[row + i] = w[row + i] + q;
      }
      if (hard) for (i = 0; i < count; ++i) stuck += pulled[i] * pulled[i] + pulled[row + i] * pulled[row + i] < most[i] * most[i];
      contactlab_march_cut(2, inside, pulled, pulled + row, most, cross, ox, oy);
      sum[1] = contactlab_march_total(inside, pulled + row);
    }
    sum[0] = contactlab_march_total(inside, pulled);
    for (k = 0; k < axes; ++k) {
      const double now = hard ? one[k] + (sum[k] * per - one[k]) / (1.0 + stiff * stuck) : sum[k] * per;
      at[k] += (one[k] - now) * d->mobility * d->acting;
      one[k] = now;
    }
  }
  if (!(total > 0.0)) { /* smaller than a cell: of its edge, or as it was */
    one[0] = s->share[0];
    one[1] = s->share[1];
    if (excess > 0.0) {
      double norm;
      one[0] = lead * d->slip[0] / excess;
      one[1] = axes == 2 ? lead * cross * d->slip[1] / excess : 0.0;
      norm = fmax(sqrt(one[0] * one[0] + one[1] * one[1]), 1.0);
      one[0] /= norm;
      one[1] /= norm;
    }
  }
  earlier = (1.0 - d->acted) * ratio * s->weight;
  later = d->acted * weight;
  if (!grown) {
    for (i = 0; i < inside; ++i) old[i] = held[i] + lead0;
    if (axes == 2) for (i = 0; i < inside; ++i) old[row + i] = held[row + i] + lead1;
    contactlab_march_cut(axes, inside, old, old + row, least, cross, ox, oy);
  }
  for (i = 0; i < inside; ++i) {
    const double mean = earlier * old[i] + later * pulled[i];
    tx[i] = mean * (w[i] - held[i]);
    ty[i] = mean * turned[0];
  }
  if (axes == 2)
    for (i = 0; i < inside; ++i) {
      const double mean = earlier * old[row + i] + later * pulled[row + i];
      tx[i] += mean * (w[row + i] - held[row + i]) / cross;
      ty[i] += mean * move1;
    }
  gained = contactlab_march_total(inside, tx);
  lost = contactlab_march_total(inside, ty);
  for (i = first; i < count; ++i) { /* as if they had moved all the time: the force is the mean of the step */
    const double r = (i + 0.5) * cell, p = (edge - r * r) / growth, more = 1.0 / fmax(p > 1.0 ? 1.0 : p, CONTACTLAB_MARCH_TINY) - 1.0;
    gained += more * (earlier * old[i] + later * pulled[i]) * (w[i] - held[i]);
    if (axes == 2) gained += more * (earlier * old[row + i] + later * pulled[row + i]) * (w[row + i] - held[row + i]) / cross;
  }
  *work = lost - gained;
  if (!(*work > 0.0)) *work = 0.0 * *work;
  *loss = gained;
  for (k = 0; k < 2; ++k) {
    const double carried = lead * slip[k];
    out->lead[k] = k ? carried * cross : carried;
    out->share[k] = one[k];
    force[k] = d->acting * one[k];
  }
  out->size = size;
  out->edge = edge;
  out->excess = excess;
  out->time = time;
  out->weight = weight;
}

/* Normal force and contact radius of Kelvin-Voigt bodies; returns 0 out of contact. */
static inline int contactlab_march_press(double stiffness, double time, double radius, double approach, double rate,
                                         double *force, double *b)
{
  const double inside = approach > 0.0 ? approach : 0.0, lead = time * rate;
  double edge = inside + (lead < 0.0 ? lead : 0.0);
  if (!(edge > 0.0)) edge = 0.0 * (approach + rate);
  *force = stiffness * sqrt(edge) * (1.5 * (inside + lead) - 0.5 * edge);
  if (*force <= 0.0) {
    *force = *b = 0.0;
    return 0;
  }
  *b = sqrt(radius * edge);
  return 1;
}

/* Whether all that a scene is made of has a meaning. */
static inline int contactlab_march_sound(int contacts, const contactlab_march_contact *c, const int *row,
                                         const int *column, int axes, int springs, double step, double most)
{
  int i, m;
  if ((axes != 1 && axes != 2) || springs < 2 || springs % 2 || !(step > 0.0) || !(step < INFINITY) || !(most >= 1.0)
      || !(most < INFINITY)) return 0;
  for (i = 0; i < contacts; ++i) {
    const contactlab_march_contact *o = c + i;
    double sum = 0.0;
    int k;
    for (k = 0; k < 3; ++k) sum += o->velocity[k] + o->pull[k];
    if (!isfinite(sum) || !isfinite(o->speed) || !(o->gap >= 0.0) || !(o->friction >= 0.0) || !(o->radius > 0.0) || !(o->modulus > 0.0)
        || !(o->shear >= 0.0) || !(o->cross > 0.0) || !(o->span > 0.0) || !(o->time >= 0.0) || !(o->share >= 0.0)
        || !isfinite(o->gap + o->friction + o->radius + o->modulus + o->shear + o->cross + o->span + o->time + o->share)) return 0;
    for (k = 0, m = row[i]; m < row[i + 1]; ++m) {
      if (column[m] < 0 || column[m] >= contacts) return 0;
      k |= column[m] == i;
    }
    if (!k) return 0;
  }
  return row[0] == 0;
}

/* A contact in progress. */
typedef struct {
  contactlab_march_springs now, next;
  double velocity[3], kick[3], force[3], approach, radius, tried[2], answered[2], work, shear;
  int touching, touched;
} contactlab_march_progress;

/* The rate of approach to try next; `answer` is what the last one gave. By secants, as a dashpot answers a rate by so
 * much less of it that the plain iteration may run away. */
static inline double contactlab_march_nearer(contactlab_march_progress *p, int turn, double answer)
{
  double rate = answer;
  if (turn > 1) {
    const double change = p->tried[1] - p->tried[0];
    double slope = (answer - p->answered[1]) / (change + (change == 0.0));
    if (slope > 0.0) slope = 0.0;
    rate = p->tried[1] + (answer - p->tried[1]) / (1.0 - slope);
  } else {
    p->tried[turn] = rate;
    p->answered[turn] = answer;
  }
  return rate;
}

/* Forces of a lossy contact where it moves at the rates `at`, by a displacement along the surface. */
static inline void contactlab_march_drag(int axes, int n, const contactlab_march_contact *c, contactlab_march_progress *p,
    const double *at, const double *moved, double mobility, double step, double drift, double *room)
{
  const double stiffness = (4.0 / 3.0) * c->modulus * sqrt(c->radius), a = c->span;
  const double peak = (4.0 / 3.0) * c->modulus * a * a * a / c->radius;
  const double slip = c->friction * a * a / (c->shear / (2.0 * c->modulus) * c->radius);
  contactlab_march_drive d;
  double load, radius, edge, excess, asked, push, b, time, rate, metres;
  int k;
  p->touching = contactlab_march_press(stiffness, c->time, c->radius, p->approach, at[0], &load, &radius);
  contactlab_march_limits(radius / a, load / peak, &edge, &excess);
  rate = fmax(fabs(at[0]), CONTACTLAB_MARCH_SLOWEST * c->speed);
  contactlab_march_press(stiffness, c->time, c->radius, p->approach, rate, &asked, &b);
  contactlab_march_limits(b / a, asked / peak, &b, &push);
  time = c->share * (push * (a * a) / (c->radius * rate));
  d.scale = c->friction > 0.0 ? 1.0 / slip : 0.0;
  metres = d.scale > 0.0 ? 1.0 / d.scale : 0.0;
  d.drift = drift;
  d.acted = step * drift > 0.0 ? 0.5 * step / drift : 0.5;
  if (d.acted > 1.0) d.acted = 1.0;
  for (k = 0; k < 2; ++k) {
    d.move[k] = k < axes ? moved[k] * d.scale : 0.0;
    d.slip[k] = k < axes ? at[1 + k] : 0.0;
    d.force[k] = p->force[1 + k];
  }
  d.mobility = mobility;
  d.limit = d.acting = c->friction * load;
  d.cross = axes == 2 ? c->cross : 1.0;
  contactlab_march_lossy(axes, n, &p->now, &p->next, edge * edge, excess, time, &d, 1, room, p->force + 1, &p->work, &p->shear);
  p->work *= metres;
  p->shear *= metres;
  p->force[0] = load;
  p->radius = radius;
}

/* Velocities in a time by forces at the contacts and by constant forces. */
static inline void contactlab_march_kicked(int contacts, const contactlab_march_contact *c, const int *row,
    const int *column, const double *block, int axes, double step, contactlab_march_progress *p)
{
  int i, j, k, m;
  for (i = 0; i < contacts; ++i) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (m = row[i]; m < row[i + 1]; ++m) {
      const double *W = block + 9 * (size_t) m, *f = p[column[m]].force;
      for (j = 0; j <= axes; ++j) {
        double each = 0.0;
        for (k = 0; k <= axes; ++k) each += W[3 * j + k] * f[k];
        sum[j] += each;
      }
    }
    for (j = 0; j <= axes; ++j) p[i].kick[j] = step * (sum[j] - c[i].pull[j]);
  }
}

/* A scene in progress: what `contactlab_march_begin` was given, and how far it is. */
typedef struct {
  const contactlab_march_contact *c;
  const int *row, *column;
  const double *block, *deepest;
  contactlab_march_progress *progress;
  double *work;
  contactlab_march_end *end;
  double step, leading, most, time, width;
  long steps;
  int contacts, axes, springs, lossy, alone, pulled;
} contactlab_march_run;

/* The block of W of a contact itself. */
static inline const double *contactlab_march_own(const contactlab_march_run *run, int i)
{
  int m = run->row[i];
  while (m < run->row[i + 1] && run->column[m] != i) ++m;
  return run->block + 9 * (size_t) m;
}

/* Room beside the springs of all contacts. */
static inline double *contactlab_march_spare(const contactlab_march_run *run)
{
  return run->work + 4 * (size_t) CONTACTLAB_MARCH_ROW(run->springs) * (size_t) run->contacts;
}

static inline void contactlab_march_swap(contactlab_march_progress *p)
{
  const contactlab_march_springs other = p->now;
  p->now = p->next;
  p->next = other;
}

/* Lays a contact where its force at rest carries the constant forces: its springs are without tension, or at their limit
 * along the slip if it slides. */
static inline void contactlab_march_lay(const contactlab_march_run *run, int i)
{
  const contactlab_march_contact *c = run->c + i;
  contactlab_march_progress *p = run->progress + i;
  contactlab_march_end *e = run->end + i;
  const double load = fmax(c->pull[0], 0.0) / contactlab_march_own(run, i)[0], still[3] = {0.0, 0.0, 0.0};
  const double root = cbrt(load / ((4.0 / 3.0) * c->modulus * sqrt(c->radius))), radius = sqrt(c->radius) * root;
  const double speed = sqrt(p->velocity[1] * p->velocity[1] + p->velocity[2] * p->velocity[2]);
  const double reach = speed > CONTACTLAB_MARCH_SLIDES * c->speed ? c->friction * radius / speed : 0.0;
  int pressed;
  p->approach = root * root;
  for (pressed = 0; pressed < 2; ++pressed) {
    const double far = pressed ? reach : 0.0, moved[2] = {far * p->velocity[1], far * p->velocity[2]};
    p->force[1] = p->force[2] = 0.0;
    if (run->lossy) {
      contactlab_march_drag(run->axes, run->springs, c, p, still, moved, 0.0, run->step, run->step,
                            contactlab_march_spare(run));
      contactlab_march_swap(p);
    } else contactlab_march_elastic(run->axes, run->springs, c, &p->now, moved, radius, load,
                                    contactlab_march_spare(run), p->force + 1);
  }
  p->force[0] = load;
  p->force[1] = p->force[2] = 0.0;
  p->touched = p->touching = 1;
  e->touches = 1.0;
  e->first = e->last = 0.0;
}

/* Begins a scene; returns CONTACTLAB_MARCH_GOING, or CONTACTLAB_MARCH_INPUT.
 *
 * contacts, c      the contacts
 * row, column, block  how forces at contacts move contacts: W in blocks of 3 x 3 that are not zero, by rows as of a
 *                  compressed sparse matrix, the block of a contact itself among them; 9 numbers each
 * axes             1: slip along t1 only; 2
 * springs          even
 * lossy            0: elastic; 1: Kelvin-Voigt bodies, whose relaxation times may be zero
 * alone            1: one contact that touches, whose end is when it parts; 0: contacts that open and close, whose end
 *                  is when none closes and none holds a force
 * step             s, the width of steps
 * leading          with loss: so many steps grow evenly at first
 * most             steps after which it is given up
 * deepest          approach in m of each contact beyond which the steps do not resolve it, or NULL
 * progress         of each contact
 * work             CONTACTLAB_MARCH_WORK(contacts, springs) numbers
 * end              of each contact, set by `contactlab_march_on`: that of the last step if the status is not 0 */
static inline int contactlab_march_begin(contactlab_march_run *run, int contacts, const contactlab_march_contact *c,
    const int *row, const int *column, const double *block, int axes, int springs, int lossy, int alone, double step,
    double leading, double most, const double *deepest, contactlab_march_progress *progress, double *work,
    contactlab_march_end *end)
{
  const size_t width = CONTACTLAB_MARCH_ROW(springs);
  int i, k;
  memset(run, 0, sizeof *run);
  if (contacts < 1 || (alone && contacts > 1) || !contactlab_march_sound(contacts, c, row, column, axes, springs, step, most))
    return CONTACTLAB_MARCH_INPUT;
  run->contacts = contacts;
  run->c = c;
  run->row = row;
  run->column = column;
  run->block = block;
  run->axes = axes;
  run->springs = springs;
  run->lossy = lossy;
  run->alone = alone;
  run->step = step;
  run->leading = leading;
  run->most = most;
  run->deepest = deepest;
  run->progress = progress;
  run->work = work;
  run->end = end;
  memset(end, 0, (size_t) contacts * sizeof *end);
  memset(work, 0, CONTACTLAB_MARCH_WORK(contacts, springs) * sizeof *work);
  memset(progress, 0, (size_t) contacts * sizeof *progress);
  for (i = 0; i < contacts; ++i) {
    contactlab_march_progress *p = progress + i;
    end[i].compressions = 1.0;
    end[i].first = end[i].last = NAN;
    p->now.w = work + 4 * width * (size_t) i;
    p->next.w = p->now.w + 2 * width;
    p->now.size = lossy ? 1.05 : 1.05 * c[i].span;
    p->approach = -c[i].gap;
    for (k = 0; k <= axes; ++k) {
      p->velocity[k] = c[i].velocity[k];
      if (c[i].pull[k] != 0.0) run->pulled = 1;
    }
    if (c[i].loaded > 0.0) contactlab_march_lay(run, i);
  }
  return CONTACTLAB_MARCH_GOING;
}

/* Forces of a step of an elastic contact. */
static inline void contactlab_march_press_elastic(const contactlab_march_run *run, int i, double drift, double *room)
{
  const contactlab_march_contact *c = run->c + i;
  contactlab_march_progress *p = run->progress + i;
  const double x = p->approach > 0.0 ? p->approach : 0.0;
  const double moved[2] = {p->velocity[1] * drift, p->velocity[2] * drift};
  p->radius = sqrt(c->radius * x);
  p->force[0] = (4.0 / 3.0) * c->modulus * p->radius * x;
  p->touching = p->approach > 0.0;
  if (p->touching || p->touched)
    p->work = contactlab_march_elastic(run->axes, run->springs, c, &p->now, moved, p->radius, p->force[0], room,
                                       p->force + 1);
  else p->work = p->force[1] = p->force[2] = 0.0;
}

/* Forces of a step of all contacts with loss. */
static inline void contactlab_march_press_lossy(const contactlab_march_run *run, double drift, double *room)
{
  int turn, i, k;
  for (turn = 0; turn < (int) CONTACTLAB_MARCH_TURNS; ++turn) {
    contactlab_march_kicked(run->contacts, run->c, run->row, run->column, run->block, run->axes, run->width,
                            run->progress);
    for (i = 0; i < run->contacts; ++i) {
      contactlab_march_progress *p = run->progress + i;
      const double *W = contactlab_march_own(run, i), moved[2] = {p->velocity[1] * drift, p->velocity[2] * drift};
      const double mobility = 0.5 * run->width * (run->axes == 1 ? W[4] : 0.5 * (W[4] + W[8]));
      double at[3];
      for (k = 0; k < 3; ++k) at[k] = p->velocity[k] - 0.5 * p->kick[k];
      at[0] = contactlab_march_nearer(p, turn, at[0]);
      contactlab_march_drag(run->axes, run->springs, run->c + i, p, at, moved, mobility, run->width, drift, room);
    }
  }
  for (i = 0; i < run->contacts; ++i) contactlab_march_swap(run->progress + i);
}

/* Velocities after a step, and what it adds to the end; returns 1 while a contact touches, -1 if a velocity is not finite. */
static inline int contactlab_march_kick(contactlab_march_run *run, double *greatest)
{
  int i, k, going = 0;
  for (i = 0; i < run->contacts; ++i)
    if (!run->progress[i].touching)
      for (k = 0; k < 3; ++k) run->progress[i].force[k] = 0.0;
  contactlab_march_kicked(run->contacts, run->c, run->row, run->column, run->block, run->axes, run->width,
                          run->progress);
  for (i = 0; i < run->contacts; ++i) {
    contactlab_march_progress *p = run->progress + i;
    contactlab_march_end *e = run->end + i;
    const double drifting = p->velocity[0];
    double sum = 0.0;
    e->work += p->work;
    e->shear += p->shear;
    if (p->touching) {
      if (run->lossy) e->normal += p->force[0] * (p->velocity[0] - 0.5 * p->kick[0]) * run->width;
      e->duration += run->width;
      e->radius = fmax(e->radius, p->radius);
      e->approach = fmax(e->approach, p->approach);
      e->force = fmax(e->force, p->force[0]);
      for (k = 0; k < 3; ++k) {
        const double impulse = run->width * p->force[k];
        e->impulse[k] += impulse;
        if (run->pulled) e->moment[k] += (e->pushed + 0.5 * run->width) * impulse;
      }
      if (!p->touched) {
        e->touches += 1.0;
        if (isnan(e->first)) e->first = run->time;
      }
      e->last = run->time;
      going = 1;
    } else if (!run->lossy && run->alone) e->duration = run->time - p->approach / drifting;
    p->touched = p->touching;
    e->closed = p->touching;
    if (run->pulled) e->pushed += run->width;
    for (k = 0; k <= run->axes; ++k) {
      e->change[k] -= p->kick[k];
      p->velocity[k] = run->c[i].velocity[k] + e->change[k];
    }
    if (p->touching && p->velocity[0] > 0.0 && p->velocity[0] + p->kick[0] <= 0.0) e->compressions += 1.0;
    for (k = 0; k <= run->axes; ++k) sum += p->velocity[k];
    if (!isfinite(sum)) return -1;
    *greatest = fmax(*greatest, e->force);
  }
  return going;
}

/* Whether contacts are to come or to end; time without contact passes. */
static inline int contactlab_march_closes(contactlab_march_run *run, int going, double greatest)
{
  double least = INFINITY, flight;
  int i, on = 0;
  for (i = 0; i < run->contacts; ++i) {
    const contactlab_march_progress *p = run->progress + i;
    const int closes = p->velocity[0] > CONTACTLAB_MARCH_CLOSING * run->c[i].speed;
    const int holds = (closes || p->force[0] > CONTACTLAB_MARCH_HOLDS * greatest) && !(run->c[i].loaded > 0.0);
    if (p->touching ? holds : closes) on = 1;
    if (!p->touching && closes) least = fmin(least, -p->approach / p->velocity[0]);
  }
  if (on && !going && !run->pulled) {
    flight = least - CONTACTLAB_MARCH_BEFORE * run->width;
    if (!(flight > 0.0) || isinf(flight)) flight = 0.0;
    run->time += flight;
    for (i = 0; i < run->contacts; ++i) run->progress[i].approach += run->progress[i].velocity[0] * flight;
  }
  return on;
}

/* Marches a scene on, `steps` steps at most; returns CONTACTLAB_MARCH_GOING if there are more, else its status. */
static inline int contactlab_march_on(contactlab_march_run *run, long steps)
{
  double *room = contactlab_march_spare(run);
  const contactlab_march_end *e = run->end;
  int i, on = 1;
  for (; on; --steps) {
    const double half = 0.5 * run->width, begun = (double) run->steps + 0.5;
    double drift, greatest = 0.0;
    int going;
    if (steps <= 0) return CONTACTLAB_MARCH_GOING;
    run->width = run->step;
    if (run->lossy && begun < run->leading) run->width = run->step * (begun / run->leading);
    drift = half + 0.5 * run->width;
    ++run->steps;
    run->time += drift;
    for (i = 0; i < run->contacts; ++i) {
      run->progress[i].approach += run->progress[i].velocity[0] * drift;
      if (!run->lossy) contactlab_march_press_elastic(run, i, drift, room);
    }
    if (run->lossy) contactlab_march_press_lossy(run, drift, room);
    going = contactlab_march_kick(run, &greatest);
    if (going < 0) return CONTACTLAB_MARCH_NAN;
    on = going;
    if (!run->alone) on = contactlab_march_closes(run, going, greatest);
    if (on && (double) run->steps >= run->most) return CONTACTLAB_MARCH_LONG;
    for (i = 0; i < run->contacts && on; ++i)
      if (e[i].touches > CONTACTLAB_MARCH_OFTEN) return CONTACTLAB_MARCH_LONG;
  }
  for (i = 0; i < run->contacts; ++i)
    if (!isfinite(e[i].work + e[i].shear + e[i].normal + e[i].duration + e[i].impulse[0] + e[i].impulse[1] + e[i].impulse[2]))
      return CONTACTLAB_MARCH_NAN;
  for (i = 0; i < run->contacts && run->deepest; ++i)
    if (e[i].approach > run->deepest[i]) return CONTACTLAB_MARCH_DEEP;
  return CONTACTLAB_MARCH_DONE;
}

/* A step of a normal motion known before: drift and kick; b^2; with loss j and A, the excess and relaxation time, and
 * load and limit, mean and last friction load; without loss p, the load over that of Hertz's contact of radius b. */
typedef struct { double drift, kick, edge, load, limit, excess, time; } contactlab_march_sample;

/* What scales the steps for an impact: its slip velocity; units of drift, kick, force and relaxation time; mass; and
 * scaled displacement per metre. */
typedef struct { double velocity, drift, kick, force, time, mass, scale; } contactlab_march_impact;

/* Springs along a known normal motion in progress; `w` has CONTACTLAB_MARCH_PATH(n) numbers, all zero at first. */
typedef struct {
  contactlab_march_springs now, next;
  double change, force, work, loss, edge;
  int last;
} contactlab_march_path;

#define CONTACTLAB_MARCH_PATH(n) (16 * (size_t) CONTACTLAB_MARCH_ROW(n))

static inline void contactlab_march_path_begin(contactlab_march_path *path, int n, double *w)
{
  memset(path, 0, sizeof *path);
  memset(w, 0, CONTACTLAB_MARCH_PATH(n) * sizeof *w);
  path->now.w = w;
  path->next.w = w + 2 * CONTACTLAB_MARCH_ROW(n);
  path->now.size = 1.0;
}

/* Elastic springs in `count` steps more of a known normal motion, all lengths over the largest radius. `change` of slip
 * velocity, and scaled work, add up in the path; so does the force of each step unless `forces` is NULL. */
static inline void contactlab_march_along(int n, const contactlab_march_sample *steps, long count,
    const contactlab_march_impact *one, contactlab_march_path *path, double *forces)
{
  const double heaviest = 1.125 * 1.5 / n, whole = 1.5 / n, per = 1.0 / n;
  double *CONTACTLAB_RESTRICT w = path->now.w, *CONTACTLAB_RESTRICT slipped = path->next.w;
  long k;
  int i;
  for (k = 0; k < count; ++k) {
    const contactlab_march_sample *s = steps + k;
    const double move = (one->velocity + path->change) * (s->drift * one->drift), growth = s->edge - path->edge;
    const double span = growth > 0.0 ? growth : 1.0, least = growth > 0.0 ? 0.0 : 1.0, edge = s->edge;
    double sum, lost, squares, factor, scale, left = 0.0;
    int now = contactlab_march_held(n, per, edge), inside = CONTACTLAB_MARCH_ROW(now);
    squares = now * (4.0 * now * now - 1.0) / (12.0 * n * n);
    factor = now ? edge * sqrt(edge) / (now * edge - squares) : 0.0;
    scale = factor / heaviest;
    if (scale < 1.0) scale = 1.0;
    if (factor > heaviest) factor = heaviest;
    scale *= s->load;
    for (i = now; i < path->last; ++i) {
      left += w[i] * (w[i] + move);
      w[i] = 0.0;
    }
    for (i = 0; i < inside; ++i) {
      const double r = (i + 0.5) * per, in = edge - r * r, pos = in > 0.0 ? in : 0.0, limit = scale * pos, before = w[i];
      const double p = pos / span, q = p > 1.0 ? 1.0 : p, part = q > least ? q : least, trial = before + part * move;
      const double after = contactlab_march_clip(trial, limit);
      slipped[i] = (trial - after) * (after + before);
      w[i] = after;
    }
    lost = factor * contactlab_march_total(inside, slipped) + whole * left;
    sum = factor * contactlab_march_total(inside, w);
    if (lost > 0.0) path->work += 0.5 * lost;
    path->change -= s->kick * one->kick * sum;
    if (forces) forces[k] = sum * one->force;
    path->edge = edge;
    path->last = now;
  }
}

/* The same of springs that share the loss of the normal contact; `loss` adds up too. */
static inline void contactlab_march_along_lossy(int n, const contactlab_march_sample *steps, long count,
    const contactlab_march_impact *one, contactlab_march_path *path, double *forces)
{
  double *room = path->now.w < path->next.w ? path->now.w : path->next.w, force[2] = {path->force, 0.0};
  long k;
  room += 4 * CONTACTLAB_MARCH_ROW(n);
  for (k = 0; k < count; ++k) {
    const contactlab_march_sample *s = steps + k;
    const double drift = s->drift * one->drift, kick = s->kick * one->kick, mobility = 0.5 * kick / one->mass;
    contactlab_march_drive d;
    contactlab_march_springs other;
    double lost, gained;
    d.drift = drift;
    d.scale = one->scale;
    d.move[0] = (one->velocity + path->change) * (drift * one->scale);
    d.move[1] = d.slip[1] = d.force[1] = 0.0;
    d.acted = kick * drift > 0.0 ? 0.5 * kick / drift : 0.5;
    if (d.acted > 1.0) d.acted = 1.0;
    d.mobility = mobility;
    d.slip[0] = one->velocity + path->change - mobility * force[0];
    d.force[0] = force[0];
    d.limit = one->force * s->limit;
    d.acting = one->force * s->load;
    d.cross = 1.0;
    contactlab_march_lossy(1, n, &path->now, &path->next, s->edge, s->excess, s->time * one->time, &d, 0, room, force,
                           &lost, &gained);
    other = path->now;
    path->now = path->next;
    path->next = other;
    path->change -= 2.0 * mobility * force[0];
    if (forces) forces[k] = force[0];
    path->work += lost;
    path->loss += gained;
  }
  path->force = force[0];
}

/* d(b, V)/dx of a Kelvin-Voigt impact in scaled units (theory, section 15), dT = 2 b dx. */
static inline void contactlab_march_slope(const double *s, double a, int loads, double *d)
{
  const double cube = s[0] * s[0] * s[0];
  d[0] = loads ? s[1] : s[1] - 1.25 * a * cube;
  d[1] = -2.5 * s[0] * (loads ? cube + 1.5 * a * s[1] * s[0] : cube);
  d[2] = 2.0 * s[0];
}

/* b, V and T after so many steps of Runge and Kutta. */
static inline void contactlab_march_advance(double *s, double a, int loads, double width, int steps)
{
  int k, i;
  for (k = 0; k < steps; ++k) {
    double d1[3], d2[3], d3[3], d4[3], t[3];
    contactlab_march_slope(s, a, loads, d1);
    for (i = 0; i < 3; ++i) t[i] = s[i] + 0.5 * width * d1[i];
    contactlab_march_slope(t, a, loads, d2);
    for (i = 0; i < 3; ++i) t[i] = s[i] + 0.5 * width * d2[i];
    contactlab_march_slope(t, a, loads, d3);
    for (i = 0; i < 3; ++i) t[i] = s[i] + width * d3[i];
    contactlab_march_slope(t, a, loads, d4);
    for (i = 0; i < 3; ++i) s[i] += width / 6.0 * (d1[i] + 2.0 * (d2[i] + d3[i]) + d4[i]);
  }
}

/* The normal motion of spheres at a = A v1/(C^2 R) as `steps` samples, an even number; returns the largest b, the unit of
 * their edges. x at the ends, where V and then b vanish, are found by Newton's method from what is right to 3 %. */
static inline double contactlab_march_course(double a, long steps, contactlab_march_sample *samples)
{
  enum { TURNS = 4, LEAST = 192 };
  const long half = steps / 2;
  const int parts = (int) ((LEAST + 2 * half - 1) / (2 * half));
  double s[3] = {0.0, 1.0, 0.0}, middle = 0.0, largest = 1.0;
  int phase, turn;
  long k;
  for (phase = 0; phase < 2; ++phase) {
    const int loads = !phase;
    double end = 1.2537 * pow(1.0 + a, loads ? -0.085 : 0.78), width;
    for (turn = 0; turn < TURNS; ++turn) {
      double last[3], d[3];
      memcpy(last, s, sizeof last);
      contactlab_march_advance(last, a, loads, end / LEAST, LEAST);
      contactlab_march_slope(last, a, loads, d);
      end -= loads ? last[1] / d[1] : last[0] / d[0];
    }
    width = end / (double) (2 * half * parts);
    for (k = phase * half; k < (1 + phase) * half; ++k) {
      contactlab_march_sample *o = samples + k;
      const double rate = s[1], time = s[2];
      double b;
      contactlab_march_advance(s, a, loads, width, parts);
      b = s[0] > 0.0 ? s[0] : 0.0;
      o->drift = s[2] - middle;
      middle = s[2];
      o->edge = b * b;
      o->excess = loads && s[1] > 0.0 ? a * s[1] : 0.0;
      o->limit = b * (b * b + 1.5 * o->excess);
      o->time = a;
      contactlab_march_advance(s, a, loads, width, parts);
      o->kick = s[2] - time;
      o->load = (rate - s[1]) / (1.25 * o->kick);
    }
    if (loads) {
      s[1] = 0.0;
      largest = s[0];
    }
  }
  for (k = 0; k < steps; ++k) {
    samples[k].edge /= largest * largest;
    samples[k].excess /= largest * largest;
  }
  return largest;
}

#endif
