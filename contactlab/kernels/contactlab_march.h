/* Impacts with friction in steps, normal and tangential forces together: bodies of any shape, one contact or several.
 *
 * Hertz's contact, circular or elliptic, elastic or of Kelvin and Voigt, and springs for partial slip that share its
 * loss. The same marches as in Python (`march/together.py`, `springs/doubling.py`, `turning.py`, `viscous.py`,
 * `jaeger/step.py`), one scene after another: theory, sections 13 to 16 of `contactlab guide theory`. A scene to begin
 * with stands in README.md beside this file.
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
  CONTACTLAB_MARCH_NAN = 2,   /* a velocity, or the work of friction, is not finite */
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
#define CONTACTLAB_MARCH_PRESSED 1e-12 /* viscous excess over the square of the edge up to which it is a rounding */
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

/* Rows of springs are as long as the next multiple of 8, and springs beyond n have the limit 0: loops over rows without
 * branches, which a compiler makes instructions of several numbers of (GCC: -O3 -fno-math-errno). */
enum { CONTACTLAB_MARCH_LANES = 8 };
#define CONTACTLAB_MARCH_ROW(n) (((n) + 7) / 8 * 8)

static inline double contactlab_march_clip(double x, double limit)
{
  const double high = x > limit ? limit : x;
  return high < -limit ? -limit : high;
}

/* Excess of a force over its limit, along both axes: to the closest point in the energy of the springs. */
static inline void contactlab_march_beyond(double x, double y, double limit, double cross, double *ox, double *oy)
{
  const double square = x * x + y * y, size = sqrt(square);
  *ox = *oy = 0.0;
  if (!(square > limit * limit)) return;
  if (cross == 1.0) {
    const double k = 1.0 - limit / (size + CONTACTLAB_MARCH_TINY);
    *ox = x * k;
    *oy = y * k;
  } else {
    const double unit = 1.0 / fmax(limit, size / 1e60 + CONTACTLAB_MARCH_TINY);
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
    *ox = x - scale * u;
    *oy = y - scale * v;
  }
}

/* Excesses of a row of forces, `share` times each; the loop of a circle is one without branches. */
static inline void contactlab_march_over(int n, const double *CONTACTLAB_RESTRICT x, const double *CONTACTLAB_RESTRICT y, const double *CONTACTLAB_RESTRICT limit,
                                         double cross, double share, double *CONTACTLAB_RESTRICT ox, double *CONTACTLAB_RESTRICT oy)
{
  int i;
  if (cross == 1.0)
    for (i = 0; i < n; ++i) {
      const double far = 1.0 - limit[i] / (sqrt(x[i] * x[i] + y[i] * y[i]) + CONTACTLAB_MARCH_TINY);
      const double part = share * (far > 0.0 ? far : 0.0);
      ox[i] = x[i] * part;
      oy[i] = y[i] * part;
    }
  else
    for (i = 0; i < n; ++i) {
      contactlab_march_beyond(x[i], y[i], limit[i], cross, ox + i, oy + i);
      ox[i] *= share;
      oy[i] *= share;
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
  double lost = 0.0;
  int i, j, k;
  for (k = 0; reach > *size && k < CONTACTLAB_MARCH_DOUBLINGS; ++k) {
    for (j = 0; j < axes; ++j) {
      double *row = w + j * CONTACTLAB_MARCH_ROW(n), sum = 0.0;
      for (i = 0; i < n / 2; ++i) {
        const double d = row[2 * i] - row[2 * i + 1];
        sum += d * d;
        row[i] = 0.5 * (row[2 * i] + row[2 * i + 1]);
      }
      for (; i < n; ++i) row[i] = 0.0;
      lost += 0.25 * (*size / n) * sum / (j ? cross : 1.0);
    }
    *size *= 2.0;
  }
  return lost;
}

/* A step of springs without loss; `room` holds 3 rows. Returns the friction work. */
static inline double contactlab_march_elastic(int axes, int n, const contactlab_march_contact *c,
    contactlab_march_springs *s, const double *moved, double radius, double load, double *room, double *force)
{
  const int row = CONTACTLAB_MARCH_ROW(n);
  const double limit = c->friction * load, before = s->radius, growth = radius - before, cross = c->cross, was_steep = s->steep;
  const double mx = moved[0], my = axes == 2 ? cross * moved[1] : 0.0, b = radius <= CONTACTLAB_MARCH_TOUCH * c->radius ? 0.0 : radius;
  const double square = b * b, earlier = before * before, per_growth = growth > 0.0 ? growth : 1.0, least = growth > 0.0 ? 0.0 : 1.0;
  double *CONTACTLAB_RESTRICT x = s->w, *CONTACTLAB_RESTRICT y = s->w + row, *CONTACTLAB_RESTRICT most = room, *CONTACTLAB_RESTRICT part = room + row, *CONTACTLAB_RESTRICT lost = room + 2 * row;
  const double merged = contactlab_march_fit(axes, n, s->w, &s->size, b, cross), cell = s->size / n, stiffness = c->shear * cell;
  const double far = (b > before ? b : before) / cell + 1.0;
  double total, steep, work;
  int i, inside = row;
  if (far < n) inside = CONTACTLAB_MARCH_ROW((int) far);
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
  } else {
    for (i = 0; i < inside; ++i) {
      const double r = (i + 0.5) * cell, in = earlier - r * r, was = in > 0.0 ? in * was_steep : 0.0, m = most[i] * steep;
      const double dx = part[i] * mx, dy = part[i] * my, mid = was + CONTACTLAB_MARCH_EARLY * (m - was);
      double ux, uy, ox, oy, nx, ny;
      contactlab_march_beyond(x[i] + CONTACTLAB_MARCH_EARLY * dx, y[i] + CONTACTLAB_MARCH_EARLY * dy, mid, cross, &ux, &uy);
      nx = x[i] + dx - CONTACTLAB_MARCH_WEIGHT * ux;
      ny = y[i] + dy - CONTACTLAB_MARCH_WEIGHT * uy;
      contactlab_march_beyond(nx, ny, m, cross, &ox, &oy);
      nx -= ox;
      ny -= oy;
      lost[i] = (CONTACTLAB_MARCH_WEIGHT * ux + ox) * (x[i] + nx) + (CONTACTLAB_MARCH_WEIGHT * uy + oy) / cross * (y[i] + ny);
      x[i] = nx;
      y[i] = ny;
    }
  }
  work = 0.5 * stiffness * contactlab_march_total(inside, lost);
  force[0] = stiffness * contactlab_march_total(inside, x);
  force[1] = axes == 2 ? stiffness * contactlab_march_total(inside, y) : 0.0;
  s->radius = b;
  s->steep = steep;
  return (work > 0.0 ? work : 0.0 * work) + c->shear * merged;
}

