/* -*- c++ -*-
   Tangential sub-model `mindlin_springs`; see gran_sub_mod_tangential_springs.h.

   SPDX-License-Identifier: GPL-2.0-only (derived from classes of LAMMPS; contactlab_springs.h is under MIT)
   Copyright (c) the authors of contactlab
*/
#include "gran_sub_mod_tangential_springs.h"

#include "contactlab_springs.h"
#include "error.h"
#include "gran_sub_mod_normal.h"
#include "granular_model.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace Granular_NS;

static constexpr int MOST = 64;    // springs

GranSubModTangentialMindlinSprings::GranSubModTangentialMindlinSprings(GranularModel *gm, LAMMPS *lmp) :
    GranSubModTangential(gm, lmp), springs(0)
{
  num_coeffs = 3;
  contact_radius_flag = 1;
  nondefault_history_transfer = 1;
  damp = 0.0;
}

void GranSubModTangentialMindlinSprings::coeffs_to_local()
{
  k = coeffs[0];
  mu = coeffs[1];
  springs = static_cast<int>(coeffs[2]);
  if (springs != coeffs[2] || springs % 2 || springs < 2 || springs > MOST)
    error->all(FLERR, "mindlin_springs: springs = {}: must be even, from 2 to {}", coeffs[2], MOST);

  if (k == -1) {
    if (!gm->normal_model->get_material_properties())
      error->all(FLERR, "mindlin_springs: kt = NULL needs a normal model with material properties");
    const double young = gm->normal_model->get_emod(), poisson = gm->normal_model->get_poiss();
    k = 8.0 * (gm->contact_type == PAIR ? mix_stiffnessG(young, young, poisson, poisson) :
                                          mix_stiffnessG_wall(young, poisson));
  }
  if (k < 0.0 || mu < 0.0) error->all(FLERR, "mindlin_springs: kt and mu must not be negative");

  // where two grains swap, the deflections change sign; the size of the grid and the contact radius do not
  size_history = CONTACTLAB_SPRINGS_STATE(springs);
  delete[] transfer_history_factor;
  transfer_history_factor = new double[size_history];
  std::fill(transfer_history_factor, transfer_history_factor + 2, 1.0);
  std::fill(transfer_history_factor + 2, transfer_history_factor + size_history, -1.0);
}

void GranSubModTangentialMindlinSprings::mix_coeffs(double *icoeffs, double *jcoeffs)
{
  const bool material = icoeffs[0] == -1 || jcoeffs[0] == -1;
  coeffs[0] = material ? -1 : mix_geom(icoeffs[0], jcoeffs[0]);
  coeffs[1] = mix_geom(icoeffs[1], jcoeffs[1]);
  coeffs[2] = std::max(icoeffs[2], jcoeffs[2]);
  coeffs_to_local();
  // the mixed normal model has E* for Young's modulus: with it mix_stiffnessG would halve the stiffness
  if (material) {
    const double poisson = gm->normal_model->get_poiss();
    k = 4.0 * (1.0 - poisson) / (2.0 - poisson) * gm->normal_model->get_emod();
  }
}

void GranSubModTangentialMindlinSprings::calculate_forces()
{
  double *history = &gm->history[history_index];
  double kept[CONTACTLAB_SPRINGS_STATE(MOST)], moved[3] = {0.0, 0.0, 0.0};

  if (gm->history_update) {
    for (int i = 0; i < 3; i++) moved[i] = gm->dt * gm->vtr[i];
  } else {    // setup of a run, or a query: the force without a step
    std::copy(history, history + size_history, kept);
    history = kept;
  }
  contactlab_springs_step(history, springs, moved, gm->nx, gm->contact_radius,
                          mu * gm->normal_model->get_fncrit(), gm->Reff, k, gm->fs);
}
