/* Reads psi1, chi, lam, eta, tolerance and the most steps of each impact; writes status and what it leaves. */
#include <stdio.h>
#include <stdlib.h>

#include "contactlab_impact.h"

int main(int count, char **name)
{
  FILE *in = count == 3 ? fopen(name[1], "rb") : NULL, *out = count == 3 ? fopen(name[2], "wb") : NULL;
  double row[6];
  if (!in || !out) return EXIT_FAILURE;
  while (fread(row, sizeof row, 1, in) == 1) {
    contactlab_impact left;
    double answer[8];
    answer[0] = contactlab_impact_follow(row[0], row[1], row[2], row[3], row[4], (int)row[5], &left);
    answer[1] = left.rate;
    answer[2] = left.change;
    answer[3] = left.work;
    answer[4] = left.time;
    answer[5] = left.radius;
    answer[6] = left.compressions;
    answer[7] = left.steps;
    if (fwrite(answer, sizeof answer, 1, out) != 1) return EXIT_FAILURE;
  }
  return fclose(in) || fclose(out) ? EXIT_FAILURE : EXIT_SUCCESS;
}