/* Tangential motion of a step with loss, scaled but for time and force: displacement and its time, the time of the kick,
 * slip velocity, what forces change it by, mean and last friction load. */
typedef struct { double move[2], drift, kick, slip[2], mobility, acting, limit, scale, cross; } contactlab_march_drive;

/* How many of n springs an edge at b^2 holds. */
static inline int contactlab_march_held(int n, double cell, double edge)
{
  const double far = sqrt(edge > 0.0 ? edge : 0.0) / cell + 0.5;
  int k = far < n ? (int) far : n;
  while (k < n && edge - ((k + 0.5) * cell) * ((k + 0.5) * cell) > 0.0) ++k;
  while (k > 0 && !(edge - ((k - 0.5) * cell) * ((k - 0.5) * cell) > 0.0)) --k;
  return k;
}

/* Limits of n springs under an edge at b^2; returns how many it holds. */
static inline int contactlab_march_limits(int n, double cell, double edge, double excess, double *limit)
{
  const int held = contactlab_march_held(n, cell, edge);
  int i;
  for (i = 0; i < held; ++i) {
    const double r = (i + 0.5) * cell;
    limit[i] = edge - r * r + excess;
  }
  for (; i < CONTACTLAB_MARCH_ROW(n); ++i) limit[i] = 0.0;
  return held;
}

/* Moves a row of springs from `hx`, `hy` to `x`, `y` while their memory decays and their limits go from `least` to
 * `most`; `pull` is the displacement over the decay, `room` holds 5 rows. */
