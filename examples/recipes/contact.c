/* The kernel, which is inline, as a function that other languages link: see contact.rs. */
#include "contactlab_springs.h"

CONTACTLAB_REAL contact_step(CONTACTLAB_REAL *state, int springs, const CONTACTLAB_REAL *moved,
    const CONTACTLAB_REAL *normal, CONTACTLAB_REAL radius, CONTACTLAB_REAL limit, CONTACTLAB_REAL unit,
    CONTACTLAB_REAL modulus, CONTACTLAB_REAL *force)
{
  return contactlab_springs_step(state, springs, moved, normal, radius, limit, unit, modulus, force);
}
