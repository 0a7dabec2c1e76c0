"""Pure torsion of an elastic Hertz impact as integrals, theory §17: no springs, no march, no rings.

A spring at the radius s of the contact has the rotation min(Phi - Phi_s, l), of which Phi is the
integral of sigma over time, Phi_s its value when the contact's edge passes s, and
l = (2/pi) a (K - E)(1 - s²/a²) the limit. Exact while the edge slips one way only. Lengths are in
units of the largest radius, a = sin(x) at the phase x; sigma = (1 - nu/2) w.
"""

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import ellipe, ellipkm1

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(48)
#: Loading and unloading, in phases.
PIECES = ((0.0, 0.5 * np.pi), (0.5 * np.pi, np.pi))
HALVINGS = 80
#: Part of the radius below which the front is near the centre, where the limit has a logarithm.
NEAR = 0.05


def pace(phase):
    """dT/dx of the elastic Hertz impact."""
    a = np.sin(phase)
    return 2.0 * a / np.sqrt((1.0 + a + a**2 + a**3 + a**4) / (1.0 + a))


def limit(s, a):
    """The largest rotation of a spring at s in a contact of radius a."""
    ratio = np.clip((s / a) ** 2, 1e-300, 1.0)
    return 2.0 / np.pi * a * (ellipkm1(ratio) - ellipe(1.0 - ratio))


class Course:
    """The integral of a function of the phase over time, which is given at Chebyshev's nodes."""

    def __init__(self, values, begin):
        self.polynomials, last = [], begin
        for (low, high), nodes, each in zip(PIECES, phases(len(values[0])), values, strict=True):
            rate = chebyshev.chebfit(local(nodes, low, high), each * pace(nodes), len(each) - 1)
            series = chebyshev.chebint(rate) * 0.5 * (high - low)
            series[0] += last - chebyshev.chebval(-1.0, series)
            self.polynomials.append(series)
            last = chebyshev.chebval(1.0, series)
        self.end = float(last)

    def __call__(self, phase):
        late = phase > 0.5 * np.pi
        found = [
            chebyshev.chebval(local(np.clip(phase, *piece), *piece), series)
            for piece, series in zip(PIECES, self.polynomials, strict=True)
        ]
        return np.where(late, found[1], found[0])


def phases(count):
    """Chebyshev's nodes on each piece."""
    nodes = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return [low + 0.5 * (high - low) * (nodes + 1.0) for low, high in PIECES]


def local(phase, low, high):
    return 2.0 * (phase - low) / (high - low) - 1.0


def moments(angle, phase):
    """The integrals of s² times the rotation over the springs, at phases of shape (n,)."""
    a, turned = np.sin(phase), angle(phase)

    def excess(s):
        return turned - angle(np.arcsin(np.minimum(s, 1.0))) - limit(s, a)

    low, high = np.log(1e-14 * a), np.log(a * (1.0 - 1e-13))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        slips = excess(np.exp(middle)) > 0.0
        low, high = np.where(slips, low, middle), np.where(slips, middle, high)
    stuck = (excess(a * (1.0 - 1e-6)) <= 0.0) & (phase < 0.5 * np.pi)
    front = np.where(stuck, a, np.exp(high))
    share = 0.5 * (POINTS[:, None] + 1.0)
    inner = np.arcsin(np.minimum(front, 1.0)) * share  # s = sin(inner): Phi is smooth there
    part = np.sin(inner) ** 2 * np.cos(inner) * (turned - angle(inner))
    whole = 0.5 * np.arcsin(np.minimum(front, 1.0)) * (WEIGHTS @ part)
    power = np.where(front < NEAR * a, 2.0, 1.0)
    s = front + (a - front) * share**power
    part = s * s * limit(s, a) * power * share ** (power - 1.0)
    return whole + 0.5 * (a - front) * (WEIGHTS @ part)


def torsion(sigma1, chi_t, *, nodes=90, tolerance=1e-13):
    """sigma after an impact without slip, by Picard's iteration of sigma' = -15 chi_t M."""
    sigma = [np.full(nodes, float(sigma1)) for _ in PIECES]
    for _ in range(60):
        angle = Course(sigma, 0.0)
        rates = [-15.0 * chi_t * moments(angle, each) for each in phases(nodes)]
        course = Course(rates, sigma1)
        new = [course(each) for each in phases(nodes)]
        change = max(float(np.abs(p - q).max()) for p, q in zip(sigma, new, strict=True))
        sigma = new
        if change < tolerance:
            return course.end
    raise ArithmeticError(f"Picard's iteration moves by {change:.1e} still")
