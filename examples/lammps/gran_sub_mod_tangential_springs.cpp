/* -*- c++ -*-
   Tangential sub-model `mindlin_springs`; see gran_sub_mod_tangential_springs.h.

   SPDX-License-Identifier: GPL-2.0-only (derived from classes of LAMMPS; contactlab_springs.h is under MIT)
   Copyright (c) the authors of contactlab
*/
#include "gran_sub_mod_tangential_springs.h"

#include "error.h"
#include "gran_sub_mod_damping.h"
#include "gran_sub_mod_normal.h"
#include "granular_model.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace Granular_NS;

#include "contactlab_springs.h"    // in a merged tree the kernel itself

static constexpr int MOST = 64;    // springs

GranSubModTangentialMindlinSprings::GranSubModTangentialMindlinSprings(GranularModel *gm, LAMMPS *lmp) :
    GranSubModTangential(gm, lmp), springs(0), xt(0.0)
{
  num_coeffs = 4;
  contact_radius_flag = 1;
  nondefault_history_transfer = 1;
}

void GranSubModTangentialMindlinSprings::coeffs_to_local()
{
  xt = coeffs[1];
  mu = coeffs[2];
  if (!(coeffs[3] >= 2.0 && coeffs[3] <= MOST && fmod(coeffs[3], 2.0) == 0.0))
    error->all(FLERR, "mindlin_springs: N = {}: must be even, from 2 to {}", coeffs[3], MOST);
  springs = static_cast<int>(coeffs[3]);

  // numbers take the place of NULL, for mixing and for a restart
  const double young = gm->normal_model->get_emod(), poisson = gm->normal_model->get_poiss();
  const bool pair = gm->contact_type == PAIR;
  if ((coeffs[0] == -1 || xt == -1) && !gm->normal_model->get_material_properties())
    error->all(FLERR, "mindlin_springs: NULL needs a normal model with material properties");
  if (coeffs[0] == -1)
    coeffs[0] = 8.0 * (pair ? mix_stiffnessG(young, young, poisson, poisson) : mix_stiffnessG_wall(young, poisson));
  k = coeffs[0];
  if (xt == -1) {    // one relaxation time: damping over stiffness as in the normal direction, 2 E* times the radius
    xt = k / (2.0 * (pair ? mix_stiffnessE(young, young, poisson, poisson) : mix_stiffnessE_wall(young, poisson)));
    coeffs[1] = xt;
  }
  if (!(k > 0.0 && xt >= 0.0 && mu >= 0.0))
    error->all(FLERR, "mindlin_springs: kt must be positive, xt and mu must not be negative");

  // where two grains swap, the deflections and the slip velocity change sign; N, the size of the grid and the contact
  // radius do not
  size_history = 1 + CONTACTLAB_SPRINGS_STATE(springs) + (xt > 0.0 ? 3 : 0);
  delete[] transfer_history_factor;
  transfer_history_factor = new double[size_history];
  std::fill(transfer_history_factor, transfer_history_factor + 3, 1.0);
  std::fill(transfer_history_factor + 3, transfer_history_factor + size_history, -1.0);
}

void GranSubModTangentialMindlinSprings::mix_coeffs(double *icoeffs, double *jcoeffs)
{
  // kt of like pairs is 4 G/(2 - nu) of their material, and compliances add up; so do xt/kt, 1/(2 E*) from NULL
  coeffs[0] = 2.0 * icoeffs[0] * jcoeffs[0] / (icoeffs[0] + jcoeffs[0]);
  coeffs[1] = 0.5 * coeffs[0] * (icoeffs[1] / icoeffs[0] + jcoeffs[1] / jcoeffs[0]);
  coeffs[2] = mix_geom(icoeffs[2], jcoeffs[2]);
  coeffs[3] = std::max(icoeffs[3], jcoeffs[3]);
  coeffs_to_local();
}

void GranSubModTangentialMindlinSprings::calculate_forces()
{
  double *history = &gm->history[history_index];
  double kept[1 + CONTACTLAB_SPRINGS_STATE(MOST) + 3], moved[3] = {0.0, 0.0, 0.0};

  // N leads the history, so that a restart with another N or law is told
  if (history[0] != springs && (history[0] != 0.0 || history[1] != 0.0 || history[2] != 0.0))
    error->one(FLERR, "mindlin_springs: a contact has the history of another N or tangential model, not of N = {}",
               springs);

  if (gm->history_update) {
    for (int i = 0; i < 3; i++) moved[i] = gm->dt * gm->vtr[i];
    history[0] = springs;
  } else {    // setup of a run, or a query: the force without a step
    std::copy(history, history + size_history, kept);
    history = kept;
  }

  double limit = mu * gm->normal_model->get_fncrit(), elastic = limit;
  if (xt == 0.0) {
    contactlab_springs_step(history + 1, springs, moved, gm->nx, gm->contact_radius, limit, gm->Reff, k, gm->fs);
    return;
  }
  if (!gm->normal_model->get_cohesive_flag()) {
    limit = mu * std::max(gm->Fntot, 0.0);
    elastic = mu * std::max(gm->Fnormal, 0.0);
  }
  // velocities are those of half a step ago: the slip is continued from the last two
  double slip[3], *last = history + size_history - 3;
  const double more = gm->history_update && history[1] > 0.0 ? 0.5 : 0.0;
  for (int i = 0; i < 3; i++) {
    slip[i] = gm->vtr[i] + more * (gm->vtr[i] - last[i]);
    last[i] = gm->vtr[i];
  }
  contactlab_springs_damped_step(history + 1, springs, moved, gm->nx, gm->contact_radius, limit, gm->Reff, k, gm->fs,
                                 elastic, xt * gm->damping_model->get_damp_prefactor(), slip, gm->dt);
}
