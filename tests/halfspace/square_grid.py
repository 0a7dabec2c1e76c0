"""A second solver of the three-dimensional half-space: square cells, FFT, projected gradients.

Tractions are constant on square cells. The influence of a cell is the integral of Boussinesq's and
Cerruti's solutions over the cell, in closed form. Steps are even in the phase of the Hertz impact.
It shares no code and no discretisation with the law. Scaled as in theory §9.
"""

import numpy as np
from scipy.special import betainc


def corners(antiderivative, x, y, half):
    """The integral over a cell around (x, y) of a function, from its mixed antiderivative."""
    total = 0.0
    for sx in (-1, 1):
        for sy in (-1, 1):
            total = total + sx * sy * antiderivative(x + sx * half, y + sy * half)
    return total


def influences(cells, half):
    """The transforms of 1/r, (x² - y²)/r³, 2xy/r³ and x/r² over cells, on twice the grid."""
    line = np.fft.fftfreq(2 * cells, 1.0 / (2 * cells)) * 2.0 * half
    x, y = np.meshgrid(line, line, indexing="ij")

    def xx(x, y):
        return y * np.arcsinh(x / np.abs(y))

    def yy(x, y):
        return x * np.arcsinh(y / np.abs(x))

    kernels = [
        corners(lambda x, y: xx(x, y) + yy(x, y), x, y, half),
        corners(lambda x, y: xx(x, y) - yy(x, y), x, y, half),
        corners(lambda x, y: -2.0 * np.hypot(x, y), x, y, half),
        corners(lambda x, y: x * np.arctan(y / x) + y * np.log(np.hypot(x, y)), x, y, half),
        corners(lambda x, y: y * np.arctan(x / y) + x * np.log(np.hypot(x, y)), x, y, half),
    ]
    return [np.fft.rfft2(each) for each in kernels]


class SquareGrid:
    """A half-space on ``cells`` x ``cells`` squares over (-1.06, 1.06)²."""

    def __init__(self, cells, poisson, drag, lift):
        self.cells, self.poisson, self.drag, self.lift = cells, poisson, drag, lift
        half = 1.06 / cells
        self.area = (2.0 * half) ** 2
        line = (np.arange(cells) + 0.5) * 2.0 * half - 1.06
        self.x, self.y = np.meshgrid(line, line, indexing="ij")
        self.square = self.x**2 + self.y**2
        factor = 2.0 / np.pi**2
        self.kernels = [factor * each for each in influences(cells, half)]

    def _forward(self, field):
        return np.fft.rfft2(field, s=(2 * self.cells, 2 * self.cells))

    def _back(self, transform):
        return np.fft.irfft2(transform)[: self.cells, : self.cells]

    def sheared(self, qx, qy):
        """The tangential displacements of tractions."""
        one, two, both, _, _ = self.kernels
        a, b = self._forward(qx), self._forward(qy)
        cross = self.poisson / (2.0 - self.poisson)
        ux = one * a + cross * (two * a + both * b)
        uy = one * b + cross * (both * a - two * b)
        return np.stack((self._back(ux), self._back(uy)))

    def dragged(self, p):
        """The tangential displacements of a pressure."""
        hat = self._forward(p)
        return -self.drag * np.stack([self._back(each * hat) for each in self.kernels[3:]])

    def pressed(self, p):
        """The normal displacement of a pressure."""
        return self._back(self.kernels[0] * self._forward(p))

    def lifted(self, q):
        """The normal displacement of tractions."""
        hats = [k * self._forward(each) for k, each in zip(self.kernels[3:], q, strict=True)]
        return self.lift * self._back(sum(hats))

    def force(self, traction):
        """(3/2 pi) times the integral."""
        return 1.5 / np.pi * self.area * float(traction.sum())

    def moment(self, traction):
        """(3/2 pi) times the integral of the moment about the centre."""
        moments = self.x * traction[1] - self.y * traction[0]
        return 1.5 / np.pi * self.area * float(moments.sum())

    def pressure(self, depth, start, tolerance=1e-6):
        """The pressure under ``depth`` of surfaces that touch where it is positive."""
        return descend(
            self.pressed, lambda p: np.maximum(p, 0.0), depth, start, self.stiffest(), tolerance
        )

    def traction(self, aim, limit, start, tolerance=1e-6):
        """The tractions with abs(q) <= limit whose slip, aim less displacement, is along them."""

        def cut(q):
            length = np.sqrt((q * q).sum(axis=0))
            return q * np.minimum(1.0, limit / np.maximum(length, 1e-300))

        stiffest = self.stiffest() * 2.0 / (2.0 - self.poisson)
        return descend(lambda q: self.sheared(*q), cut, aim, start, stiffest, tolerance)

    def stiffest(self):
        """A bound of the largest compliance of the grid."""
        return float(np.abs(self.kernels[0]).max())


