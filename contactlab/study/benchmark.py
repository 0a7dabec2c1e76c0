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
    """One door to the answer of one question, at one resolution.

    Attributes
    ----------
    question, method, options : str
        ``method`` is a function, or law and integrator; ``options`` are theirs in words.
    error_rms, error_worst : float
        Rms and largest error over the impacts, in psi2; of a course in force over mu P_max, of two
        contacts in m/s at 1 m/s. NaN if a run failed, and of a limit that answers nothing.
    books_worst : float
        Largest imbalance over the energy at the start; NaN if a run failed.
    time_s, sweep_time_s : float
        Processor time of one impact alone, and of each of many, in s.
    converges : bool
        Whether the law claims to converge to the continuum, or comes nearer to it by a factor of
        ``ALIKE`` over its resolutions; if not, no finer step helps.
    limit : bool
        True for what no door can beat, a copy of the numbers or one line of NumPy.
    peer : bool
        True for another engine. What stands as its error is the difference of its model from the
        exact answer, which is no numerical error.
    failed : int
        Number of impacts without an answer.
    status : str
        ``SUCCESS``, the first failure's name, or ``NOT_RUN``.
    """

    question: str = "sphere"
    method: str
    options: str = ""
    error_rms: float = np.nan
    error_worst: float = np.nan
    books_worst: float = np.nan
    time_s: float = np.nan
    sweep_time_s: float = np.nan
    failed: int = 0
    status: str = "SUCCESS"
    converges: bool = True
    limit: bool = False
    peer: bool = False

    @property
    def ok(self) -> bool:
        """Whether every impact has an answer."""
        return self.failed == 0


#: Times of a row, by the words for them.
TIMES = {"alone": "time_s", "of many": "sweep_time_s"}


@attrs.frozen(kw_only=True)
class Benchmark:
    """Rows, and for each method the order of convergence observed in its rms error.

    ``complete`` is False if the time limit or Ctrl-C left rows out; ``interrupted`` is True on
    Ctrl-C. ``left_out`` names the engines that are not installed.
    """

    rows: tuple[Row, ...]
    orders: dict[str, float]
    complete: bool
    interrupted: bool = False
    left_out: tuple[str, ...] = ()

    def by_question(self) -> dict[str, list[Row]]:
        """Return the rows of each question."""
        found: dict[str, list[Row]] = {}
        for row in self.rows:
            found.setdefault(row.question, []).append(row)
        return found

    def front(self, question: str, time: str = "alone") -> list[Row]:
        """Return the Pareto front of a question: rows that no row beats in both error and time.

        ``time`` is a key of ``TIMES``; limits and other engines are left out.
        """
        column = TIMES[time]
        rows = [row for row in self.rows if row.question == question and row.ok]
        rows = [row for row in rows if not (row.limit or row.peer)]
        rows = [row for row in rows if getattr(row, column) == getattr(row, column)]
        best: list[Row] = []
        least = np.inf
        for row in sorted(rows, key=lambda row: (getattr(row, column), row.error_rms)):
            if row.error_rms < least:
                best.append(row)
                # Errors below rounding are equally good.
                least = row.error_rms if row.error_rms > ROUNDING else 0.0
        return best

    def short(self) -> list[Row]:
        """Return one or two rows of each law of each question, the most accurate law first.

        One is the quickest row with an error up to ``GOOD``, or ``ALIKE`` times the least of its
        law. Before it stands the most accurate row, if its error is smaller by ``FINER``.
        """
        return [row for rows in self.by_question().values() for row in _shorten(rows)]


def _shorten(of_question: list[Row]) -> list[Row]:
    """Return one or two rows of each law of a question."""
    by_law: dict[str, list[Row]] = {}
    for row in of_question:
        if row.ok and not (row.limit or row.peer):
            by_law.setdefault(row.method.partition(" / ")[0], []).append(row)
    chosen = []
    for rows in by_law.values():
        best = min(rows, key=lambda row: (row.error_rms, row.time_s))
        limit = max(GOOD, ALIKE * best.error_rms)
        quick = min((row for row in rows if row.error_rms <= limit), key=lambda row: row.time_s)
        finer = best.error_rms * FINER <= quick.error_rms
        chosen.append([best, quick] if finer and best.time_s > quick.time_s else [quick])
    return [row for rows in sorted(chosen, key=lambda rows: rows[0].error_rms) for row in rows]
