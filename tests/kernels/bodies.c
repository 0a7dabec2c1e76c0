/* Reads rows of 44 numbers: two bodies of 13, friction, stiffness, normal, velocities and spins, e; writes what
 * contactlab_bodies_bounce returns, velocities and spins, V, T and the compressions. */
#include <stdio.h>

#include "contactlab_bodies.h"

static contactlab_rigid body(const double *row)
{
  contactlab_rigid it;
  int k;
  it.mass = row[0];
  for (k = 0; k < 9; ++k) it.inverse_inertia[k] = row[1 + k];
  for (k = 0; k < 3; ++k) it.arm[k] = row[10 + k];
  return it;
}

int main(int count, char **words)
{
  double row[44], answer[16];
  FILE *in, *out;
  int i;
  if (count != 3 || !(in = fopen(words[1], "rb")) || !(out = fopen(words[2], "wb"))) return 2;
  while (fread(row, sizeof(double), 44, in) == 44) {
    const contactlab_rigid one = body(row), other = body(row + 13);
    contactlab_impact left = {0, 0, 0, 0, 0, 0, 0};
    answer[0] = contactlab_bodies_bounce(&one, &other, row[26], row[27], row[43], row + 28, row + 31, row + 34, row + 37,
                                         row + 40, &left);
    for (i = 0; i < 12; ++i) answer[1 + i] = row[31 + i];
    answer[13] = left.rate;
    answer[14] = left.time;
    answer[15] = left.compressions;
    fwrite(answer, sizeof(double), 16, out);
  }
  fclose(in);
  return fclose(out);
}
