/* Random scenes by contactlab_march.h, half of them of numbers that no bodies have: "march COUNT SEED".
 *
 * Prints how many scenes ended with each status; how many that were done have a number that is not finite; and of sane
 * scenes the largest gain of energy, and imbalance of its books, over the sum of what impulses move. As many impacts
 * along known motions follow. */
#include <stdio.h>
#include <stdlib.h>

#include "contactlab_march.h"

enum { MOST = 4, SPRINGS = 16 };
static unsigned long long state = 88172645463325252ULL;

static double uniform(double low, double high)
{
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return low + (high - low) * ((double) (state >> 11) / 9007199254740992.0);
}

static int chance(double share) { return uniform(0.0, 1.0) < share; }
static double power(double low, double high) { return pow(10.0, uniform(low, high)); }

static double odd(double usual)
{
  const double strange[] = {NAN, INFINITY, -INFINITY, 0.0, -usual, 1e300, 1e-300, 5e-324, -1e300};
  return chance(0.04) ? strange[(int) uniform(0.0, 9.0)] : usual;
}

/* W of bodies: J J^T, in blocks; some numbers odd if `wild`. */
static void inverse_mass(int contacts, int wild, double *W)
{
  const int rank = 3 * contacts + (int) uniform(0.0, 6.0);
  const double unit = wild ? power(-30.0, 30.0) : power(-3.0, 3.0);
  double J[3 * MOST][3 * MOST + 6];
  int i, j, r;
  for (i = 0; i < 3 * contacts; ++i)
    for (r = 0; r < rank; ++r) J[i][r] = uniform(-1.0, 1.0);
  for (i = 0; i < 3 * contacts; ++i)
    for (j = 0; j < 3 * contacts; ++j) {
      double sum = 0.0;
      for (r = 0; r < rank; ++r) sum += J[i][r] * J[j][r];
      W[9 * ((i / 3) * contacts + j / 3) + 3 * (i % 3) + j % 3] = unit * (wild ? odd(sum) : sum);
    }
}

/* A contact at a speed; returns Hertz's duration, and its approach. */
static double contact(contactlab_march_contact *c, const double *W, double speed, int wild, int first, double *approach)
{
  const double modulus = wild ? power(0.0, 20.0) : power(6.0, 12.0), radius = wild ? power(-20.0, 10.0) : power(-4.0, 0.0);
  const double x = pow(speed * speed / (fabs(W[0]) + 1e-200) * 15.0 / 16.0 / (modulus * sqrt(radius)), 0.4);
  double *number = (double *) c;
  int i;
  memset(c, 0, sizeof *c);
  c->velocity[0] = first || chance(0.6) ? speed : 0.0;
  c->velocity[1] = speed * uniform(-2.0, 2.0);
  c->velocity[2] = speed * uniform(-2.0, 2.0);
  c->gap = first || chance(0.5) ? 0.0 : x * uniform(0.0, 1.0);
  c->friction = chance(0.1) ? 0.0 : wild ? power(-6.0, 6.0) : power(-2.0, 0.3);
  c->radius = radius;
  c->modulus = modulus;
  c->shear = 2.0 * modulus * uniform(0.5, 1.5);
  c->cross = chance(0.5) ? 1.0 : uniform(0.6, 1.6);
  c->span = sqrt(radius * x);
  c->speed = speed;
  c->time = chance(0.2) ? 0.0 : x / speed * (wild ? power(-8.0, 3.0) : power(-3.0, 0.0));
  c->share = chance(0.7) ? 1.0 : uniform(0.0, 4.0);
  c->loaded = chance(0.2);
  for (i = 0; i < 3; ++i)
    if (c->loaded > 0.0) c->pull[i] = speed / (x / speed) * power(-6.0, -2.0) * (i ? uniform(-1.0, 1.0) : 1.0);
  for (i = 0; wild && i < (int) (sizeof *c / sizeof *number); ++i) number[i] = odd(number[i]);
  *approach = x;
  return 2.94 * x / speed;
}

