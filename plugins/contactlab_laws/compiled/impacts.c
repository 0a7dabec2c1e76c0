/* Many impacts by contactlab_impact.h, and the sources this library was built of. */
#include "contactlab_impact.h"

#include <stdlib.h>

#ifndef CONTACTLAB_SOURCES
#define CONTACTLAB_SOURCES ""
#endif

/* Digest of the sources at the time of the build. */
const char *contactlab_impact_sources(void)
{
  return CONTACTLAB_SOURCES;
}

/* What an impact leaves, `stride` numbers apart: V, psi2 - psi1, work, T, u, compressions, steps. */
static void contactlab_impact_write(const contactlab_impact *one, long stride, double *out)
{
  out[0] = one->rate;
  out[stride] = one->change;
  out[2 * stride] = one->work;
  out[3 * stride] = one->time;
  out[4 * stride] = one->radius;
  out[5 * stride] = one->compressions;
  out[6 * stride] = one->steps;
}

/* Follows one impact again with a memory that holds all its steps. */
static int contactlab_impact_again(const double *numbers, long stride, double tolerance, int most,
                                   contactlab_impact_watch *watch, void *context, contactlab_impact *one)
{
  contactlab_impact_piece *memory = (contactlab_impact_piece *)malloc((size_t)most * sizeof *memory);
  int status = CONTACTLAB_IMPACT_MEMORY;
  if (memory)
    status = contactlab_impact_within(numbers[0], numbers[stride], numbers[2 * stride], numbers[3 * stride], tolerance,
                                      most, watch, context, memory, most, one);
  free(memory);
  return status;
}

/* psi1, chi, lam and eta in the rows of `numbers`, shape (4, count); what each leaves in the rows of `out`, shape
 * (7, count). */
void contactlab_impact_follow_all(long count, const double *numbers, double tolerance, int most, double *out, int *status)
{
  long i;
  for (i = 0; i < count; ++i) {
    contactlab_impact one;
    status[i] = contactlab_impact_follow(numbers[i], numbers[count + i], numbers[2 * count + i], numbers[3 * count + i],
                                         tolerance, most, &one);
    if (status[i] == CONTACTLAB_IMPACT_MEMORY)
      status[i] = contactlab_impact_again(numbers + i, count, tolerance, most, NULL, NULL, &one);
    contactlab_impact_write(&one, count, out + i);
  }
}

/* Where steps are kept: how many there are, and place for the first `most`. */
typedef struct { long count, most; double *rows; } contactlab_impact_steps;

/* Keeps a step: part, phase, sign, psi - psi1, work and length, then the series of u, V, k, J, c and T. */
static void contactlab_impact_keep(void *context, const contactlab_impact_step *step)
{
  contactlab_impact_steps *steps = (contactlab_impact_steps *)context;
  const double *series[6], head[6] = {step->part, step->phase, step->sign, step->change, step->work, step->length};
  double *row;
  int i;
  if (steps->count++ >= steps->most) return;
  row = steps->rows + (steps->count - 1) * (6 + 6 * CONTACTLAB_IMPACT_TERMS);
  series[0] = step->radius;
  series[1] = step->rate;
  series[2] = step->margin;
  series[3] = step->lack;
  series[4] = step->stick;
  series[5] = step->time;
  memcpy(row, head, sizeof head);
  for (i = 0; i < 6; ++i) memcpy(row + 6 + i * CONTACTLAB_IMPACT_TERMS, series[i], sizeof(contactlab_impact_series));
}

/* Numbers of a kept step. */
int contactlab_impact_width(void)
{
  return 6 + 6 * CONTACTLAB_IMPACT_TERMS;
}

/* One impact as above, whose first `room` steps come in the rows of `kept`, shape (room, width). Returns how many steps
 * there are. */
long contactlab_impact_follow_kept(const double *numbers, double tolerance, int most, long room, double *kept,
                                   double *out, int *status)
{
  contactlab_impact_steps steps = {0, room, kept};
  contactlab_impact one;
  *status = contactlab_impact_watched(numbers[0], numbers[1], numbers[2], numbers[3], tolerance, most,
                                      contactlab_impact_keep, &steps, &one);
  if (*status == CONTACTLAB_IMPACT_MEMORY) {
    steps.count = 0;
    *status = contactlab_impact_again(numbers, 1, tolerance, most, contactlab_impact_keep, &steps, &one);
  }
  contactlab_impact_write(&one, 1, out);
  return steps.count;
}
