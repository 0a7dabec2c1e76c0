"""Every result has the same doors: plain numbers, frame, data set, a notebook's view, a figure."""

import html
import json
from functools import cache

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, collide, load_path, shapes
from contactlab.study import compare
from tests.collisions.gathered import row
from tests.present import extra

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
BALL, PLATE = Sphere(0.01, STEEL), HalfSpace(STEEL)
LAWS = {"first": Simulation(), "second": Simulation(tangential="coulomb")}
SPHERES = Scene(BALL, PLATE, 0.3, 1.0, np.array([0.2, 0.5, 1.5]))
DOWN = (0.0, 0.0, -1.0)


def rods():
    rod, contact = shapes.rod(
        length=0.1, radius=0.01, material=STEEL, normal=DOWN, axis=[0.6, 0.0, 0.8]
    )
    velocity = [(0.5, 0.0, -1.0), (0.1, 0.2, -2.0)]
    return contactlab.Encounter(rod, PLATE, 0.3, normal=DOWN, velocity=velocity, contact=contact)


def balls():
    return contactlab.Encounter(
        BALL, BALL, 0.2, normal=DOWN, velocity=[(0.5, 0.0, -1.0), (0.0, 0.0, 1.0)]
    )


@cache
def results():
    """Return results by name, each with a column and the numbers that it must hold."""
    made = {}
    sphere, body = LAWS["first"].run(SPHERES, history=True), LAWS["first"].run(rods().scene)
    made["spheres"] = sphere, "psi2", sphere.psi2
    made["one sphere"] = sphere[1], "rebound_spin", sphere.rebound_spin[1]
    made["bodies"] = body, "normal_restitution", body.normal_restitution
    made["one body"] = body[0], "friction_work", body.energy.friction_work[0]
    for name, met in {"balls": balls(), "rods": rods(), "one ball": balls().take(0)}.items():
        hit = collide(met, separating="pass")
        made[f"collision of {name}"] = hit, "velocity_x", hit.velocity[..., 0]
    hit = collide(rods().take(1), LAWS["first"])
    made["collision of one rod"] = hit, "target_velocity_z", hit.target_velocity[2]
    several = collide(row(3, mu=0.1, spin=10.0), history=True)
    made["gathering"] = several, "spin_z", several.spin[:, 2]
    many = collide(row(3, mu=0.1, spin=10.0, gaps=[np.array([0.0, 1e-5]), 0.0]))
    made["gatherings"] = many, "velocity_y", many.velocity[..., 1]
    comparison = compare(SPHERES, LAWS)
    made["comparison"] = comparison, "psi2", [comparison.values("psi2", law) for law in LAWS]
    one = compare(rods().take(0).scene, LAWS)
    made["comparison of one body"] = one, "rebound_slip_velocity", [
        one.values("rebound_slip_velocity", law) for law in LAWS
    ]  # fmt: skip
    made["history"] = sphere[1].history, "normal_force", sphere.history.normal_force[:, 1]
    made["histories"] = sphere.history, "slip_velocity", sphere.history.slip_velocity
    made["history of contacts"] = several.history, "normal_force", several.history.normal_force
    to = np.linspace(0.0, 1e-6, 20)
    path = load_path(SPHERES.take(0), np.full(20, 1e-6), np.concatenate([to[:10], to[9::-1]]))
    made["path"] = path, "friction_force", path.friction_force
    paths = load_path(SPHERES, np.full((20, 3), 1e-6), to[:, None] * [0.5, 1.0, 2.0])
    made["paths"] = paths, "work", paths.work
    return made


NAMES = [
    "spheres", "one sphere", "bodies", "one body", "collision of balls", "collision of rods",
    "collision of one ball", "collision of one rod", "gathering", "gatherings", "comparison",
    "comparison of one body", "history", "histories", "history of contacts", "path", "paths",
]  # fmt: skip


