"""Numbers that nobody gave: those that a fit takes are listed, and no other one enters it."""

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Sphere, fit
from contactlab.cli.main import main
from contactlab_fit import rank
from tests.fitting.impacts import ANGLES, BODIES, STEEL, restitution, table
from tests.longer import longer

FRICTION = 0.12
BALL = "[sphere]\nradius = 0.01\nmaterial = 'steel'\n"
FLOOR = "[target]\nkind = 'half-space'\nmaterial = 'steel'\n"
ROD = "[body]\nshape = 'rod'\nlength = 0.1\nradius = 0.01\ntilt_deg = 30\nmaterial = 'steel'\n"
ALONG = "[impact]\nnormal = [0, 0, -1]\nalong = [1, 0, 0]\n"
SPIN, TURN = "spin = 0 rad/s before each impact", "normal_spin = 0 rad/s before each impact"
ELASTIC = "restitution = 1: the laws are elastic where none is named"
SOLID = "sphere.gyration_ratio = 0.6325: a solid ball"
#: e = 0.8, and tangential velocities of no law.
LOSSY = {
    "normal_speed (m/s)": [3.0, 3.0, 3.0, 3.0],
    "tangential_velocity (m/s)": [1.0, 2.0, 4.0, 6.0],
    "rebound_normal_velocity (m/s)": [-2.4, -2.4, -2.4, -2.4],
    "rebound_tangential_velocity (m/s)": [0.66, 1.23, 2.49, 4.38],
}
NORMAL = {name: LOSSY[name] for name in list(LOSSY)[:3]}


