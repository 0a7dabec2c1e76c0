"""The experiment of Kharaz, Gorham & Salman (2001) through the command line."""

from __future__ import annotations

import json
from pathlib import Path

KHARAZ = Path(__file__).parents[2] / "examples" / "kharaz2001.toml"


def test_elastic_law_is_near_the_measured_restitution_and_the_rigid_law_is_not(run):
    ran = run("compare", KHARAZ, "--json")
    restitution, angle, spin = json.loads(ran.out)["measured"]
    elastic, rigid = restitution["laws"]["fronts"], restitution["laws"]["coulomb"]
    assert elastic["largest"] < 0.04
    assert elastic["rms"] < 0.015
    assert rigid["largest"] > 0.11
    assert rigid["rms"] > 3.0 * elastic["rms"]
    assert angle["laws"]["fronts"]["largest"] < 0.35  # degrees
    assert angle["laws"]["coulomb"]["largest"] > 2.5
    assert spin["laws"]["fronts"]["rms"] < 25.0  # rad/s, of 136 to 613
    assert spin["laws"]["coulomb"]["rms"] > 3.0 * spin["laws"]["fronts"]["rms"]