def test_every_result_is_asked():
    assert list(results()) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_a_result_is_told_in_plain_numbers(name):
    result, column, values = results()[name]
    told = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    if column in told:
        assert np.array(told[column], dtype=float) == pytest.approx(np.asarray(values), nan_ok=True)
    else:  # vectors are lists of three, and laws have entries of their own
        assert told.keys() & {column.rpartition("_")[0], "laws"}


@extra("pandas")
@pytest.mark.parametrize("name", NAMES)
def test_a_result_is_a_frame(name):
    result, column, values = results()[name]
    frame = result.to_dataframe()
    assert frame[column].to_numpy() == pytest.approx(np.ravel(values), nan_ok=True)
    assert {*frame.columns} <= frame.attrs["units"].keys()
    assert all(isinstance(name, str) and name for name in frame.index.names)


@extra("xarray")
@pytest.mark.parametrize("name", NAMES)
def test_a_result_is_a_data_set(name):
    result, column, values = results()[name]
    data = result.to_xarray()
    assert data[column].values == pytest.approx(np.asarray(values), nan_ok=True)
    assert data[column].attrs["units"]


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_shows_the_words(name):
    result, *_ = results()[name]
    shown = html.unescape(result._repr_html_())
    assert shown == f"<pre>{result}</pre>"


@pytest.mark.parametrize("name", NAMES)
def test_a_result_is_drawn(name):
    from matplotlib.figure import Figure

    result, *_ = results()[name]
    axes = Figure().subplots()
    if name in ("one sphere", "history", "histories", "history of contacts", "gathering"):
        columns = ()  # forces over time
    elif name.startswith(("one", "collision of one", "gatherings", "comparison of one")):
        with pytest.raises(ValueError, match=r"history|single"):
            result.plot(axes=axes)
        return
    else:
        columns = {"comparison": ("psi2",), "path": (), "paths": ()}.get(name, ())
    assert result.plot(*columns, axes=axes) is axes
    assert axes.get_ylabel()
    assert axes.lines


def test_columns_are_drawn_over_each_other():
    from matplotlib.figure import Figure

    path, *_ = results()["paths"]
    axes = path.plot("approach", "friction_work", axes=Figure().subplots())
    assert len(axes.lines) == 3
    assert axes.lines[2].get_ydata() == pytest.approx(path.friction_work[:, 2])
    assert axes.get_xlabel() == "approach (m)"
    hits = results()["collision of balls"][0]
    axes = hits.plot("velocity_z", "spin_y", axes=Figure().subplots())
    order = np.argsort(hits.velocity[:, 2])
    assert axes.lines[0].get_ydata() == pytest.approx(hits.spin[order, 1])
    loop = results()["path"][0]  # goes back: its curve is not sorted
    drawn = loop.plot(axes=Figure().subplots()).lines[0]
    assert drawn.get_xdata().tolist() == loop.displacement.tolist()


@pytest.mark.parametrize(("name", "column"), [("spheres", "psi2"), ("gathering", "spin_z")])
def test_a_column_over_itself_is_refused(name, column):
    told = f"x, y = '{column}': is drawn over itself; write y='{column}'"
    with pytest.raises(ValueError, match=told):
        results()[name][0].plot(column, column)


@pytest.mark.parametrize("name", ["collision of balls", "path", "history", "gathering"])
def test_an_unknown_column_is_refused(name):
    with pytest.raises(ValueError, match=r"y = 'friction': is not a column of numbers; .*known: "):
        results()[name][0].plot(y="friction")


@extra("pandas")
def test_rows_of_a_gathering_are_bodies_or_contacts():
    several, many = results()["gathering"][0], results()["gatherings"][0]
    frame = many.to_dataframe("contacts")
    assert frame.index.names == ["gathering", "contact"]
    assert frame.loc[(1, "touches[0]"), "impulse_x"] == many.impulse[1, 0, 0]
    assert frame.attrs["units"]["impulse_x"] == "N s"
    assert several.to_dataframe().index.tolist() == ["0", "1", "2"]
    with pytest.raises(ValueError, match="rows = 'links': must be 'bodies' or 'contacts'"):
        several.to_dataframe("links")