def scene_file(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def elastic():
    return table(restitution(FRICTION))


@pytest.mark.parametrize(
    ("text", "columns", "taken"),
    [
        (BALL + FLOOR, {}, {SPIN, TURN, SOLID}),
        (BALL + FLOOR, {"spin (rad/s)": np.zeros(len(ANGLES))}, {TURN, SOLID}),
        (BALL + FLOOR + "[impact]\nspin = 0.0\nnormal_spin = 0.0\n", {}, {SOLID}),
        (BALL + "gyration_ratio = 0.6324555320336759\n" + FLOOR, {}, {SPIN, TURN}),
        (
            BALL + "[target]\nkind = 'sphere'\nradius = 0.01\nmaterial = 'steel'\n",
            {},
            {
                SPIN,
                TURN,
                SOLID,
                SOLID.replace("sphere", "target"),
                "target_normal_velocity = 0 before each impact",
                "target_tangential_velocity = 0 before each impact",
                "target_spin = 0 before each impact",
            },
        ),
        (
            BALL + FLOOR + "[impact]\ntarget_normal_velocity = 0.0\n",
            {},
            {SPIN, TURN, SOLID, "target_tangential_velocity = 0 before each impact"},
        ),
    ],
)
def test_what_stands_in_neither_table_nor_scene_is_listed(tmp_path, text, columns, taken):
    data = elastic() | columns
    if "kind = 'sphere'" in text:
        del data["tangential_restitution"]
        data["beta0"] = np.linspace(-0.5, 0.5, len(ANGLES))
    if "target_normal" in text:
        data["rebound_tangential_velocity (m/s)"] = (
            data.pop("tangential_restitution") * 2.0 * np.sin(np.radians(ANGLES))
        )
    found = fit(data, scene_file(tmp_path, text))
    assert set(found.taken) == taken | {ELASTIC}
    assert found.to_dict()["taken"] == list(found.taken)
    for one in found.taken:
        assert f"  taken: {one}" in str(found).splitlines()


def test_an_oblique_velocity_that_nobody_gave_is_listed(tmp_path):
    drops = {name: NORMAL[name] for name in NORMAL if "tangential" not in name}
    found = fit(drops, scene_file(tmp_path, BALL + FLOOR), parameters=["restitution"])
    assert "tangential_velocity = 0 m/s before each impact" in found.taken


def test_a_scene_in_python_has_what_is_not_the_default():
    turning = attrs.evolve(BODIES, spin=1.0, normal_spin=2.0)
    shell = attrs.evolve(BODIES, sphere=Sphere(0.01, STEEL, gyration_ratio=0.8))
    assert set(fit(elastic(), BODIES).taken) == {SPIN, TURN, SOLID, ELASTIC}
    assert set(fit(elastic(), turning).taken) == {SOLID, ELASTIC}
    assert SOLID not in fit(elastic(), shell).taken
    groups = Scene.nondimensional(psi1=np.linspace(0.5, 5.0, 6), chi=1.4)
    psi2 = Simulation(tangential="coulomb").sweep(groups).psi2
    (found,) = rank({"psi2": psi2}, groups, {"walton": Simulation(tangential="walton")},
                    parameters=["beta0"])  # fmt: skip
    assert not found.fit or found.fit.taken == ()


@pytest.mark.parametrize(
    ("laws", "parameters", "taken"),
    [
        ({"tangential": "walton"}, ["friction_coefficient"], "tangential.beta0 = 0.4"),
        *longer(({"normal": "tsuji"}, ["friction_coefficient"], "normal.restitution = 0.9")),
        ({"normal": "viscoelastic"}, ["restitution"], "tangential.shear_loss = 1"),
    ],
)
def test_defaults_of_laws_that_are_not_fitted_are_listed(laws, parameters, taken):
    angles = ANGLES[-3:]
    data = table(restitution(FRICTION, angles), angles)
    if "normal" in laws:
        data |= {"normal_restitution": np.full(len(angles), 0.9)}
    found = fit(data, BODIES, parameters=parameters, simulation=Simulation(**laws))
    assert f"{taken}: the default of its law" in found.taken
    assert not any(one.startswith(f"{name} =") for one in found.taken for name in found.parameters)
    assert ELASTIC not in found.taken


@pytest.mark.parametrize(
    ("text", "columns", "parameters"),
    [(BALL + FLOOR, LOSSY, ["restitution"]), (BALL + FLOOR, NORMAL, ["restitution"])],
)
def test_without_friction_a_fit_is_that_of_the_normal_numbers(tmp_path, text, columns, parameters):
    path = scene_file(tmp_path, text)
    found = fit(columns, path, parameters=parameters)
    assert found["normal.restitution"] == pytest.approx(0.8, abs=1e-7)
    assert list(found.predicted) == ["rebound_normal_velocity"]
    said = [note for note in found.notes if "stands in neither table nor scene" in note]
    assert len(said) == (columns is LOSSY)
    assert not any("Lambda" in caution for caution in found.cautions)  # which friction sets
    entries = {"normal_speed": [3.0], "tangential_velocity": [1.0]}
    unknown = found.predict(**entries)
    assert np.isnan(unknown.tangential_restitution).all()
    known = found.predict(**entries, friction_coefficient=[0.3])
    assert np.isfinite(known.tangential_restitution).all()
    np.testing.assert_array_equal(unknown.normal_restitution, known.normal_restitution)


@pytest.mark.parametrize("given", ["column", "scene", *longer("fitted")])
def test_the_remedies_of_a_missing_friction_work(tmp_path, given):
    text, columns, parameters = BALL + FLOOR, LOSSY, ["restitution"]
    if given == "column":
        columns = columns | {"friction_coefficient": [0.15] * 4}
    elif given == "scene":
        text += "[impact]\nfriction_coefficient = 0.15\n"
    else:
        parameters = ["restitution", "friction_coefficient"]
    found = fit(columns, scene_file(tmp_path, text), parameters=parameters)
    assert set(found.predicted) == {"rebound_normal_velocity", "rebound_tangential_velocity"}


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        (BALL + FLOOR, {n: LOSSY[n] for n in LOSSY if "normal_v" not in n}),
        *longer((ROD + FLOOR + ALONG, {name: values[:1] for name, values in LOSSY.items()})),
    ],
    ids=["sphere", "rod"],
)
def test_numbers_that_friction_moves_are_refused_without_it(tmp_path, text, columns):
    laws = None if text.startswith(BALL) else Simulation(normal="tsuji", tangential="springs")
    with pytest.raises(ValueError, match=r"friction_coefficient: stands in neither.*fit friction"):
        fit(columns, scene_file(tmp_path, text), parameters=["restitution"], simulation=laws)


def test_the_command_lists_what_is_taken(tmp_path, capsys):
    path, data = scene_file(tmp_path, BALL + FLOOR), tmp_path / "impacts.csv"
    np.savetxt(data, np.transpose([*LOSSY.values()]), header=",".join(LOSSY), comments="",
               delimiter=",")  # fmt: skip
    command = ["fit", str(data), str(path), "--fit", "restitution", "--bootstrap", "0"]
    assert main(command) == 0
    out = capsys.readouterr().out
    assert "taken, for no table or scene has them:\n  tangential.shear_loss = 1" in out
    assert f"  {SPIN}\n" in out
    assert "rebound_tangential_velocity: not met, for friction_coefficient stands in" in out
