"""Scenes from dimensionless groups: psi1 and chi of the paper, lam, eta and rho of theory §14."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.impact.bodies import Pair
from contactlab.numeric import arrays as batch
from contactlab.numeric.arrays import plain
from contactlab.numeric.checks import NON_NEGATIVE, POISSON, POSITIVE, Rule, real, refuse
from contactlab.numeric.types import Array, Numbers, Real

#: E* that makes C = 1 in eq. (9), where R = M_n = v1 = 1.
MODULUS = 15.0 / 16.0
#: Stiffnesses (1 - beta nu)/(2G) of two directions, with shares beta from 0 to 1 and nu from -1 to
#: 1/2; springs were checked for these.
OF_ELLIPSES = Rule(
    lambda ratio: (ratio >= 0.5) & (ratio <= 2.0), "must lie in [0.5, 2], the range of ellipses"
)
#: Words for arrays that do not fit.
SHAPES, EQUAL = "Scene.nondimensional: the shapes", "give arrays of equal length"
#: Relative difference of two values of rho from which they contradict each other.
ALIKE = 1e-9


@np.errstate(over="ignore", under="ignore")  # a scene refuses what overflows
def entries(
    *,
    psi1: Numbers,
    chi: Numbers,
    lam: Numbers,
    eta: Numbers | None,
    rho: Numbers | None,
    poisson_ratio: Numbers | None,
    coupling_number: Numbers | None,
    friction_coefficient: Numbers | None,
    spin: Numbers,
    spin_inertia: Numbers,
    cross_stiffness_ratio: Numbers = 1.0,
) -> dict[str, Any]:
    """Return the entries of ``Scene`` for the groups of ``Scene.nondimensional``."""
    incidence = real(
        "psi1", psi1, remedy="give the non-dimensional angle of incidence, eq. (29) of the paper"
    )
    remedy = "chi of eq. (38); 1.4412 for a solid sphere, nu = 0.3"
    inertia = real("chi", chi, remedy=remedy)
    square, vectors = np.shape(inertia)[-2:] == (2, 2), np.shape(incidence)[-1:] == (2,)
    in_space = rho is not None and square and (vectors or not np.all(np.greater(inertia, 0.0)))
    if not in_space:
        if square and not np.all(np.greater(inertia, 0.0)):
            remedy = "a tensor of the tangent plane needs rho = mu²/kappa"
        inertia = real("chi", chi, rule=POSITIVE, remedy=remedy)
    drag = real("lam", lam, remedy="lam = mu W_nt/W_nn of theory §14; 0 for spheres")
    given = None
    if poisson_ratio is not None:
        nu = real("poisson_ratio", poisson_ratio, rule=POISSON)
        given = 2.0 * (1.0 - nu) / (2.0 - nu)
    friction = None
    if friction_coefficient is not None:
        friction = real("friction_coefficient", friction_coefficient, rule=POSITIVE)
    coupled = (
        0.0
        if coupling_number is None
        else real(
            "coupling_number", coupling_number, remedy="Lambda = kappa beta/mu; 0 for like bodies"
        )
    )
    remedy = "G* along t2 over that along t1; 1 for a circular contact"
    cross = real("cross_stiffness_ratio", cross_stiffness_ratio, rule=OF_ELLIPSES, remedy=remedy)
    rim = real("spin", spin, remedy="w1 = kappa omega_n a/(mu v1) of theory §17")
    turning = real("spin_inertia", spin_inertia, rule=NON_NEGATIVE, remedy="chi_w of theory §17")
    numbers = {
        "eta": None if eta is None else real("eta", eta),
        "rho": None if rho is None else real("rho", rho),
        "poisson_ratio": given,
        "coupling_number": coupled,
        "friction_coefficient": friction,
        "cross_stiffness_ratio": cross,
        "spin": rim,
        "spin_inertia": turning,
    }
    if not in_space:  # else they end with axes of the tangent plane
        numbers = {"psi1": incidence, "chi": inertia, "lam": drag, **numbers}
    batch.common_shape(
        {name: each.shape for name, each in numbers.items() if isinstance(each, np.ndarray)},
        what=SHAPES,
        remedy=EQUAL,
    )
    squared = _rho(inertia, drag, eta, rho, given, friction, in_space)
    mu, kappa = _friction_and_stiffness(squared, given, friction)
    pair = {
        "radius": 1.0,
        "effective_modulus": MODULUS,
        "effective_shear_modulus": kappa * MODULUS,
        "normal_mass": 1.0,
        "dundurs_beta": 0.0 if coupling_number is None else coupled * mu / kappa,
        "cross_stiffness_ratio": cross,
    }
    scene: dict[str, Any] = {"friction_coefficient": mu, "normal_speed": 1.0, "has_units": False}
    if np.any(rim):
        if not np.all(turning):
            remedy = "chi_w = (kappa/2) M_n a²/J; 5/7 chi (a/R)² for a solid sphere"
            raise refuse("spin_inertia", spin_inertia, "must be positive with spin", remedy)
        if in_space or np.any(drag) or np.any(np.not_equal(cross, 1.0)):
            rule = "needs a circular contact of bodies whose centres are on the normal"
            raise refuse("spin", spin, rule, "leave out lam, vectors and cross_stiffness_ratio")
        scene["normal_spin"] = rim * mu / kappa
        pair["inverse_spin_mass"] = 2.0 * turning / kappa
    scene |= {"unit_friction": friction is None and (squared is None or given is None)}
    mean = 0.5 * np.trace(inertia, axis1=-2, axis2=-1) if in_space else inertia
    pair["tangential_mass"] = 0.5 * kappa / mean
    if squared is None or not (in_space or np.any(drag)):
        return scene | {"tangential_velocity": incidence * mu / kappa, "pair": Pair(**pair)}
    slip, W = _scale(mu, kappa, cross, incidence, inertia, drag, in_space)
    return scene | {
        "tangential_velocity": slip,
        "pair": Pair(**pair),
        "inverse_mass": W,
        "planar": not in_space,
    }


def _rho(
    inertia: Real,
    drag: Real,
    eta: Numbers | None,
    rho: Numbers | None,
    kappa: Real | None,
    mu: Real | None,
    in_space: bool,
) -> Real | None:
    """Return rho = mu²/kappa of a scene that couples; None of one that does not."""
    if eta is not None and rho is not None:
        raise refuse("eta, rho", (eta, rho), "give one of them: rho = lam/eta = mu²/kappa")
    known = None if mu is None or kappa is None else mu * mu / kappa
    squared = None
    if rho is not None:
        squared = real("rho", rho, rule=POSITIVE)
    elif eta is not None:
        squared = _by_eta(drag, real("eta", eta), 1.0 if known is None else known)
    elif np.any(drag):
        squared = known
        if known is None:
            rule = "lam needs one of them: eta in the plane, rho in the plane or in space"
            raise refuse("eta, rho", (eta, rho), rule, "rho = lam/eta = mu²/kappa")
    if not (squared is None or known is None or np.allclose(squared, known, rtol=ALIKE, atol=0.0)):
        name, told = ("rho", rho) if eta is None else ("lam / eta", np.ravel(squared).tolist())
        rule = f"contradicts mu²/kappa = {known} of friction_coefficient and poisson_ratio"
        raise refuse(name, told, rule, f"leave out {name[-3:]}, or one of the two")
    if squared is None or in_space:
        return squared
    jams = np.max(np.square(drag) / (2.0 * np.asarray(squared) * inertia))
    if not jams < 1.0:
        raise refuse("lam eta / (2 chi)", float(jams), "must be below 1: W has an inverse")
    return squared


def _by_eta(drag: Real, eta: Real, where_zero: Real) -> Real | None:
    """Return lam/eta; ``where_zero`` where both are zero."""
    if not np.any(drag):
        if not np.any(eta):
            return None
        raise refuse("eta", eta, "needs lam too: both are zero without coupling", "give lam")
    alone = (np.asarray(drag) == 0.0) & (np.asarray(eta) == 0.0)
    rule = "must be positive, finite: both have the sign of W_nt, both are zero without coupling"
    with np.errstate(all="ignore"):
        squared = np.where(alone, where_zero, np.divide(drag, eta))
    if not np.all((squared > 0.0) & np.isfinite(squared)):
        raise refuse("lam / eta", np.ravel(squared).tolist(), rule, "rho = lam/eta = mu²/kappa")
    return plain(squared)


def _friction_and_stiffness(
    squared: Real | None, kappa: Real | None, mu: Real | None
) -> tuple[Real, Real]:
    """Return mu and kappa, of which rho = mu²/kappa and the caller's numbers determine two."""
    if squared is None:
        return (1.0 if mu is None else mu), (1.0 if kappa is None else kappa)
    if mu is not None:
        return mu, (mu * mu / squared if kappa is None else kappa)
    kappa = 1.0 if kappa is None else kappa
    return plain(np.sqrt(squared * kappa)), kappa