/* The fastest oscillation, by the sums of rows. */
static double fastest(int contacts, const contactlab_march_contact *c, const double *W)
{
  double most = 0.0;
  int i, j, k;
  for (i = 0; i < 3 * contacts; ++i) {
    double sum = 0.0;
    for (j = 0; j < contacts; ++j) {
      const double *w = W + 9 * ((i / 3) * contacts + j) + 3 * (i % 3), reach = 3.0 * c[j].span;
      for (k = 0; k < 3; ++k)
        sum += fabs(w[k]) * reach * (k == 0 ? 2.0 * fabs(c[j].modulus) : k == 1 ? c[j].shear : c[j].shear * c[j].cross);
    }
    most = fmax(most, sum);
  }
  return sqrt(most);
}

/* An impact along a known motion, as by `rebound` beside its table, or along samples that no motion has. Returns whether a
 * sane one has no answer. */
static int path(int wild, int lossy)
{
  enum { STEPS = 40 };
  const int springs = 1 + (int) uniform(0.0, SPRINGS);
  const long steps = 2 * (1 + (long) uniform(0.0, STEPS / 2));
  const double psi1 = uniform(-6.0, 6.0), chi = wild ? power(-20.0, 20.0) : power(-1.0, 2.0), a = wild ? odd(power(-20.0, 20.0)) : power(-3.0, 1.0);
  contactlab_march_sample samples[STEPS];
  contactlab_march_impact one = {psi1, 1.0, 1.0, 1.0, 1.0, 1.0 / (2.5 * chi), 1.0};
  contactlab_march_path progress;
  double work[CONTACTLAB_MARCH_PATH(SPRINGS)], forces[STEPS], largest;
  long first = 1 + (long) uniform(0.0, (double) steps - 1.0);
  size_t i;
  memset(samples, 0, sizeof samples);
  largest = contactlab_march_course(a, steps, samples);
  one.scale = 1.0 / (largest * largest);
  for (i = 0; wild && i < (size_t) steps * sizeof *samples / sizeof(double); ++i) ((double *) samples)[i] = odd(((double *) samples)[i]);
  for (i = 0; wild && i < sizeof one / sizeof(double); ++i) ((double *) &one)[i] = odd(((double *) &one)[i]);
  if (!lossy)
    for (i = 0; i < (size_t) steps; ++i) samples[i].load = 1.0;
  contactlab_march_path_begin(&progress, springs, work);
  for (i = 0; i < 2; ++i) {
    const long from = i ? first : 0, count = i ? steps - first : first;
    if (lossy) contactlab_march_along_lossy(springs, samples + from, count, &one, &progress, forces);
    else contactlab_march_along(springs, samples + from, count, &one, &progress, forces);
  }
  return !wild && !(isfinite(progress.change + progress.loss) && progress.work >= 0.0);
}

/* The status of a lossy contact; the unit of its slip overflows with a span of 1e300, and vanishes with bodies that yield
 * without end. Friction is not to be left out silently. */
static int unscaled(double span, double modulus)
{
  const double W[9] = {1.0, 0.0, 0.0, 0.0, 3.5, 0.0, 0.0, 0.0, 3.5}, deepest = INFINITY;
  const int row[2] = {0, 1}, column[1] = {0};
  contactlab_march_contact c;
  contactlab_march_progress progress;
  contactlab_march_end end;
  contactlab_march_run run;
  double work[CONTACTLAB_MARCH_WORK(1, SPRINGS)];
  const contactlab_march_scene scene = {1, &c, row, column, W, 2, SPRINGS, 1, 1, 0.01, 0.0, 1000.0, &deepest, &progress, work, &end};
  int status;
  memset(&c, 0, sizeof c);
  c.velocity[0] = c.velocity[1] = c.radius = c.shear = c.cross = c.speed = c.share = 1.0;
  c.friction = 0.3;
  c.time = 0.1;
  c.span = span;
  c.modulus = modulus;
  status = contactlab_march_begin(&run, &scene);
  while (status == CONTACTLAB_MARCH_GOING) status = contactlab_march_on(&run, 100);
  return status;
}