def descend(operator, cut, aim, start, largest, tolerance):
    """Minimise ½ q·Kq - q·aim over a convex set by accelerated projected gradients, restarted."""
    now, ahead, momentum = start, start, 1.0
    for _ in range(600):
        gradient = operator(ahead) - aim
        new = cut(ahead - gradient / largest)
        change = new - now
        if float(((ahead - new) * change).sum()) > 0.0:
            momentum = 1.0
        following = 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * momentum**2))
        ahead = new + (momentum - 1.0) / following * change
        now, momentum = new, following
        if float(np.abs(change).max()) < tolerance * max(float(np.abs(new).max()), 1e-12):
            break
    return now


def rebound(grid, psi1, chi, *, steps=60, two_way=False, w1=0.0, chi_w=0.0):
    """psi2, the normal restitution, and w2 of spin about the normal."""
    angle = np.linspace(0.0, np.pi, steps + 1)
    depth = np.sin(angle) ** 0.8  # zeta; V = cos(angle)
    half = 0.5 * 2.9432751843
    time = half * betainc(0.4, 0.5, np.sin(angle) ** 2)
    time = np.where(angle <= 0.5 * np.pi, time, 2.0 * half - time)
    zero = np.zeros_like(grid.square)
    p, q = zero, np.stack((zero, zero))
    slip = q.copy()
    psi, moved, share, approach, rate, excess = psi1, 0.0, 0.0, 0.0, 0.0, 0.0
    w, turned, couple, circles = w1, 0.0, 0.0, np.stack((-grid.y, grid.x))
    for k in range(1, steps):
        gap = time[k] - time[k - 1]
        gain = 2.0 * chi * (np.cos(angle[k - 1]) - np.cos(angle[k])) + 2.5 * chi * gap * excess
        after, surplus, now = share, excess, approach
        pull = chi_w / chi * gain
        turned += gap * (w - 0.5 * pull * couple)
        for _ in range(5 if two_way else 2):
            now = approach + gap * rate - 1.25 * gap**2 * (excess / 3.0 + surplus / 6.0)
            raised = depth[k] + now - 0.5 * grid.square
            if two_way:
                raised = raised - grid.lifted(q)
            p = grid.pressure(raised, p)
            load = grid.force(p)
            total = moved + gap * (psi - gain * (share / 3.0 + after / 6.0))
            carried = grid.dragged(p)
            uniform = np.stack((zero + total, zero)) + turned * circles
            q = grid.traction(uniform - carried - slip, p, q)
            after = grid.force(q[0]) / load
            surplus = load - depth[k] ** 1.5 if two_way else 0.0
            if k == 1:
                share = after
        slip = uniform - carried - grid.sheared(*q)
        moved = total
        gain += 1.25 * chi * gap * (surplus - excess)
        psi -= 0.5 * gain * (share + after)
        w -= 0.5 * pull * (couple + grid.moment(q) / load)
        couple = grid.moment(q) / load
        rate -= 0.625 * gap * (excess + surplus)
        share, approach, excess = after, now, surplus
    gain = 2.0 * chi * (np.cos(angle[-2]) - np.cos(angle[-1]))
    return psi - gain * share, 1.0 - rate, w - chi_w / chi * gain * couple