def _scale(
    mu: Real, kappa: Real, cross: Real, psi1: Real, chi: Real, lam: Real, in_space: bool
) -> tuple[Real, Array]:
    """Return slip velocity and inverse mass in units with v1 = R = C = 1/W_nn = 1."""
    shapes = {"psi1": np.shape(psi1), "chi": np.shape(chi), "lam": np.shape(lam)}
    for name, trailing in (("psi1", (2,)), ("chi", (2, 2)), ("lam", (2,))) if in_space else ():
        whole = shapes[name] or trailing  # lam may be 0
        if whole[-len(trailing) :] != trailing:
            rule = f"must end with {trailing} in space"
            raise refuse(f"{name}.shape", whole, rule, "in the plane all are numbers")
        shapes[name] = whole[: -len(trailing)]
    shapes |= {"rho": np.broadcast_shapes(np.shape(mu), np.shape(kappa))}
    shapes |= {"cross_stiffness_ratio": np.shape(cross)}
    shape = batch.common_shape(shapes, what=SHAPES, remedy=EQUAL)
    mu, kappa = np.broadcast_to(mu, shape), np.broadcast_to(kappa, shape)
    W = np.zeros((*shape, 3, 3))
    W[..., 0, 0] = 1.0
    if in_space:
        coupling = np.asarray(lam) / mu[..., None]
        sides = np.stack(np.broadcast_arrays(kappa, kappa * cross), axis=-1)
        W[..., 1:, 1:] = 2.0 * np.asarray(chi) / sides[..., None]
        skew = np.abs(W[..., 1, 2] - W[..., 2, 1])
        if np.any(skew > ALIKE * np.sqrt(np.abs(W[..., 1, 1] * W[..., 2, 2]))):
            rule = "W must be symmetric: each row of chi over the stiffness of its direction"
            raise refuse(
                "chi", np.asarray(chi).tolist(), rule, "chi_21 = cross_stiffness_ratio chi_12"
            )
        slip = np.asarray(psi1) * mu[..., None] / sides
        W[..., 0, 1:] = W[..., 1:, 0] = coupling
        return np.broadcast_to(slip, (*shape, 2)), W
    W[..., 1, 1] = W[..., 2, 2] = 2.0 * chi / kappa
    W[..., 0, 1] = W[..., 1, 0] = lam / mu
    return plain(np.broadcast_to(psi1 * mu / kappa, shape)), W