int main(int argc, char **argv)
{
  const long count = argc > 1 ? atol(argv[1]) : 1000;
  long ended[6] = {0}, wrong = 0, n;
  double gain = 0.0, books = 0.0;
  if (argc > 2) state ^= (unsigned long long) atol(argv[2]) * 2654435761ULL;
  for (n = 0; n < count; ++n) {
    const int contacts = chance(0.4) ? 1 : 1 + (int) uniform(0.0, MOST), wild = chance(0.5), lossy = chance(0.5);
    const int axes = contacts > 1 || chance(0.6) ? 2 : 1, springs = wild && chance(0.02) ? 3 : 2 * (1 + (int) uniform(0.0, 8.0));
    const double speed = wild ? power(-20.0, 20.0) : power(-2.0, 2.0);
    contactlab_march_contact c[MOST];
    contactlab_march_progress progress[MOST];
    contactlab_march_end end[MOST];
    contactlab_march_run run;
    double W[9 * MOST * MOST], deepest[MOST], work[CONTACTLAB_MARCH_WORK(MOST, SPRINGS)], duration = 1e300, step, most = 0.0;
    int row[MOST + 1], column[MOST * MOST], i, k, status;
    for (i = 0; i <= contacts; ++i) row[i] = i * contacts;
    for (i = 0; i < contacts * contacts; ++i) column[i] = i % contacts;
    inverse_mass(contacts, wild, W);
    for (i = 0; i < contacts; ++i) {
      duration = fmin(duration, contact(c + i, W + 9 * (i * contacts + i), speed, wild, i == 0, deepest + i));
      deepest[i] *= 1e4;
      most = fmax(most, c[i].velocity[0]);
    }
    for (i = 0; !wild && i < contacts; ++i) c[i].speed = most;
    step = wild ? odd(duration / 20.0) : fmin(duration / 60.0, 0.5 / fastest(contacts, c, W));
    {
      const contactlab_march_scene scene = {contacts, c, row, column, W, axes, springs, lossy, contacts == 1 && chance(0.7), step, 8.0, 1000.0, deepest,
                                            progress, work, end};
      status = contactlab_march_begin(&run, &scene);
    }
    while (status == CONTACTLAB_MARCH_GOING) status = contactlab_march_on(&run, 1 + (long) uniform(0.0, 500.0));
    ++ended[status];
    if (status == CONTACTLAB_MARCH_DONE) {
      double taken = 0.0, lost = 0.0, scale = 0.0, sum = 0.0;
      int pulled = 0;
      for (i = 0; i < contacts; ++i) {
        const contactlab_march_end *e = end + i;
        pulled |= c[i].loaded > 0.0; /* constant forces do work beside */
        for (k = 0; k <= axes; ++k) {
          taken += e->impulse[k] * (c[i].velocity[k] + 0.5 * e->change[k]);
          scale += fabs(e->impulse[k]) * (fabs(c[i].velocity[k]) + fabs(e->change[k]));
          sum += e->change[k];
        }
        lost += e->work + e->shear + e->normal;
        sum += e->duration + e->radius + e->approach + e->force;
      }
      if (!isfinite(sum + lost)) ++wrong;
      if (!wild && !pulled) {
        gain = fmax(gain, -taken / scale);
        books = fmax(books, fabs(taken - lost) / scale);
      }
    }
  }
  wrong += unscaled(1.0, 1.0) != CONTACTLAB_MARCH_DONE;
  wrong += unscaled(1e300, 1.0) != CONTACTLAB_MARCH_NAN;
  wrong += unscaled(1.0, 5e-324) != CONTACTLAB_MARCH_NAN;
  for (n = 0; n < count; ++n) wrong += path(chance(0.5), chance(0.7));
  for (n = 0; n < 5; ++n) printf("%ld ", ended[n]);
  printf("%ld %.3e %.3e\n", wrong, gain, books);
  return 0;
}
