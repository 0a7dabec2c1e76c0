"""Importing loads no scipy, no matplotlib and no law; a long march holds few plain numbers."""

import json
import subprocess
import sys
import tracemalloc
from collections import deque

import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab_laws.march.division import midpoints, one_by_one
from tests.longer import longer

#: Modules that nothing here needs at first; NumPy 1 imports numpy.ma by itself.
SLOW = ("scipy", "matplotlib", "argparse", *(["numpy.ma"] if int(np.__version__[0]) > 1 else []))
PROBE = f"""
import json, sys
import contactlab
slow = {SLOW}
heavy = [name for name in sys.modules if name in slow]
laws = [name for name in sys.modules if name.startswith("contactlab_")]
print(json.dumps([heavy, laws]))
"""


def loaded(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


#: What is imported at first, what lists the laws, and what makes one.
STAGES = (
    "from contactlab import Encounter, Scene, Simulation, collide, load_path, rebound\n",
    "from contactlab.registry.registry import REGISTRY\nassert REGISTRY.names()\n",
    "contactlab.create('tangential.coulomb')\n",
)


@pytest.fixture(scope="module")
def stages():
    """Return what one interpreter has loaded after each stage: modules that are slow, and laws."""
    probe = PROBE.replace("print(", "told.append(")
    code = "told = []\n" + "".join(stage + probe for stage in STAGES)
    return loaded(
        code.replace("json.dumps([heavy, laws])", "[heavy, laws]") + "print(json.dumps(told))"
    )


def test_import_is_lean(stages):
    assert stages[0] == [[], []]


def test_a_public_name_is_imported_on_its_first_use():
    """``import contactlab`` takes as long as Python's own start, without NumPy."""
    lines = (
        "import sys, contactlab",
        "rooms = {'contactlab.registry', 'contactlab.impact'}",
        "assert not rooms & set(sys.modules) and 'numpy' not in sys.modules",
        "contactlab.Sphere",
        "assert 'contactlab.impact' in sys.modules and 'contactlab.registry' not in sys.modules",
        "assert set(contactlab.__all__) <= set(dir(contactlab))",
        "assert all(getattr(contactlab, name) is not None for name in contactlab.__all__)",
        "assert contactlab.contracts.__name__ == 'contactlab.contracts'",
        "assert not hasattr(contactlab, 'spam')",
    )
    subprocess.run([sys.executable, "-c", "\n".join(lines)], check=True)


@pytest.mark.parametrize("word", ["--version", "--help"])
def test_the_command_line_starts_without_numpy(word):
    lines = (
        "import sys",
        "from contactlab.cli.main import main",
        f"main(['{word}'])",
        "heavy = {'numpy', 'contactlab.registry.registry', 'contactlab.cli.run'}",
        "assert not heavy & set(sys.modules)",
    )
    subprocess.run([sys.executable, "-c", "\n".join(lines)], check=True, capture_output=True)


def test_listing_the_laws_imports_none(stages):
    assert stages[1] == [[], []]


def test_running_a_law_imports_no_other_law():
    lines = (
        "from contactlab import Scene, Simulation",
        "scene = Scene.nondimensional(psi1=[1.2], chi=1.44).take(0)",
        "Simulation(tangential='springs').run(scene, estimate_error=True)\n",
    )
    heavy, laws = loaded(PROBE.replace("import contactlab\n", "\n".join(lines)))
    assert heavy == []
    needed = {"hertz", "springs", "jaeger", "differences", "march", "compiled"}
    assert {name.split(".")[1] for name in laws if "." in name} == needed


#: What one elastic impact of spheres loads beside laws, contracts and numbers: nothing of bodies of
#: other shapes, of spin about the normal, of sweeps and files, of normal laws without closed form.
OF_A_RUN = """
acceptance answer answers batches bodies bound bring capability cautions composition
decoupled energy error_model failed_motion groups hertz history hooks installed inverse_mass
kinetics
law_classes law_words loading manager material motion names normal_motion
of_speed plan planning read_options registry result scene simulation solve tabled way
"""


def test_a_central_elastic_run_loads_no_module_for_other_scenes():
    lines = (
        "import json, sys",
        "from contactlab import Scene, Simulation",
        "Simulation().run(Scene.nondimensional(psi1=1.2, chi=1.44))",
        "names = [name.split('.') for name in sys.modules if name.startswith('contactlab.')]",
        "common = ('contracts', 'numeric')",
        "print(json.dumps([name[2] for name in names if name[2:] and name[1] not in common]))",
    )
    assert sorted(loaded("\n".join(lines))) == sorted(OF_A_RUN.split())


OTHERS = ("contactlab_fit", "contactlab_pages", "contactlab_halfspace", "contactlab.study")


@pytest.mark.parametrize("normal", ["hertz", *longer("viscoelastic")])
def test_a_run_loads_no_module_of_fits_pages_study_or_half_space(normal):
    lines = (
        "import json, sys",
        "from contactlab import HalfSpace, Material, Scene, Simulation, Sphere",
        "steel = Material.named('steel')",
        "ball, wall = Sphere(0.01, steel), HalfSpace(steel)",
        "mu = {0.0: 0.2, 2.0: 0.1}",
        "scene = Scene.at_angle(ball, wall, mu, speed=1.0, angle_deg=[10.0, 30.0])",
        f"result = Simulation(normal={normal!r}).run(scene)",
        "str(result.plan), str(result), result.psi2",
        "print(json.dumps([name for name in sys.modules if name.startswith('contactlab')]))",
    )
    names = loaded("\n".join(lines))
    assert "contactlab.runs.simulation" in names
    assert [name for name in names if name.startswith(OTHERS)] == []


def test_only_the_named_law_is_imported(stages):
    _, laws = stages[2]
    assert {name.split(".")[1] for name in laws if "." in name} == {"coulomb"}


def test_a_long_march_makes_plain_numbers_of_a_part_at_a_time():
    """Of two million steps they were 700 MB."""
    steps = midpoints(Simulation().normal_motion(Scene.nondimensional(psi1=1.2, chi=1.44)), 20_000)
    tracemalloc.start()
    deque(one_by_one(steps), maxlen=0)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 4e6
