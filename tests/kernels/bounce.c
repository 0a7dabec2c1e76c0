/* bounce IN OUT: rows of 26 doubles, two bodies, friction, normal, velocities and spins; writes the answers.
 * Each is what contactlab_bounce returns, then both velocities and spins. */
#include <stdio.h>

#include "contactlab_bounce.h"

int main(int count, char **words)
{
  double row[26], answer[13];
  FILE *in, *out;
  int i;
  if (count != 3 || !(in = fopen(words[1], "rb")) || !(out = fopen(words[2], "wb"))) return 2;
  while (fread(row, sizeof(double), 26, in) == 26) {
    const contactlab_body one = {row[0], row[1], row[2], row[3], row[4]};
    const contactlab_body other = {row[5], row[6], row[7], row[8], row[9]};
    answer[0] = contactlab_bounce(&one, &other, row[10], row + 11, row + 14, row + 17, row + 20, row + 23);
    for (i = 0; i < 12; ++i) answer[1 + i] = row[14 + i];
    fwrite(answer, sizeof(double), 13, out);
  }
  fclose(in);
  return fclose(out);
}
