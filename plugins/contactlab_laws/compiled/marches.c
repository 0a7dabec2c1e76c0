/* Many scenes by contactlab_march.h, in calls that end soon: Ctrl-C is heard between them. */
#include "contactlab_march.h"

#include <stddef.h>

/* Steps of a contact between two looks at the budget. */
enum { CONTACTLAB_MARCH_LOOK = 64 };

/* What a call leaves to the next: the item that it was at, and how far it is. */
typedef struct {
  contactlab_march_run run;
  contactlab_march_path path;
  long place, step;
  int going;
} contactlab_march_left;

/* Bytes that calls share, zero before the first, of items of some contacts. */
size_t contactlab_march_room(int contacts, int springs)
{
  const size_t width = (size_t) CONTACTLAB_MARCH_ROW(springs), work = (4 * (size_t) contacts + 12) * width;
  return sizeof(contactlab_march_left) + (size_t) contacts * sizeof(contactlab_march_progress) + work * sizeof(double);
}

/* Marches scenes on until all are done or `budget` springs have moved; returns how many are done.
 *
 * Scenes have as many contacts and share row and column; block (scenes, entries, 9), end (scenes, contacts). */
long contactlab_march_scenes(long count, int contacts, const contactlab_march_contact *c, const int *row,
    const int *column, const double *block, int axes, int springs, int lossy, int alone, const double *step,
    const double *leading, const double *most, const double *deepest, double budget, contactlab_march_left *left, contactlab_march_end *end,
    double *steps, int *status)
{
  contactlab_march_progress *progress = (contactlab_march_progress *) (left + 1);
  double *work = (double *) (progress + contacts);
  const long look = contacts < CONTACTLAB_MARCH_LOOK ? CONTACTLAB_MARCH_LOOK / contacts : 1;
  const double cost = (double) look * springs * contacts;
  const long each = row[contacts];
  for (; left->place < count; ++left->place) {
    const long i = left->place;
    const contactlab_march_scene scene = {contacts, c + i * contacts, row, column, block + 9 * each * i, axes, springs, lossy,
        alone, step[i], leading[i], most[i], deepest + i * contacts, progress, work, end + i * contacts};
    if (!left->going) status[i] = contactlab_march_begin(&left->run, &scene);
    left->going = status[i] == CONTACTLAB_MARCH_GOING;
    while (left->going) {
      if (budget <= 0.0) return left->place;
      budget -= cost;
      status[i] = contactlab_march_on(&left->run, look);
      left->going = status[i] == CONTACTLAB_MARCH_GOING;
    }
    steps[i] = status[i] == CONTACTLAB_MARCH_INPUT ? 0.0 : (double) left->run.steps;
  }
  return left->place;
}

/* Impacts along one table of a known normal motion, in the same way; out (impacts, 2): work and loss, forces (impacts, steps). */
long contactlab_march_paths(long count, int springs, int lossy, const contactlab_march_sample *table, long steps,
    const contactlab_march_impact *impacts, double budget, contactlab_march_left *left, double *out, double *forces)
{
  double *work = (double *) ((contactlab_march_progress *) (left + 1) + 1);
  for (; left->place < count; ++left->place) {
    const long i = left->place;
    if (!left->going) {
      contactlab_march_path_begin(&left->path, springs, work);
      left->step = 0;
      left->going = 1;
    }
    while (left->step < steps) {
      const long rest = steps - left->step, some = rest < CONTACTLAB_MARCH_LOOK ? rest : CONTACTLAB_MARCH_LOOK;
      double *f = forces + i * steps + left->step;
      if (budget <= 0.0) return left->place;
      budget -= (double) some * springs;
      if (lossy) contactlab_march_along_lossy(springs, table + left->step, some, impacts + i, &left->path, f);
      else contactlab_march_along(springs, table + left->step, some, impacts + i, &left->path, f);
      left->step += some;
    }
    out[2 * i] = left->path.work;
    out[2 * i + 1] = left->path.loss;
    left->going = 0;
  }
  return left->place;
}

/* psi2 of spheres that lose as their normal contact does, at psi1, chi and a; samples (steps), work as of a path. */
void contactlab_march_rebounds(long count, const double *psi1, const double *chi, const double *a, int springs,
    long steps, contactlab_march_sample *samples, double *work, double *psi2)
{
  double largest = 1.0;
  long i;
  for (i = 0; i < count; ++i) {
    contactlab_march_impact one = {psi1[i], 1.0, 1.0, 1.0, 1.0, 1.0 / (2.5 * chi[i]), 1.0};
    contactlab_march_path path;
    if (!i || a[i] != a[i - 1]) largest = contactlab_march_course(a[i], steps, samples);
    one.scale = 1.0 / (largest * largest);
    contactlab_march_path_begin(&path, springs, work);
    contactlab_march_along_lossy(springs, samples, steps, &one, &path, NULL);
    psi2[i] = psi1[i] + path.change;
  }
}
