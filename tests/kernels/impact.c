/* Reads psi1, chi, lam, eta, tolerance and the most steps of each impact; writes status and what it leaves. Each is
 * followed twice: the second time the beginning, middle and end of its steps are written to a second file. */
#include <stdio.h>
#include <stdlib.h>

#include "contactlab_impact.h"

static FILE *instants;
static int failed;
static double impact;

static void show(void *context, const contactlab_impact_step *step)
{
  int i;
  for (i = 0; i < 3; ++i) {
    const contactlab_impact_instant at = contactlab_impact_at(step, 0.5 * i * step->length);
    const double row[12] = {impact, step->part, step->phase, step->sign, step->change, step->work,
                            at.time, at.radius, at.rate, at.stick, at.psi, at.force};
    failed |= fwrite(row, sizeof row, 1, instants) != 1;
  }
  ++*(long *)context;
}

static void put(double *answer, const contactlab_impact *left)
{
  answer[1] = left->rate;
  answer[2] = left->change;
  answer[3] = left->work;
  answer[4] = left->time;
  answer[5] = left->radius;
  answer[6] = left->compressions;
  answer[7] = left->steps;
}

int main(int count, char **name)
{
  FILE *in = count == 4 ? fopen(name[1], "rb") : NULL, *out = count == 4 ? fopen(name[2], "wb") : NULL;
  double row[6];
  instants = count == 4 ? fopen(name[3], "wb") : NULL;
  if (!in || !out || !instants) return EXIT_FAILURE;
  for (; fread(row, sizeof row, 1, in) == 1; ++impact) {
    contactlab_impact left;
    double answer[16];
    long shown = 0;
    answer[0] = contactlab_impact_follow(row[0], row[1], row[2], row[3], row[4], (int)row[5], &left);
    put(answer, &left);
    answer[8] = contactlab_impact_watched(row[0], row[1], row[2], row[3], row[4], (int)row[5], show, &shown, &left);
    put(answer + 8, &left);
    failed |= shown != left.steps || fwrite(answer, sizeof answer, 1, out) != 1;
  }
  failed |= fclose(in) || fclose(out) || fclose(instants);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
