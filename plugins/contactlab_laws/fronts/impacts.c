/* Many impacts by contactlab_impact.h, and the sources this library was built of. */
#include "contactlab_impact.h"

#ifndef CONTACTLAB_SOURCES
#define CONTACTLAB_SOURCES ""
#endif

/* Digest of the sources at the time of the build. */
const char *contactlab_impact_sources(void)
{
  return CONTACTLAB_SOURCES;
}

/* psi1, chi, lam and eta in the rows of `numbers`, shape (4, count); what each leaves in the rows of `out`, shape
 * (7, count): V, psi2 - psi1, work, T, u, compressions, steps. */
void contactlab_impact_follow_all(long count, const double *numbers, double tolerance, int most, double *out, int *status)
{
  long i;
  for (i = 0; i < count; ++i) {
    contactlab_impact one;
    status[i] = contactlab_impact_follow(numbers[i], numbers[count + i], numbers[2 * count + i], numbers[3 * count + i],
                                         tolerance, most, &one);
    out[i] = one.rate;
    out[count + i] = one.change;
    out[2 * count + i] = one.work;
    out[3 * count + i] = one.time;
    out[4 * count + i] = one.radius;
    out[5 * count + i] = one.compressions;
    out[6 * count + i] = one.steps;
  }
}
