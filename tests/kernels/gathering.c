/* A gathering by a program of one's own. Reads counts of bodies, contacts, springs and 1 for loss; the step and the
 * steps that grow; bodies of 10 numbers, velocities and spins of 6; contacts of 17 numbers and their march of 17.
 * Writes the status, velocities, spins and impulses. */
#include <stdio.h>

#include "contactlab_bodies.h"
#include "contactlab_march.h"

enum { MOST = 8 };

static double next(FILE *in)
{
  double value = 0;
  if (fread(&value, sizeof value, 1, in) != 1) value = NAN;
  return value;
}

static void some(FILE *in, double *out, int count) { while (count--) *out++ = next(in); }

int main(int count, char **words)
{
  FILE *in, *out;
  if (count != 3 || !(in = fopen(words[1], "rb")) || !(out = fopen(words[2], "wb"))) return 2;
  {
    const int bodies = (int) next(in), contacts = (int) next(in), springs = (int) next(in), lossy = (int) next(in);
    const double step = next(in), leading = next(in);
    contactlab_rigid body[MOST];
    contactlab_touch touch[MOST];
    contactlab_march_contact c[MOST];
    contactlab_march_progress progress[MOST];
    contactlab_march_run run;
    contactlab_march_end end[MOST];
    double velocity[3 * MOST], spin[3 * MOST], block[9 * MOST * MOST], work[CONTACTLAB_MARCH_WORK(MOST, 64)];
    double answer, arms[17];
    int row[MOST + 1], column[MOST * MOST], i, k, status, blocks;
    if (bodies > MOST || contacts > MOST || springs > 64) return 3;
    for (i = 0; i < bodies; ++i) {
      body[i].mass = next(in);
      some(in, body[i].inverse_inertia, 9);
      some(in, velocity + 3 * i, 3);
      some(in, spin + 3 * i, 3);
    }
    for (i = 0; i < contacts; ++i) {
      some(in, arms, 17);
      touch[i].first = (int) arms[0];
      touch[i].second = (int) arms[1];
      for (k = 0; k < 3; ++k) {
        touch[i].arm[k] = arms[2 + k];
        touch[i].other_arm[k] = arms[5 + k];
      }
      for (k = 0; k < 9; ++k) touch[i].axes[k] = arms[8 + k];
      some(in, (double *) (c + i), (int) (sizeof *c / sizeof(double)));
      contactlab_bodies_rates(touch + i, velocity, spin, c[i].velocity);
    }
    blocks = contactlab_bodies_blocks(body, contacts, touch, contacts * contacts, row, column, block);
    if (blocks < 0 || contactlab_bodies_blocks(body, contacts, touch, blocks - 1, row, column, block) != -1) return 4;
    contactlab_bodies_blocks(body, contacts, touch, blocks, row, column, block);
    {
      const contactlab_march_scene scene = {contacts, c, row, column, block, 2, springs, lossy, 0, step, leading, 1e5, NULL,
                                            progress, work, end};
      status = contactlab_march_begin(&run, &scene);
    }
    while (status == CONTACTLAB_MARCH_GOING) status = contactlab_march_on(&run, 1000);
    for (i = 0; i < contacts; ++i) contactlab_bodies_part(body, touch + i, end[i].impulse, velocity, spin);
    answer = status;
    fwrite(&answer, sizeof answer, 1, out);
    fwrite(velocity, sizeof(double), (size_t) (3 * bodies), out);
    fwrite(spin, sizeof(double), (size_t) (3 * bodies), out);
  }
  fclose(in);
  return fclose(out);
}