static inline void contactlab_march_relax(int axes, int n, double cross, double decay, const double *move, const double *pull,
    const double *CONTACTLAB_RESTRICT hx, const double *CONTACTLAB_RESTRICT hy, const double *CONTACTLAB_RESTRICT least, const double *CONTACTLAB_RESTRICT most,
    double *CONTACTLAB_RESTRICT x, double *CONTACTLAB_RESTRICT y, double *room)
{
  const int row = CONTACTLAB_MARCH_ROW(n);
  double *CONTACTLAB_RESTRICT tx = room, *CONTACTLAB_RESTRICT ty = room + row, *CONTACTLAB_RESTRICT mid = room + 2 * row;
  double *CONTACTLAB_RESTRICT ox = room + 3 * row, *CONTACTLAB_RESTRICT oy = room + 4 * row;
  const double mx = move[0], my = move[1], px = pull[0], py = pull[1];
  int i;
  if (axes == 1) {
    const double gone = -expm1(-decay), bent = 1.0 - gone / fmax(decay, CONTACTLAB_MARCH_TINY), kept = 1.0 - gone;
    for (i = 0; i < n; ++i) {
      const double h = hx[i], span = least[i] * gone + (most[i] - least[i]) * bent, free = h * kept, trial = h + mx;
      const double low = free - span, high = free + span, raised = trial < low ? low : trial;
      x[i] = raised > high ? high : raised;
    }
  } else {
    const double early = CONTACTLAB_MARCH_EARLY * decay / (1.0 + CONTACTLAB_MARCH_EARLY * decay);
    for (i = 0; i < n; ++i) {
      tx[i] = hx[i] + (CONTACTLAB_MARCH_EARLY * mx + px);
      ty[i] = hy[i] + (CONTACTLAB_MARCH_EARLY * my + py);
      mid[i] = least[i] + CONTACTLAB_MARCH_EARLY * (most[i] - least[i]);
    }
    contactlab_march_over(n, tx, ty, mid, cross, CONTACTLAB_MARCH_WEIGHT * early, ox, oy);
    for (i = 0; i < n; ++i) {
      tx[i] = (x[i] = hx[i] + mx - ox[i]) + px;
      ty[i] = (y[i] = hy[i] + my - oy[i]) + py;
    }
    contactlab_march_over(n, tx, ty, most, cross, early, ox, oy);
    for (i = 0; i < n; ++i) {
      x[i] -= ox[i];
      y[i] -= oy[i];
    }
  }
}

/* A step of springs with loss, from `s` to `out`; `room` holds 12 rows. `force` is that of the step before, or a guess.
 * `work` and `loss` are not asked for if NULL. */
