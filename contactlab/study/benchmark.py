"""The rows of a benchmark, and the few of them that a short table shows."""

from __future__ import annotations

import attrs
import numpy as np

#: Errors below this are rounding; orders are fitted to errors above it.
ROUNDING = 1e-11
#: The short table takes rows with an error up to ``GOOD``, or ``ALIKE`` times the least error of
#: their law; the most accurate row too, if its error is smaller by a factor of ``FINER``.
GOOD, ALIKE, FINER = 1e-3, 2.0, 10.0


@attrs.frozen(kw_only=True)
class Row:
    """One method at one resolution.

    Attributes
    ----------
    method, options : str
        Law and integrator; their options in words.
    error_rms, error_worst : float
        Rms and largest error of psi2 over the scenes; NaN if a run failed.
    force_error_rms : float
        Rms error of F over mu P_max along the impact, against the exact history; NaN if a run
        failed.
    elsewhere_rms : float
        Rms error of psi2 over the scenes beyond solid spheres; NaN if a run failed.
    books_worst : float
        Largest imbalance over the energy at the start; NaN if a run failed.
    time_s, sweep_time_s : float
        Run time per impact, by itself and in a sweep, in s.
    converges : bool
        Whether the law claims to converge to the continuum, or comes nearer to it by a factor of
        ``ALIKE`` over its resolutions; if not, no finer step helps.
    failed : int
        Number of scenes without an answer.
    status : str
        ``SUCCESS``, the first failure's name, or ``NOT_RUN``.
    """

    method: str
    options: str = ""
    error_rms: float = np.nan
    error_worst: float = np.nan
    force_error_rms: float = np.nan
    books_worst: float = np.nan
    time_s: float = np.nan
    sweep_time_s: float = np.nan
    failed: int = 0
    status: str = "SUCCESS"
    elsewhere_rms: float = np.nan
    converges: bool = True

    @property
    def ok(self) -> bool:
        """Whether every scene has an answer."""
        return self.failed == 0


@attrs.frozen(kw_only=True)
class Benchmark:
    """Rows, and for each method the order of convergence observed in its rms error.

    ``complete`` is False if the time limit or Ctrl-C left rows out; ``interrupted`` is True on
    Ctrl-C.
    """

    rows: tuple[Row, ...]
    orders: dict[str, float]
    complete: bool
    interrupted: bool = False

    def front(self) -> list[Row]:
        """Return the Pareto front: rows that no other row beats in both error and time."""
        best: list[Row] = []
        least = np.inf
        for row in sorted((row for row in self.rows if row.ok), key=lambda row: row.time_s):
            if row.error_rms < least:
                best.append(row)
                # Errors below rounding are equally good.
                least = row.error_rms if row.error_rms > ROUNDING else 0.0
        return best

    def short(self) -> list[Row]:
        """Return one or two rows of each law, the most accurate law first.

        One is the quickest row with an error up to ``GOOD``, or ``ALIKE`` times the least of its
        law. Before it stands the most accurate row, if its error is smaller by ``FINER``.
        """
        by_law: dict[str, list[Row]] = {}
        for row in self.rows:
            if row.ok:
                by_law.setdefault(row.method.partition(" / ")[0], []).append(row)
        chosen = []
        for rows in by_law.values():
            best = min(rows, key=lambda row: (row.error_rms, row.time_s))
            limit = max(GOOD, ALIKE * best.error_rms)
            quick = min((row for row in rows if row.error_rms <= limit), key=lambda row: row.time_s)
            finer = best.error_rms * FINER <= quick.error_rms
            chosen.append([best, quick] if finer and best.time_s > quick.time_s else [quick])
        return [row for rows in sorted(chosen, key=lambda rows: rows[0].error_rms) for row in rows]
