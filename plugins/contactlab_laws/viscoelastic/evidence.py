"""Cautions with sizes on one loss for pressure and shear, from measurements (theory §15)."""

from __future__ import annotations

import numpy as np

from contactlab.contracts.motion import NormalMotion
from contactlab.impact import kinetics
from contactlab.impact.cautions import DEEPEST, OUTSIDE, name_bodies
from contactlab.impact.hertz import slips_throughout
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Mask

#: Largest change of beta0 from half the loss in shear to twice as much, by restitution, for solid
#: spheres and shells; below 0.9 it is at least the rms of eight measured balls.
RESTITUTIONS = (0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 1.0)
SIZES = (0.19, 0.16, 0.16, 0.16, 0.04, 0.02, 0.0)
#: Off by rms over the eleven pairs of small solid spheres, their least restitution, and K² of a
#: solid sphere within a margin.
SMALL, LEAST_SMALL, SOLID, NEARLY = 0.075, 0.6, 0.4, 0.02
#: Measured sets behind the sizes, by the names of ``contactlab validate --measured``.
BALLS, SPHERES, DEEPER = "eight-balls", "small-spheres", "superball"
#: chi of these spheres.
CHI = (0.8, 1.8)
#: A ball whose approach is deep gains so much beta0 for each z/R, least and most, from a depth on.
LEAST_GAIN, MOST_GAIN, DEEP = 1.2, 1.9, 0.02
#: Young's modulus in Pa and Poisson's ratio from which solids are metals, which lose by yield;
#: glass has 0.2 to 0.25.
METAL, LEAST_POISSON = 2e10, 0.26
#: Restitutions closer to 1 than this need no caution.
ELASTIC = 0.995


def cautions(scene: Scene, normal: NormalMotion, *, fitted: bool) -> tuple[str, ...]:
    """Return cautions of the tangential rebound with sizes; none if all impacts slip throughout.

    A ``fitted`` loss in shear clears the caution of the theory's loss.
    """
    if not kinetics.rubs(scene):
        return ()
    e = np.broadcast_to(-np.asarray(normal.final_rate) / scene.normal_speed, scene.shape)
    slips = slips_throughout(scene.psi1, scene.chi, e)
    grips = np.logical_not(slips) & (e < ELASTIC)
    if not np.any(grips):
        return ()
    deep = _deep(scene, normal) if name_bodies(scene) else ()
    of_bodies = (*deep, *_metal(scene)) if name_bodies(scene) else ()
    trusted = _trust(np.asarray(scene.chi), e, grips, small=_solid(scene) and not deep)
    return (*(() if fitted else trusted), *of_bodies)


def _solid(scene: Scene) -> bool:
    """Return whether the first body is a solid sphere."""
    if scene.sphere is None:
        return False
    return bool(np.all(np.abs(np.square(scene.sphere.gyration_ratio) - SOLID) <= NEARLY))


def _trust(chi: Array, e: Array, grips: Mask, *, small: bool) -> tuple[str, ...]:
    """Return the caution of beta0, within the measured range and outside it.

    Solid spheres with a ``small`` contact have the errors of such spheres, others those of balls.
    """
    known = (e >= RESTITUTIONS[0]) & (chi >= CHI[0]) & (chi <= CHI[1])
    said = []
    if small and np.any(within := grips & known & (e >= LEAST_SMALL)):
        least = float(np.min(e, where=within, initial=1.0))
        said.append(
            (
                least,
                f"beta0 is right within {SMALL:g} (rms), by eleven pairs of small solid "
                f"spheres ({SPHERES}).",
            )
        )
        grips = grips & ~within
    if np.any(within := grips & known):
        least = float(np.min(e, where=within, initial=1.0))
        size = float(np.interp(least, RESTITUTIONS, SIZES))
        said.append(
            (least, f"beta0 is right within {size:.2g}, by eight measured balls ({BALLS}).")
        )
    if np.any(beyond := grips & ~known):
        least = float(np.min(e, where=beyond, initial=1.0))
        ends = f"e from {RESTITUTIONS[0]:g}, chi from {CHI[0]:g} to {CHI[1]:g}"
        said.append((least, f"the error of beta0 is {OUTSIDE} ({ends})."))
    head = "model: assumes equal damping in compression and shear. At e ="
    fit = "If you have data, fit shear_loss."
    return tuple(f"{head} {least:.2g} {each} {fit}" for least, each in said)


def _deep(scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution of a contact whose depth moves the point of the force."""
    share = np.asarray(normal.maximum_approach / scene.pair.radius)
    depth = float(np.max(share, where=np.isfinite(share), initial=0.0))  # clay has none
    if not depth > DEEP:
        return ()
    low, high = LEAST_GAIN * depth, MOST_GAIN * depth
    size = f"{low:.2g} to {high:.2g} higher"
    if depth > DEEPEST:
        size = OUTSIDE
    return (f"model: deep contact, z/R = {depth:.2g}. Measured beta0 is {size} ({DEEPER}).",)


def _metal(scene: Scene) -> tuple[str, ...]:
    """Return the caution of a restitution of metals; numbers of ``validate --measured``."""
    stiff = np.min(np.asarray(scene.pair.effective_modulus)) >= 0.5 * METAL
    materials = [body.material for body in name_bodies(scene).values()]
    metals = (np.max(np.asarray(each.poisson_ratio)) >= LEAST_POISSON for each in materials)
    if not (stiff and any(metals)):
        return ()
    return (
        "model: metals lose energy by yield, not in shear. One loss still met both pairs with a "
        "metal: beta0 of glass on aluminium is 0.31 ± 0.06 measured, 0.31 by the law, of acetate "
        "on aluminium 0.39 ± 0.07 and 0.39. Chrome steel, 0.54 ± 0.05, is above any elastic "
        f"sphere's ({SPHERES}).",
    )