static inline void contactlab_march_lossy(int axes, int n, const contactlab_march_springs *s,
    contactlab_march_springs *out, double edge, double excess, double time, const contactlab_march_drive *d, int grows,
    double *room, double *force, double *work, double *loss)
{
  const int row = CONTACTLAB_MARCH_ROW(n), grown = grows && sqrt(edge) > s->size;
  double *CONTACTLAB_RESTRICT held = room, *CONTACTLAB_RESTRICT old = room + 2 * row, *CONTACTLAB_RESTRICT least = room + 4 * row, *CONTACTLAB_RESTRICT most = room + 5 * row;
  double *CONTACTLAB_RESTRICT pulled = room + 6 * row, *CONTACTLAB_RESTRICT ox = room + 8 * row, *CONTACTLAB_RESTRICT oy = room + 9 * row, *CONTACTLAB_RESTRICT w = out->w;
  const double middle = s->time > 0.0 ? 0.5 * (s->time + time) : time, lead = time * d->scale, growth = edge - s->edge;
  const double decay = fmin(d->drift / fmax(middle, CONTACTLAB_MARCH_TINY), 1e300), cross = d->cross;
  const double turned[2] = {d->move[0], axes == 2 ? cross * d->move[1] : 0.0}, pull[2] = {turned[0] / decay, turned[1] / decay};
  double one[2], at[2] = {d->slip[0], d->slip[1]}, size = s->size, total, per, weight, cell, stiff;
  int i, k, first, count, inside, hard, turn;
  memcpy(held, s->w, (size_t) (axes * row) * sizeof *held);
  if (grown) contactlab_march_fit(axes, n, held, &size, sqrt(edge), cross);
  cell = size / n;
  first = contactlab_march_limits(n, cell, s->edge, s->excess, least);
  count = contactlab_march_limits(n, cell, edge, excess, most);
  contactlab_march_relax(axes, row, cross, decay, turned, pull, held, held + row, least, most, w, w + row, pulled);
  for (i = first; i < count; ++i) { /* springs that enter, each for its part of the step */
    const double r = (i + 0.5) * cell, part = fmin((edge - r * r) / growth, 1.0), kept = exp(-decay * (1.0 - part));
    const double begun = excess + (s->excess - excess) * part, moved[2] = {part * turned[0], part * turned[1]};
    const double h[2] = {held[i] * kept, held[row + i] * kept};
    contactlab_march_relax(axes, 1, cross, part * decay, moved, pull, h, h + 1, &begun, most + i, w + i, w + row + i, pulled);
  }
  total = contactlab_march_total(row, most);
  per = total > 0.0 ? 1.0 / total : 1.0;
  weight = d->limit * per;
  stiff = lead * d->mobility * d->acting * per;
  hard = stiff * count > CONTACTLAB_MARCH_STIFF;
  for (k = 0; k < 2; ++k) one[k] = d->acting > 0.0 ? force[k] / d->acting : 0.0;
  inside = grown ? row : CONTACTLAB_MARCH_ROW(first > count ? first : count);
  for (turn = 0; turn < (hard ? (int) CONTACTLAB_MARCH_TURNS : 1); ++turn) {
    int stuck = 0;
    out->lead[0] = lead * at[0];
    out->lead[1] = lead * cross * at[1];
    for (k = 0; k < axes; ++k)
      for (i = 0; i < inside; ++i) pulled[k * row + i] = w[k * row + i] + out->lead[k];
    for (i = 0; i < count && hard; ++i) {
      const double x = pulled[i], y = axes == 2 ? pulled[row + i] : 0.0;
      stuck += x * x + y * y < most[i] * most[i];
    }
    contactlab_march_cut(axes, inside, pulled, pulled + row, most, cross, ox, oy);
    for (k = 0; k < axes; ++k) {
      const double sum = contactlab_march_total(inside, pulled + k * row) * per;
      const double now = hard ? one[k] + (sum - one[k]) / (1.0 + stiff * stuck) : sum;
      at[k] += (one[k] - now) * d->mobility * d->acting;
      one[k] = now;
    }
  }
  if (count < (growth > 0.0 ? 1 : 2)) { /* smaller than a cell: of its edge, of its middle if it leaves, or as it was */
    const int grew = growth > 0.0, known = grew ? excess > CONTACTLAB_MARCH_PRESSED * edge : edge > 0.0;
    const double x = grew ? lead * d->slip[0] : w[0] + out->lead[0], y = axes < 2 ? 0.0 : grew ? lead * cross * d->slip[1] : w[row] + out->lead[1];
    const double b = sqrt(edge), limit = edge + excess, far = sqrt(x * x + y * y), c = sqrt(fmin(fmax(limit - far, 0.0), edge));
    const double slips = fmin(fmax(far - excess, 0.0), edge) / fmax(b + c, CONTACTLAB_MARCH_TINY), sum = far * c + slips * (limit - (edge + b * c + c * c) / 3.0);
    const double all = grew ? fmax(far, excess) : far * b * (limit - edge / 3.0) / fmax(sum, CONTACTLAB_MARCH_TINY);
    for (k = 0; k < 2; ++k) one[k] = !known ? s->share[k] : far > 0.0 ? (k ? y : x) / all : 0.0;
  }
  if (work) {
    const double acted = d->kick * d->drift > 0.0 ? fmin(0.5 * d->kick / d->drift, 1.0) : 0.5;
    const double earlier = (1.0 - acted) * (size / s->size) * s->weight, later = acted * weight;
    double unit = s->size, gained = 0.0, lost = 0.0;
    if (grown) contactlab_march_limits(n, unit / n, s->edge, s->excess, least);
    for (k = 0; k < axes; ++k)
      for (i = 0; i < inside; ++i) old[k * row + i] = s->w[k * row + i] + s->lead[k];
    contactlab_march_cut(axes, inside, old, old + row, least, cross, ox, oy);
    if (grown) contactlab_march_fit(axes, n, old, &unit, sqrt(edge), cross);
    for (k = 0; k < axes; ++k) {
      for (i = 0; i < inside; ++i) {
        ox[i] = earlier * old[k * row + i] + later * pulled[k * row + i];
        oy[i] = ox[i] * (w[k * row + i] - held[k * row + i]);
      }
      for (i = first; i < count; ++i) { /* as if they had moved all the time: the force is the mean of the step */
        const double r = (i + 0.5) * cell;
        oy[i] /= fmax(fmin((edge - r * r) / growth, 1.0), CONTACTLAB_MARCH_TINY);
      }
      gained += contactlab_march_total(inside, oy) / (k ? cross : 1.0);
      lost += contactlab_march_total(inside, ox) * d->move[k];
    }
    *work = lost - gained;
    if (!(*work > 0.0)) *work = 0.0 * *work;
    *loss = gained;
  }
  for (k = 0; k < 2; ++k) {
    out->share[k] = one[k];
    force[k] = d->acting * one[k];
  }
  out->size = size;
  out->edge = edge;
  out->excess = excess;
  out->time = time;
  out->weight = weight;
}

/* Normal force and radius of a Kelvin-Voigt contact, and its edge b and excess j in units of the grid and of Hertz's load;
 * returns 0 out of contact. */
static inline int contactlab_march_press(const contactlab_march_contact *c, double approach, double rate, double *force,
                                         double *radius, double *edge, double *excess)
{
  const double stiffness = (4.0 / 3.0) * c->modulus * sqrt(c->radius), a = c->span;
  const double inside = approach > 0.0 ? approach : 0.0, lead = c->time * rate;
  double in = inside + (lead < 0.0 ? lead : 0.0), b, load, j;
  if (!(in > 0.0)) in = 0.0 * (approach + rate);
  *force = stiffness * sqrt(in) * (1.5 * (inside + lead) - 0.5 * in);
  *radius = sqrt(c->radius * in);
  if (*force <= 0.0) *force = *radius = 0.0;
  b = *radius / a;
  load = *force / ((4.0 / 3.0) * c->modulus * a * a * a / c->radius);
  j = b > 0.0 ? (load - b * b * b) / (1.5 * (b + CONTACTLAB_MARCH_TINY)) : 0.0;
  *edge = j < 0.0 ? cbrt(load) : b;
  *excess = j > 0.0 ? j : 0.0;
  return !(*force <= 0.0);
}

