"""Laws that end their process, wait for ever, raise or write into what they are given."""

import os
import signal
import time
from pathlib import Path
from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import WholeImpactTangentialLaw
from contactlab.contracts.whole_impact import no_force


@attrs.frozen(kw_only=True)
class Ending(WholeImpactTangentialLaw):
    """No force; ends its process where psi1 is more than ``above``, or is ``at``, ``times`` times.

    ``folder`` counts the ends, for no process lives to do so. With a ``status`` the law calls
    ``os._exit`` with it, which runs nobody's handlers; without, the process is killed.
    """

    api_version: ClassVar[int] = 2
    folder: str
    above: float = np.inf
    at: float = np.inf
    times: int = 1000
    status: int | None = None

    def whole_impacts(self, scene, normal):
        if np.max(scene.psi1) > self.above or np.any(scene.psi1 == self.at):
            ends = Path(self.folder)
            if len(list(ends.iterdir())) < self.times:
                (ends / os.urandom(8).hex()).touch()
                if self.status is not None:
                    os._exit(self.status)
                os.kill(os.getpid(), signal.SIGKILL)
        return (no_force(scene, where=True, reason="a test"),)


@attrs.frozen(kw_only=True)
class Raising(WholeImpactTangentialLaw):
    """No force; raises where psi1 is more than ``above``, or writes there into the scene."""

    api_version: ClassVar[int] = 2
    above: float = 5.0
    writes: bool = False

    def whole_impacts(self, scene, normal):
        if np.max(scene.psi1) > self.above:
            if not self.writes:
                raise RuntimeError("too much")
            scene.tangential_velocity[0] *= 0.5
        return (no_force(scene, where=True, reason="a test"),)


@attrs.frozen(kw_only=True)
class Waiting(WholeImpactTangentialLaw):
    """Waits for ever, after it has left its process id in ``folder`` and printed a line."""

    api_version: ClassVar[int] = 2
    folder: str

    def whole_impacts(self, scene, normal):
        print("printed by a law", flush=True)
        (Path(self.folder) / str(os.getpid())).touch()
        while True:
            time.sleep(0.01)
