/* -*- c++ -*-
   Tangential sub-model `mindlin_springs` of LAMMPS's granular styles: partial slip by contactlab's springs on a
   doubling grid. For the sources of a LAMMPS with granular sub-models (since 2023), beside contactlab_springs.h.

   SPDX-License-Identifier: GPL-2.0-only (derived from classes of LAMMPS; contactlab_springs.h is under MIT)
   Copyright (c) the authors of contactlab
*/
#ifdef GRAN_SUB_MOD_CLASS
// clang-format off
GranSubModStyle(mindlin_springs,GranSubModTangentialMindlinSprings,TANGENTIAL);
// clang-format on
#else

#ifndef GRAN_SUB_MOD_TANGENTIAL_SPRINGS_H
#define GRAN_SUB_MOD_TANGENTIAL_SPRINGS_H

#include "gran_sub_mod_tangential.h"

namespace LAMMPS_NS {
namespace Granular_NS {

  // tangential mindlin_springs kt xt mu N
  //   kt  8 G*, 1/G* = sum (2 - nu)/G, in pressure units; NULL takes it from the material of the normal model
  //   xt  tangential over normal damping; NULL takes one loss for both, 4 G*/E*; 0 elastic shear
  //   mu  friction coefficient
  //   N   springs, even, 2 to 64; the history has 3 + 3 N numbers, and 3 more where xt is not 0
  class GranSubModTangentialMindlinSprings : public GranSubModTangential {
   public:
    GranSubModTangentialMindlinSprings(class GranularModel *, class LAMMPS *);
    void coeffs_to_local() override;
    void mix_coeffs(double *, double *) override;
    void calculate_forces() override;

   protected:
    int springs;
    double xt;
  };

}    // namespace Granular_NS
}    // namespace LAMMPS_NS

#endif
#endif