@extra("pandas")
def test_a_history_is_over_time_and_laws_are_beside_each_other():
    history = results()["history"][0]
    assert history.to_dataframe().index.to_numpy() == pytest.approx(history.time)
    comparison = results()["comparison"][0]
    frame = comparison.to_dataframe()
    assert frame.index.names == ["law", "impact"]
    assert frame.loc[("second", 2), "psi2"] == comparison.values("psi2", "second")[2]


def test_a_history_keeps_its_axes_when_it_is_copied():
    history = results()["history of contacts"][0]
    assert attrs.evolve(history).last_axis == "contact"


def test_collisions_and_gatherings_tell_how_bodies_move():
    hits = results()["collision of balls"][0]
    told = str(hits).splitlines()[1:]
    assert (
        told[0] == "  encounter 0, body: velocity (0.398021, 0, 0) m/s, spin (0, 25.4947, 0) rad/s"
    )
    assert hits.velocity[0] == pytest.approx([0.398021, 0.0, 0.0], abs=1e-6)
    assert told[3].startswith("  encounter 1, target: velocity (0, 0, 0) m/s")
    assert "target: velocity" in str(results()["collision of one ball"][0])
    rod = results()["collision of one rod"][0]
    assert f"velocity={rod.velocity}" in str(rod)
    speed = [(0.0, 0.0, -1.0)] * 7
    many = collide(contactlab.Encounter(BALL, PLATE, 0.2, normal=DOWN, velocity=speed))
    assert "... and 1 more: to_dataframe()" in str(many)
    several = results()["gathering"][0]
    told = str(several).splitlines()[3]
    assert told.startswith("  bodies[2]: velocity (0.994551, ")
    assert several.velocity[2, 0] == pytest.approx(0.994551, abs=1e-6)


#: Cells of a notebook, each of which ends with a result.
CELLS = (
    "import numpy as np\n"
    "from contactlab import *\n"
    "from contactlab.study import compare\n"
    "from contactlab_fit import fit\n"
    "steel = Material.named('steel')\n"
    "ball, scene = Sphere(.01, steel), None\n"
    "scene = Scene(ball, HalfSpace(steel), .2, 1., np.array([.2, .5, 1.]))\n"
    "result = Simulation().run(scene, history=True)\n"
    "result",
    "result[0].history",
    "result.plan",
    "compare(scene, {'one': Simulation(), 'other': Simulation(tangential='coulomb')})",
    "down = [0, 0, -1]\n"
    "collide(Encounter(ball, HalfSpace(steel), .2, normal=down, velocity=[.5, 0, -1]))",
    "bodies = [Body(ball, velocity=[1, 0, 0]), Body(ball)]\n"
    "collide(Gathering(bodies, [Touch(0, 1, .1, normal=[1, 0, 0])]))",
    "load_path(scene.take(0), np.full(20, 1e-6), np.linspace(0., 1e-6, 20))",
    "Simulation().sweep(scene, into='swept')",
    "angles = np.array([10., 20., 30., 40., 50., 60.])\n"
    "one = Scene(ball, HalfSpace(steel), .2, 1., np.tan(np.radians(angles)))\n"
    "measured = {'angle_deg': angles, 'speed (m/s)': 1 / np.cos(np.radians(angles)),\n"
    "            'tangential_restitution': Simulation().run(one).tangential_restitution}\n"
    "fit(measured, one)",
)  # fmt: skip


@pytest.mark.slow
def test_a_notebook_shows_every_result(tmp_path):
    """Run by a kernel of Jupyter."""
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    cells = [nbformat.v4.new_code_cell(text) for text in CELLS]
    book = nbformat.v4.new_notebook(cells=cells)
    metadata = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(book, timeout=120, resources=metadata).execute()
    for cell in book.cells:
        (shown,) = [each for each in cell.outputs if each.output_type == "execute_result"]
        assert html.unescape(shown.data["text/html"]) != shown.data["text/plain"]
        assert shown.data["text/html"].startswith("<pre>")
