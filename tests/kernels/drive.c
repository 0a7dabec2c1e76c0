/* Drives the C kernel along motions from a file of doubles, and writes forces and works.
 *
 * drive IN OUT: IN begins with n, steps, unit, modulus, time; each step is moved[3], normal[3], radius, limit,
 * and, where time is not 0, elastic, damping, velocity[3].
 * drive time n steps damping: prints the processor time in ns of a step of contacts that grow, slip and shrink.
 */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "contactlab_springs.h"

typedef CONTACTLAB_REAL real;

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double) now.tv_sec + 1e-9 * (double) now.tv_nsec;
}

static int measure(int n, int steps, real damping)
{
  enum { CONTACTS = 64 };
  const real normal[3] = {0, 0, 1};
  real sum = 0, *states = (real *) calloc((size_t) CONTACTS * (size_t) CONTACTLAB_SPRINGS_STATE(n), sizeof(real));
  double least = 1e300;
  int repeat, i, c;
  if (!states) return 1;
  for (repeat = 0; repeat < 5; ++repeat) {
    const double start = seconds();
    for (i = 1; i <= steps; ++i) {
      const real phase = ((real) (i % 50) + (real) 0.5) / 50; /* 50 steps a contact */
      const real radius = (real) 0.01 * (real) sqrt((double) (4 * phase * (1 - phase)));
      const real limit = radius * radius * radius;
      for (c = 0; c < CONTACTS; ++c) {
        const real moved[3] = {(real) 1e-6 * (real) (c % 7 - 3), (real) 1e-6 * phase, 0};
        real force[3];
        real *state = states + (size_t) c * (size_t) CONTACTLAB_SPRINGS_STATE(n);
        if (damping > 0) {
          const real elastic = limit * ((real) 0.8 + (real) 0.4 * phase);
          contactlab_springs_damped_step(state, n, moved, normal, radius, limit, 1, 1, force, elastic,
                                         damping * radius, moved, 1);
        } else contactlab_springs_step(state, n, moved, normal, radius, limit, 1, 1, force);
        sum += force[0];
      }
    }
    if (seconds() - start < least) least = seconds() - start;
  }
  printf("%.1f %g\n", 1e9 * least / steps / CONTACTS, (double) sum);
  free(states);
  return 0;
}

int main(int count, char **words)
{
  double head[5], row[13] = {0};
  real *state;
  FILE *in, *out;
  int i, step, n;
  if (count == 5 && !strcmp(words[1], "time"))
    return measure(atoi(words[2]), atoi(words[3]), (real) atof(words[4]));
  if (count != 3 || !(in = fopen(words[1], "rb"))) return 2;
  if (!(out = fopen(words[2], "wb")) || fread(head, sizeof(double), 5, in) != 5) return 2;
  n = (int) head[0];
  state = (real *) calloc((size_t) CONTACTLAB_SPRINGS_STATE(n), sizeof(real)); /* no more than it may touch */
  if (!state) return 3;
  for (step = 0; step < (int) head[1]; ++step) {
    real moved[3], normal[3], velocity[3], force[3];
    double answer[4];
    const size_t width = head[4] != 0 ? 13 : 8;
    if (fread(row, sizeof(double), width, in) != width) return 4;
    for (i = 0; i < 3; ++i) {
      moved[i] = (real) row[i];
      normal[i] = (real) row[3 + i];
      velocity[i] = (real) row[10 + i];
    }
    answer[3] = (double) (width == 8 ?
      contactlab_springs_step(state, n, moved, normal, (real) row[6], (real) row[7], (real) head[2], (real) head[3],
                              force) :
      contactlab_springs_damped_step(state, n, moved, normal, (real) row[6], (real) row[7], (real) head[2],
                                     (real) head[3], force, (real) row[8], (real) row[9], velocity, (real) head[4]));
    for (i = 0; i < 3; ++i) answer[i] = (double) force[i];
    fwrite(answer, sizeof(double), 4, out);
  }
  free(state);
  fclose(in);
  return fclose(out);
}