/* A contact in progress. */
typedef struct {
  contactlab_march_springs now, next;
  const double *own; /* block of W of the contact itself */
  double velocity[3], kick[3], force[3], approach, radius, tried[2], work, shear;
  int touching, touched;
} contactlab_march_progress;

/* What is marched. W tells how forces at contacts move contacts: blocks of 3 x 3 that are not zero, by rows as of a
 * compressed sparse matrix, the block of a contact itself among them. */
typedef struct {
  int contacts;
  const contactlab_march_contact *c; /* of each contact */
  const int *row, *column;           /* starts of rows, contacts + 1; the column of each block */
  const double *block;               /* 9 numbers each */
  int axes, springs; /* 1: slip along t1 only, or 2; an even number */
  int lossy; /* 0: elastic; 1: Kelvin-Voigt bodies, whose relaxation times may be zero */
  int alone; /* 1: one contact that touches, to its end; 0: they open and close, until none closes and none holds a force */
  double step, leading, most;  /* width of steps in s; with loss so many grow evenly at first; most steps */
  const double *deepest;       /* approach in m of each contact beyond which steps do not resolve it, or NULL */
  contactlab_march_progress *progress; /* of each contact */
  double *work;                        /* CONTACTLAB_MARCH_WORK(contacts, springs) numbers */
  contactlab_march_end *end; /* of each contact; as the last step left it where the status is not 0 */
} contactlab_march_scene;

/* A scene in progress. */
typedef struct {
  contactlab_march_scene scene;
  double time, width, *room; /* room: work space beside the springs */
  long steps;
  int pulled; /* 1: constant forces act */
} contactlab_march_run;

/* Whether all that a scene is made of has a meaning. */
static inline int contactlab_march_sound(const contactlab_march_scene *s)
{
  int i, k, m;
  if (s->contacts < 1 || (s->alone && s->contacts > 1) || (s->axes != 1 && s->axes != 2) || s->springs < 2
      || s->springs % 2 || !(s->step > 0.0) || !(s->step < INFINITY) || !(s->most >= 1.0) || !(s->most < INFINITY)) return 0;
  for (i = 0; i < s->contacts; ++i) {
    const contactlab_march_contact *o = s->c + i;
    double sum = o->speed;
    for (k = 0; k < 3; ++k) sum += o->velocity[k] + o->pull[k];
    if (!isfinite(sum) || !(o->gap >= 0.0) || !(o->friction >= 0.0) || !(o->radius > 0.0) || !(o->modulus > 0.0)
        || !(o->shear >= 0.0) || !(o->cross > 0.0) || !(o->span > 0.0) || !(o->time >= 0.0) || !(o->share >= 0.0)
        || !isfinite(o->gap + o->friction + o->radius + o->modulus + o->shear + o->cross + o->span + o->time + o->share)) return 0;
    for (k = 0, m = s->row[i]; m < s->row[i + 1]; ++m) {
      if (s->column[m] < 0 || s->column[m] >= s->contacts) return 0;
      k |= s->column[m] == i;
    }
    if (!k) return 0;
  }
  return s->row[0] == 0;
}

/* The rate of approach to try next; `answer` is what the last one gave, and is tried itself at first. By secants, as a dashpot answers a rate by so
 * much less of it that the plain iteration may run away. */
static inline double contactlab_march_nearer(contactlab_march_progress *p, int turn, double answer)
{
  const double change = p->tried[1] - p->tried[0];
  double slope = (answer - p->tried[1]) / (change + (change == 0.0));
  if (turn < 2) return p->tried[turn] = answer;
  if (slope > 0.0) slope = 0.0;
  return p->tried[1] + (answer - p->tried[1]) / (1.0 - slope);
}

static inline void contactlab_march_swap(contactlab_march_springs *one, contactlab_march_springs *other)
{
  const contactlab_march_springs kept = *one;
  *one = *other;
  *other = kept;
}

/* Forces of a lossy contact where it moves at the rates `at`, by a displacement along the surface; in the `last` of several
 * turns its friction work and loss too, and its springs move on. */
