/* bounce IN OUT: rows of 27 doubles, two bodies, friction, restitution, normal, velocities, spins; writes the answers.
 * Each is what contactlab_bounce returns, then both velocities and spins. */
#include <stdio.h>

#include "contactlab_bounce.h"

int main(int count, char **words)
{
  double row[27], answer[13];
  FILE *in, *out;
  int i;
  if (count != 3 || !(in = fopen(words[1], "rb")) || !(out = fopen(words[2], "wb"))) return 2;
  while (fread(row, sizeof(double), 27, in) == 27) {
    const contactlab_body one = {row[0], row[1], row[2], row[3], row[4]};
    const contactlab_body other = {row[5], row[6], row[7], row[8], row[9]};
    answer[0] = contactlab_bounce(&one, &other, row[10], row[11], row + 12, row + 15, row + 18, row + 21,
        row + 24);
    for (i = 0; i < 12; ++i) answer[1 + i] = row[15 + i];
    fwrite(answer, sizeof(double), 13, out);
  }
  fclose(in);
  return fclose(out);
}