static inline void contactlab_march_drag(const contactlab_march_run *run, int i, const double *at, const double *moved,
                                         double mobility, double drift, int last)
{
  const contactlab_march_contact *c = run->scene.c + i;
  contactlab_march_progress *p = run->scene.progress + i;
  const double a = c->span, slip = c->friction * a * a / (c->shear / (2.0 * c->modulus) * c->radius);
  const double rate = fmax(fabs(at[0]), CONTACTLAB_MARCH_SLOWEST * c->speed);
  const double scale = c->friction > 0.0 ? 1.0 / slip : 0.0;
  double edge, excess, push, aside[3];
  contactlab_march_press(c, p->approach, rate, aside, aside + 1, aside + 2, &push);
  p->touching = contactlab_march_press(c, p->approach, at[0], p->force, &p->radius, &edge, &excess);
  {
    const double time = c->share * (push * (a * a) / (c->radius * rate)), acting = c->friction * p->force[0];
    const contactlab_march_drive d = {{moved[0] * scale, moved[1] * scale}, drift, run->width, {at[1], at[2]}, mobility,
                                      acting, acting, scale, c->cross};
    contactlab_march_lossy(run->scene.axes, run->scene.springs, &p->now, &p->next, edge * edge, excess, time, &d, 1, run->room,
                           p->force + 1, last ? &p->work : NULL, &p->shear);
  }
  if (!last) return;
  if (c->friction > 0.0) {
    p->work *= slip;
    p->shear *= slip;
  }
  contactlab_march_swap(&p->now, &p->next);
}

/* Velocities in a step by forces at the contacts and by constant forces. */
static inline void contactlab_march_kicked(const contactlab_march_run *run)
{
  const contactlab_march_scene *s = &run->scene;
  int i, j, k, m;
  for (i = 0; i < s->contacts; ++i) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (m = s->row[i]; m < s->row[i + 1]; ++m) {
      const double *W = s->block + 9 * (size_t) m, *f = s->progress[s->column[m]].force;
      for (j = 0; j <= s->axes; ++j) {
        double each = 0.0;
        for (k = 0; k <= s->axes; ++k) each += W[3 * j + k] * f[k];
        sum[j] += each;
      }
    }
    for (j = 0; j <= s->axes; ++j) s->progress[i].kick[j] = run->width * (sum[j] - s->c[i].pull[j]);
  }
}

/* Forces of a step of an elastic contact. */
static inline void contactlab_march_push(const contactlab_march_run *run, int i, double drift)
{
  const contactlab_march_contact *c = run->scene.c + i;
  contactlab_march_progress *p = run->scene.progress + i;
  const double x = p->approach > 0.0 ? p->approach : 0.0;
  const double moved[2] = {p->velocity[1] * drift, p->velocity[2] * drift};
  p->radius = sqrt(c->radius * x);
  p->force[0] = (4.0 / 3.0) * c->modulus * p->radius * x;
  p->touching = p->approach > 0.0;
  if (p->touching || p->touched)
    p->work = contactlab_march_elastic(run->scene.axes, run->scene.springs, c, &p->now, moved, p->radius, p->force[0],
                                       run->room, p->force + 1);
  else p->work = p->force[1] = p->force[2] = 0.0;
}

/* Lays a contact where its force at rest carries the constant forces: its springs are without tension, or at their limit
 * along the slip if it slides. */
static inline void contactlab_march_lay(contactlab_march_run *run, int i)
{
  const contactlab_march_contact *c = run->scene.c + i;
  contactlab_march_progress *p = run->scene.progress + i;
  contactlab_march_end *e = run->scene.end + i;
  const double load = fmax(c->pull[0], 0.0) / p->own[0], still[3] = {0.0, 0.0, 0.0};
  const double root = cbrt(load / ((4.0 / 3.0) * c->modulus * sqrt(c->radius)));
  const double speed = sqrt(p->velocity[1] * p->velocity[1] + p->velocity[2] * p->velocity[2]);
  const double reach = speed > CONTACTLAB_MARCH_SLIDES * c->speed ? c->friction * sqrt(c->radius) * root / speed : 0.0;
  int pressed;
  p->approach = root * root;
  p->touched = p->touching = 1;
  for (pressed = 0; pressed < 2; ++pressed) {
    const double far = pressed ? reach : 0.0, moved[2] = {far * p->velocity[1], far * p->velocity[2]};
    if (run->scene.lossy) contactlab_march_drag(run, i, still, moved, 0.0, run->width, 1);
    else contactlab_march_push(run, i, far);
  }
  p->force[0] = load;
  p->force[1] = p->force[2] = 0.0;
  p->touching = 1;
  e->touches = 1.0;
  e->first = e->last = 0.0;
}

/* Begins a scene; returns CONTACTLAB_MARCH_GOING, or CONTACTLAB_MARCH_INPUT. */
static inline int contactlab_march_begin(contactlab_march_run *run, const contactlab_march_scene *scene)
{
  const size_t width = CONTACTLAB_MARCH_ROW(scene->springs);
  int i, k;
  memset(run, 0, sizeof *run);
  if (!contactlab_march_sound(scene)) return CONTACTLAB_MARCH_INPUT;
  run->scene = *scene;
  run->width = scene->step;
  run->room = scene->work + 4 * width * (size_t) scene->contacts;
  memset(scene->end, 0, (size_t) scene->contacts * sizeof *scene->end);
  memset(scene->work, 0, CONTACTLAB_MARCH_WORK(scene->contacts, scene->springs) * sizeof *scene->work);
  memset(scene->progress, 0, (size_t) scene->contacts * sizeof *scene->progress);
  for (i = 0; i < scene->contacts; ++i) {
    const contactlab_march_contact *c = scene->c + i;
    contactlab_march_progress *p = scene->progress + i;
    scene->end[i].compressions = 1.0;
    scene->end[i].first = scene->end[i].last = NAN;
    for (k = scene->row[i]; scene->column[k] != i; ++k) {}
    p->own = scene->block + 9 * (size_t) k;
    p->now.w = scene->work + 4 * width * (size_t) i;
    p->next.w = p->now.w + 2 * width;
    p->now.size = scene->lossy ? 1.05 : 1.05 * c->span;
    p->approach = -c->gap;
    for (k = 0; k <= scene->axes; ++k) {
      p->velocity[k] = c->velocity[k];
      if (c->pull[k] != 0.0) run->pulled = 1;
    }
    if (c->loaded > 0.0) contactlab_march_lay(run, i);
  }
  run->width = 0.0;
  return CONTACTLAB_MARCH_GOING;
}

/* Forces of a step of all contacts with loss. */
static inline void contactlab_march_press_lossy(const contactlab_march_run *run, double drift)
{
  int turn, i, k;
  for (turn = 0; turn < (int) CONTACTLAB_MARCH_TURNS; ++turn) {
    contactlab_march_kicked(run);
    for (i = 0; i < run->scene.contacts; ++i) {
      contactlab_march_progress *p = run->scene.progress + i;
      const double *W = p->own, moved[2] = {p->velocity[1] * drift, p->velocity[2] * drift};
      const double mobility = 0.5 * run->width * (run->scene.axes == 1 ? W[4] : 0.5 * (W[4] + W[8]));
      double at[3];
      for (k = 0; k < 3; ++k) at[k] = p->velocity[k] - 0.5 * p->kick[k];
      at[0] = contactlab_march_nearer(p, turn, at[0]);
      contactlab_march_drag(run, i, at, moved, mobility, drift, turn + 1 == CONTACTLAB_MARCH_TURNS);
    }
  }
}

/* Velocities after a step, and what it adds to the end; returns 1 while a contact touches, -1 if a velocity is not finite. */
static inline int contactlab_march_kick(contactlab_march_run *run, double *greatest)
{
  int i, k, going = 0;
  contactlab_march_kicked(run);
  for (i = 0; i < run->scene.contacts; ++i) {
    contactlab_march_progress *p = run->scene.progress + i;
    contactlab_march_end *e = run->scene.end + i;
    double sum = 0.0;
    e->work += p->work;
    e->shear += p->shear;
    if (p->touching) {
      if (run->scene.lossy) e->normal += p->force[0] * (p->velocity[0] - 0.5 * p->kick[0]) * run->width;
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
    } else if (!run->scene.lossy && run->scene.alone) e->duration = run->time - p->approach / p->velocity[0];
    e->closed = p->touched = p->touching;
    if (run->pulled) e->pushed += run->width;
    for (k = 0; k <= run->scene.axes; ++k) {
      e->change[k] -= p->kick[k];
      p->velocity[k] = run->scene.c[i].velocity[k] + e->change[k];
      sum += p->velocity[k];
    }
    if (p->touching && p->velocity[0] > 0.0 && p->velocity[0] + p->kick[0] <= 0.0) e->compressions += 1.0;
    if (!isfinite(sum)) return -1;
    *greatest = fmax(*greatest, e->force);
  }
  return going;
}

/* Whether contacts are to come or to end; time without contact passes. */
static inline int contactlab_march_closes(contactlab_march_run *run, int going, double greatest)
{
  double least = INFINITY;
  int i, on = 0;
  for (i = 0; i < run->scene.contacts; ++i) {
    const contactlab_march_progress *p = run->scene.progress + i;
    const int closes = p->velocity[0] > CONTACTLAB_MARCH_CLOSING * run->scene.c[i].speed;
    const int holds = (closes || p->force[0] > CONTACTLAB_MARCH_HOLDS * greatest) && !(run->scene.c[i].loaded > 0.0);
    if (p->touching ? holds : closes) on = 1;
    if (!p->touching && closes) least = fmin(least, -p->approach / p->velocity[0]);
  }
  least -= CONTACTLAB_MARCH_BEFORE * run->width;
  if (on && !going && !run->pulled && least > 0.0 && least < INFINITY) {
    run->time += least;
    for (i = 0; i < run->scene.contacts; ++i) run->scene.progress[i].approach += run->scene.progress[i].velocity[0] * least;
  }
  return on;
}

/* Marches a scene on, `steps` steps at most; returns CONTACTLAB_MARCH_GOING if there are more, else its status. */
static inline int contactlab_march_on(contactlab_march_run *run, long steps)
{
  const contactlab_march_end *e = run->scene.end;
  int i, on = 1;
  for (; on; --steps) {
    const double half = 0.5 * run->width, begun = (double) run->steps + 0.5;
    double drift, greatest = 0.0;
    int going;
    if (steps <= 0) return CONTACTLAB_MARCH_GOING;
    run->width = run->scene.step;
    if (run->scene.lossy && begun < run->scene.leading) run->width = run->scene.step * (begun / run->scene.leading);
    drift = half + 0.5 * run->width;
    ++run->steps;
    run->time += drift;
    for (i = 0; i < run->scene.contacts; ++i) {
      run->scene.progress[i].approach += run->scene.progress[i].velocity[0] * drift;
      if (!run->scene.lossy) contactlab_march_push(run, i, drift);
    }
    if (run->scene.lossy) contactlab_march_press_lossy(run, drift);
    going = contactlab_march_kick(run, &greatest);
    if (going < 0) return CONTACTLAB_MARCH_NAN;
    on = run->scene.alone ? going : contactlab_march_closes(run, going, greatest);
    if (on && (double) run->steps >= run->scene.most) return CONTACTLAB_MARCH_LONG;
    for (i = 0; i < run->scene.contacts && on; ++i)
      if (e[i].touches > CONTACTLAB_MARCH_OFTEN) return CONTACTLAB_MARCH_LONG;
  }
  for (i = 0; i < run->scene.contacts; ++i)
    if (!isfinite(e[i].work + e[i].shear + e[i].normal + e[i].duration + e[i].impulse[0] + e[i].impulse[1] + e[i].impulse[2]))
      return CONTACTLAB_MARCH_NAN;
  for (i = 0; i < run->scene.contacts && run->scene.deepest; ++i)
    if (e[i].approach > run->scene.deepest[i]) return CONTACTLAB_MARCH_DEEP;
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
  double change, force, work, loss, edge, *room;
  int last;
} contactlab_march_path;

#define CONTACTLAB_MARCH_PATH(n) (16 * (size_t) CONTACTLAB_MARCH_ROW(n))

static inline void contactlab_march_path_begin(contactlab_march_path *path, int n, double *w)
{
  memset(path, 0, sizeof *path);
  memset(w, 0, CONTACTLAB_MARCH_PATH(n) * sizeof *w);
  path->now.w = w;
  path->next.w = w + 2 * CONTACTLAB_MARCH_ROW(n);
  path->room = w + 4 * CONTACTLAB_MARCH_ROW(n);
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
  double force[2] = {path->force, 0.0};
  long k;
  for (k = 0; k < count; ++k) {
    const contactlab_march_sample *s = steps + k;
    const double drift = s->drift * one->drift, kick = s->kick * one->kick, mobility = 0.5 * kick / one->mass;
    const double rate = one->velocity + path->change;
    const contactlab_march_drive d = {{rate * (drift * one->scale), 0.0}, drift, kick, {rate - mobility * force[0], 0.0},
                                      mobility, one->force * s->load, one->force * s->limit, one->scale, 1.0};
    double lost, gained;
    contactlab_march_lossy(1, n, &path->now, &path->next, s->edge, s->excess, s->time * one->time, &d, 0, path->room, force,
                           &lost, &gained);
    contactlab_march_swap(&path->now, &path->next);
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
  static const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  int i, j;
  while (steps--) {
    double d[3] = {0.0, 0.0, 0.0}, sum[3] = {0.0, 0.0, 0.0}, at[3];
    for (j = 0; j < 4; ++j) {
      for (i = 0; i < 3; ++i) at[i] = s[i] + part[j] * width * d[i];
      contactlab_march_slope(at, a, loads, d);
      for (i = 0; i < 3; ++i) sum[i] += weight[j] * d[i];
    }
    for (i = 0; i < 3; ++i) s[i] += width / 6.0 * sum[i];
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
  int loads, turn;
  long k;
  for (loads = 1; loads >= 0; --loads) {
    double end = 1.2537 * pow(1.0 + a, loads ? -0.085 : 0.78), width;
    for (turn = 0; turn < TURNS; ++turn) {
      double last[3] = {s[0], s[1], s[2]}, d[3];
      contactlab_march_advance(last, a, loads, end / LEAST, LEAST);
      contactlab_march_slope(last, a, loads, d);
      end -= loads ? last[1] / d[1] : last[0] / d[0];
    }
    width = end / (double) (2 * half * parts);
    for (k = loads ? 0 : half; k < (loads ? half : steps); ++k) {
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
