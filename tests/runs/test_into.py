"""Sweeps into a folder: the columns of the same sweep in memory, part after part."""

import errno
import html
import json
import shutil
import subprocess
import sys
import zlib
from concurrent.futures import Future, ThreadPoolExecutor

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import (
    Encounter,
    HalfSpace,
    ImpactError,
    Material,
    Scene,
    Simulation,
    Sphere,
    Status,
    SweepFolder,
)
from contactlab.outcome.columns import columns, unit_in
from contactlab.runs.workers import processes
from tests.full_disk import full_disk
from tests.laws.ending_laws import Raising
from tests.laws.random_laws import RandomStepped
from tests.present import extra
from tests.runs.test_sweep import CHI, RIGID, blocks_of, scene

STEEL = Material.named("steel")
BODIES = Sphere(0.01, STEEL), HalfSpace(STEEL)
COUPLED = {"psi1": [0.5, 2.0, 3.0, 4.0], "chi": 2.0, "lam": [0.1, -0.2, 0.1, 0.0], "rho": 0.5}
#: Scenes with columns of every kind: without bodies, of spheres, coupled in the plane, in space.
SCENES = {
    "psi1 and chi": lambda: scene(60),
    "spheres": lambda: Scene.grid(*BODIES, friction_coefficient=0.3, speed=[1.0, 2.0, 30.0],
                                  angle_deg=np.linspace(1.0, 80.0, 20)),
    "plane": lambda: Scene.nondimensional(**{n: np.resize(v, 60) for n, v in COUPLED.items()}),
    "space": lambda: Scene.nondimensional(
        psi1=np.linspace(0.2, 4.0, 60)[:, None] * [0.6, 0.8], chi=[[2.0, 0.1], [0.1, 1.5]],
        lam=[0.1, 0.05], rho=1.0),
    "spin in one chunk": lambda: Scene(
        *BODIES, 0.2, np.linspace(1.0, 2.0, 60), normal_spin=np.repeat([0.0, 0.0, 90.0], 20)),
    "encounters": lambda: Encounter(
        *BODIES, 0.2, normal=(0, 0, -1), spin=(0, 9, 600),
        velocity=np.linspace(1.0, 2.0, 60)[:, None] * [0.3, 0.0, -1.0]).scene,
}  # fmt: skip


@pytest.fixture(autouse=True)
def blocks(monkeypatch):
    blocks_of(monkeypatch, 20)


def assert_columns(folder, result):
    """The folder holds what the result says, to the last bit, but for columns without values."""
    expected = {name: (unit, values) for name, unit, values in columns(result)}
    assert [*folder.units] == [name for name, (_, values) in expected.items() if values is not None]
    for name, unit in folder.units.items():
        values = expected[name][1]
        if name == "status":
            assert folder[name].tolist() == [status.name for status in result.status]
            continue
        assert unit == unit_in(expected[name][0], result.scene)
        whole = np.broadcast_to(np.asarray(values, dtype=float), result.scene.shape)
        assert folder[name].tobytes() == whole.tobytes(), name
    assert folder.failures == result.failures
    for kind, law in result.laws.items():
        assert folder.laws[kind].startswith(law)


@pytest.mark.parametrize("name", SCENES)
def test_a_folder_has_the_columns_of_the_result(tmp_path, name):
    law = "springs" if name == "space" else None
    simulation = Simulation(tangential=law)
    whole = simulation.sweep(SCENES[name]())
    folder = simulation.sweep(SCENES[name](), into=tmp_path / "swept", chunk=20).check()
    assert len(folder) == folder.impacts == 60
    assert len(list((tmp_path / "swept").glob("impacts-*.npz"))) >= 1
    assert_columns(folder, whole)
    assert_columns(SweepFolder(str(tmp_path / "swept")), whole)
    assert bool(folder.cautions) == bool(whole.cautions)
    error = np.max(whole.plan.psi2_error)
    assert folder.psi2_error == error or np.isnan([folder.psi2_error, error]).all()


def test_chunks_are_read_one_by_one(tmp_path):
    folder = Simulation(**RIGID).sweep(scene(), into=tmp_path / "swept", chunk=40)
    places = []
    for place, found in folder.chunks("psi1", "status"):
        places.append((place.start, place.stop))
        assert [*found] == ["psi1", "status"]
        assert found["psi1"].tolist() == scene().psi1[place].tolist()
        assert set(found["status"]) == {"SUCCESS"}
    assert places == [(0, 1000), (1000, 1100)] or places[-1][1] == 150
    (_, everything), *_ = folder.chunks()
    assert [*everything] == [*folder.units]
    with pytest.raises(ValueError, match=r"column = 'psi3'.*did you mean 'psi"):
        folder["psi3"]
    for read in (lambda: folder[0], lambda: next(folder.chunks(["psi1", "psi2"]))):
        with pytest.raises(ValueError, match=r"must be the name of a column; .*chunks\('psi1',"):
            read()
    assert folder.complete
    finished = tmp_path / "swept" / "finished.json"
    before = finished.stat().st_mtime_ns
    Simulation(**RIGID).sweep(scene(), into=tmp_path / "swept", chunk=40)
    assert finished.stat().st_mtime_ns == before  # nor could it be where nothing can be written


def parts(size=150, each=40):
    for first in range(0, size, each):
        yield scene(size).take(slice(first, min(first + each, size)))


def test_scenes_of_a_generator_follow_one_another(tmp_path):
    simulation, psi1 = Simulation(**RIGID), scene().psi1
    folder = simulation.sweep(parts(), into=tmp_path / "parts").check()
    assert folder["psi1"].tolist() == psi1.tolist()
    np.testing.assert_allclose(folder["psi2"], simulation.sweep(scene()).psi2, atol=1e-12)
    singles = [Scene.nondimensional(psi1=value, chi=CHI) for value in psi1.tolist()]
    mixed = [*singles[:30], scene().take(slice(30, 70)), *singles[70:]]
    joined = simulation.sweep(iter(mixed), into=tmp_path / "mixed").check()
    np.testing.assert_allclose(joined["psi2"], folder["psi2"], atol=1e-12)


def test_the_index_of_an_impact_is_its_place_in_the_sweep(tmp_path):
    """A law draws by it: of parts numbered from 0 each the draws would repeat."""
    law = Simulation(tangential=RandomStepped(seed=3), integrator="symplectic")
    whole = law.sweep(scene())
    folder = law.sweep(parts(), into=tmp_path / "swept").check()
    np.testing.assert_allclose(folder["psi2"], whole.psi2, atol=1e-12)


def test_a_grid_in_parts_is_the_grid(tmp_path):
    entries = {"chi": [1.0, 1.5, 2.0], "psi1": np.linspace(0.0, 6.0, 50), "lam": 0.0}
    grid = Scene.grid(**entries)
    pieces = Scene.grid_in_parts(**entries, at_a_time=40)
    assert (pieces.impacts, len(pieces), pieces.dimensions) == (150, 4, (3, 50))
    assert repr(pieces) == "GridParts(chi: 3, psi1: 50; 150 impacts, 40 at a time)"
    for _ in range(2):  # it can be gone through again
        each = list(pieces)
        for name in ("psi1", "chi"):
            made = np.concatenate([getattr(part, name) for part in each])
            assert made.tobytes() == np.asarray(getattr(grid, name)).tobytes()
    at_angle = Scene.grid_in_parts(*BODIES, friction_coefficient=0.2, speed=[1.0, 2.0],
                                   angle_deg=[10.0, 20.0, 30.0], at_a_time=4)  # fmt: skip
    folder = Simulation(**RIGID).sweep(at_angle, into=tmp_path / "swept").check()
    assert folder["speed"].tolist() == [1.0] * 3 + [2.0] * 3
    assert folder["angle_deg"].tolist() == [10.0, 20.0, 30.0] * 2
    assert folder.units["angle_deg"] == "deg"
    vast = Scene.grid_in_parts(psi1=np.arange(1e5), chi=np.linspace(1.0, 2.0, 100_000))
    assert next(iter(vast)).shape == (1 << 17,)
    with pytest.raises(ValueError, match=r"grid in parts.*give into=folder"):
        Simulation().sweep(pieces)
    with pytest.raises(ValueError, match="at_a_time"):
        Scene.grid_in_parts(**entries, at_a_time=0)


def stopped(after):
    def progress(done, total):
        if done >= after:
            raise KeyboardInterrupt

    return progress


@pytest.mark.parametrize("scenes", [scene, parts], ids=["batch", "generator"])
def test_a_sweep_goes_on_where_it_stopped(tmp_path, monkeypatch, scenes):
    monkeypatch.setattr("contactlab.runs.into.MARCHED_AT_A_TIME", 40)
    simulation, target = Simulation(tangential="springs"), tmp_path / "swept"
    options = {"into": target, "chunk": 40}
    with pytest.raises(KeyboardInterrupt, match=f"80 impacts are in {target}: the same sweep"):
        simulation.sweep(scenes(), **options, progress=stopped(80))
    half = SweepFolder(target)
    assert (len(half), half.complete, half.impacts, half.missing) == (80, False, None, [])
    assert half["psi1"].tolist() == scene().psi1[:80].tolist()
    with pytest.raises(ImpactError, match=r"not complete: it stopped after impact 79; the same"):
        half.check()
    assert "not complete" in repr(half)
    before = {path.name: path.stat().st_mtime_ns for path in target.glob("impacts-*")}
    seen = []
    whole = simulation.sweep(scenes(), **options, progress=lambda *n: seen.append(n)).check()
    assert [done for done, _ in seen] == [120, 150]
    assert {name: (target / name).stat().st_mtime_ns for name in before} == before
    other = simulation.sweep(scenes(), into=tmp_path / "at once", chunk=40)
    assert whole["psi2"].tobytes() == other["psi2"].tobytes()
    again = simulation.sweep(scenes(), **options, progress=lambda *_: pytest.fail("ran"))
    assert again.complete


def test_a_sweep_that_grows_is_finished_once_more(tmp_path):
    simulation, target = Simulation(**RIGID), tmp_path / "swept"
    assert simulation.sweep([*parts()][:2], into=target).complete
    half = simulation.sweep(parts(), into=target, progress=stopped(120), return_partial=True)
    assert (len(half), half.complete) == (120, False)
    with pytest.raises(ImpactError, match=r"not complete: it stopped after impact 119"):
        half.check()
    assert len(simulation.sweep(parts(), into=target).check()) == 150


def test_what_does_not_fit_the_folder_is_refused(tmp_path):
    simulation, target = Simulation(**RIGID), tmp_path / "swept"
    simulation.sweep(parts(), into=target)
    other = scene().psi1.copy()
    other[-1] = np.nextafter(other[-1], 10.0)
    steps = contactlab.create("integrator.symplectic", steps=7)
    changed = Scene.nondimensional(psi1=other, chi=CHI)
    for laws, scenes, words in (
        (attrs.evolve(simulation, integrator=steps), parts(), "another sweep: integrator was"),
        (Simulation(tangential="frictionless"), parts(), "another sweep: tangential was"),
        (simulation, (changed.take(slice(a, min(a + 40, 150))) for a in range(0, 150, 40)),
         r"impacts-120-150.npz'.*another scene"),
        (simulation, parts(each=50), r"impacts-0-40.npz'.*another size"),
        (simulation, parts(size=80), r"beyond the last of 80|another scene"),
        (simulation, [scene().take(slice(0, 40))], r"beyond the last of 40 impacts"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=rf"into = .*{words}.*; "):
            laws.sweep(scenes, into=target)
    assert simulation.sweep(parts(), into=target).check()["psi1"].size == 150


def test_bad_arguments_are_refused(tmp_path):
    simulation = Simulation(**RIGID)
    with pytest.raises(ValueError, match=r"keep, into = .*; give one"):
        simulation.sweep(scene(), keep=tmp_path / "a", into=tmp_path / "b")
    assert not (tmp_path / "a").exists()
    kept = tmp_path / "kept"
    simulation.sweep(scene(), keep=kept)
    with pytest.raises(ValueError, match="another sweep"):
        simulation.sweep(scene(), into=kept)
    with pytest.raises(ValueError, match=r"folder of keep=.*; the same sweep"):
        SweepFolder(kept)
    with pytest.raises(ValueError, match=r"holds no sweep.*; make one"):
        SweepFolder(tmp_path / "nowhere")
    with pytest.raises(ValueError, match="must be the path of a folder"):
        simulation.sweep(scene(), into=3)
    with pytest.raises(ValueError, match=r"path = None: must be the path of a folder"):
        SweepFolder(None)
    table = Scene.nondimensional(psi1=[[1.0, 2.0]], chi=CHI)
    met = Encounter(*BODIES, 0.2, normal=(0, 0, -1), velocity=[(0, 0, -1)])
    for bad, words in (
        (3, "3: must be a Scene, or an iterable"),
        (table, "must be a sequence"),
        (met, "must be a Scene, .*; give its .scene"),
        ("scene.toml", r"must be a Scene, .*; of a file: case = read_scene"),
        (iter([]), "at least one Scene; make the generator anew"),
        ([4], r"scenes\[0\] = 4: must be a Scene"),
    ):
        with pytest.raises(ValueError, match=words):
            simulation.sweep(bad, into=tmp_path / "three")
        assert not (tmp_path / "three").exists()
    for name in ("a\0b", "a" * 300):
        for given in ("keep", "into"):
            with pytest.raises(ValueError, match=rf"{given} = .*cannot be made: "):
                simulation.sweep(scene(), **{given: tmp_path / name})
        with pytest.raises(ValueError, match=r"path = .*holds no sweep"):
            SweepFolder(tmp_path / name)
    with pytest.raises(ValueError, match=r"scenes\[1\] = 4: must be a Scene"):
        simulation.sweep([scene(), 4], into=tmp_path / "four")
    with pytest.raises(ValueError, match="chunk"):
        simulation.sweep(scene(), into=tmp_path / "chunk", chunk=0)
    of_bodies = Scene(*BODIES, 0.2, [1.0, 2.0])
    with pytest.raises(ValueError, match=r"scenes = .*other columns: .*; sweep them"):
        simulation.sweep([scene(), of_bodies], into=tmp_path / "two")
    with pytest.raises(ValueError, match=r"single impact; batches go one after another"):
        simulation.sweep(list(parts()))


def test_a_damaged_file_is_told(tmp_path):
    simulation, target = Simulation(**RIGID), tmp_path / "swept"
    simulation.sweep(parts(), into=target)
    path = target / "impacts-40-80.npz"
    sound = path.read_bytes()
    path.write_bytes(sound[: len(sound) // 2])
    for read in (
        lambda: SweepFolder(target)["psi2"],
        lambda: simulation.sweep(parts(), into=target),
    ):
        with pytest.raises(ValueError, match=r"impacts-40-80.npz': is damaged: .*; delete this"):
            read()
    bit = bytearray(sound)
    at = sound.index(b"psi2.npy") + 400
    bit[at] ^= 1
    path.write_bytes(bytes(bit))
    with pytest.raises(ValueError, match=r"impacts-40-80.npz': is damaged: .*CRC"):
        SweepFolder(target)["psi2"]
    words = '{"first": 40, "last": 79}'
    np.savez(path, about=np.array(json.dumps([words, zlib.crc32(words.encode())])))
    with pytest.raises(ValueError, match=r"npz': tells first, last; .*; read it by the version"):
        SweepFolder(target)["psi2"]
    path.write_bytes(sound)
    with np.load(path) as content:
        arrays = dict(content)
    turned = arrays["psi1"][[1, 0, *range(2, 40)]]
    words = np.array(str(arrays["about"]).replace("SUCCESS", "LAW_RAISED"))
    for name, values in (
        ("psi1", arrays["psi1"] * 1.001), ("psi1", turned), ("chi", np.array(2.0)),
        ("status", np.ones(40, dtype=np.uint8)), ("psi2", arrays["psi2"][:20]), ("about", words),
    ):  # fmt: skip
        np.savez(path, **arrays | {name: values})
        for read in (
            lambda: [*SweepFolder(target).chunks()],
            lambda: simulation.sweep(parts(), into=target),
        ):
            with pytest.raises(ValueError, match=r"40-80.npz': is damaged: its .*; delete this"):
                read()
    np.savez(path, **arrays)
    assert SweepFolder(target)["psi2"].size == 150
    path.write_bytes(sound)
    finished = target / "finished.json"
    words = finished.read_text("utf-8")
    for bad in ('{"impact": 150}', "[150]", '{"impacts": "?"}', '{"impacts": 1e999}', ""):
        finished.write_text(bad, "utf-8")
        with pytest.raises(ValueError, match=r"path = .*finished.json': is damaged: .*; delete"):
            SweepFolder(target).check()
    finished.write_text(words, "utf-8")
    about = target / "sweep.json"
    words = about.read_text("utf-8")
    for bad in ("[]", '{"form": "columns of results"}', words.replace('s": "SUC', 's": 1, "": "')):
        about.write_text(bad, "utf-8")
        with pytest.raises(ValueError, match=r"path = .*holds no sweep|is a folder of keep="):
            SweepFolder(target)
    about.write_text(words, "utf-8")
    path.unlink()
    folder = SweepFolder(target)
    assert folder.missing == [(40, 80)]
    with pytest.raises(ValueError, match=r"impacts 40 to 80 are missing; run the same sweep"):
        folder["psi2"]
    with pytest.raises(ImpactError, match="impacts 40 to 80 are missing"):
        folder.check()
    assert simulation.sweep(parts(), into=target).check().missing == []
    for name, words in (
        ("impacts-mine.npz", "not the name of a chunk"),
        ("impacts-80-40.npz", "not the name of a chunk"),
        ("impacts-040-80.npz", "not the name of a chunk"),
        ("impacts-200-240.npz", "contains impacts 40 to 80, which are not those of its name"),
    ):
        (target / name).write_bytes(sound)
        with pytest.raises(ValueError, match=rf"{name}.*{words}.*; (move|rename)"):
            SweepFolder(target)["psi2"]
        if "name of a chunk" in words:
            with pytest.raises(ValueError, match=rf"into = .*{name}.*{words}"):
                simulation.sweep(parts(), into=target)
        (target / name).unlink()


def test_a_folder_is_told_and_drawn(tmp_path):
    """Of a folder nothing is read but what is named."""
    from matplotlib.figure import Figure

    folder = Simulation(**RIGID).sweep(scene(), into=tmp_path / "swept", chunk=40).check()
    told = json.loads(json.dumps(folder.to_dict("psi2")))
    assert told["psi2"] == folder["psi2"].tolist()
    assert told["impacts"] == len(folder)
    assert told["statuses"] == {"SUCCESS": len(folder)}
    assert "psi1" not in folder.to_dict()
    assert folder._repr_html_() == f"<pre>{html.escape(str(folder))}</pre>"
    curve = folder.plot(axes=Figure().subplots()).lines[0]
    order = np.argsort(folder["psi1"])
    assert curve.get_ydata() == pytest.approx(folder["psi2"][order])


@extra("pandas")
def test_a_folder_is_a_frame(tmp_path):
    folder = Simulation(**RIGID).sweep(scene(), into=tmp_path / "swept", chunk=40)
    frame = folder.to_dataframe("psi2", "status")
    assert frame["psi2"].tolist() == folder["psi2"].tolist()
    assert [*frame.columns] == ["psi2", "status"]
    assert frame.attrs["units"]["normal_speed"] == folder.units["normal_speed"]
    with pytest.raises(ValueError, match="column = 'psi3': is not a column"):
        folder.to_dataframe("psi3")


@extra("xarray")
def test_a_folder_is_a_data_set(tmp_path):
    folder = Simulation(**RIGID).sweep(scene(), into=tmp_path / "swept", chunk=40)
    assert folder.to_xarray("psi2").psi2.values.tolist() == folder["psi2"].tolist()


@pytest.mark.parametrize("form", ["swept", "swept.parquet"])
def test_a_folder_is_read_by_dask_when_it_is_computed(tmp_path, form):
    pytest.importorskip("dask.dataframe")
    if form.endswith("parquet"):
        pytest.importorskip("pyarrow")
    folder = Simulation(**RIGID).sweep(scene(), into=tmp_path / form, chunk=40)
    lazy = folder.to_dask("psi1", "psi2", "status")
    assert lazy.npartitions == len([*folder.chunks()])
    assert lazy["psi2"].sum().compute(scheduler="sync") == pytest.approx(folder["psi2"].sum())
    frame = lazy.loc[50:99].compute(scheduler="sync")
    assert frame.index.tolist() == list(range(50, 100))
    assert frame["psi1"].tolist() == folder["psi1"][50:100].tolist()
    with pytest.raises(ValueError, match="column = 'psi3': is not a column"):
        folder.to_dask("psi3")
    first = min(folder.path.glob("impacts-*"))
    first.write_bytes(first.read_bytes() + b"0")
    with pytest.raises(ValueError, match="was written or removed after this folder was opened"):
        lazy["psi2"].sum().compute(scheduler="sync")


def test_an_open_folder_reads_no_other_sweep(tmp_path):
    """Its words are those of the sweep that it was opened with."""
    target = tmp_path / "swept"
    folder = Simulation(**RIGID).sweep(scene(), into=target).check()
    shutil.rmtree(target)
    with pytest.raises(ValueError, match=r"impacts-0-150.npz': was written or removed .*; open"):
        folder["psi2"]
    Simulation(tangential="frictionless").sweep(scene(), into=target)
    with pytest.raises(ValueError, match=r"impacts-0-150.npz': was written or removed .*; open"):
        folder["psi2"]


def test_files_of_two_sweeps_are_not_read_as_one(tmp_path):
    simulation = Simulation(**RIGID)
    simulation.sweep(parts(), into=tmp_path / "one")
    for other, each, name in (
        (Simulation(tangential="frictionless"), 40, "impacts-120-150.npz"),
        (simulation, 60, "impacts-60-120.npz"),
    ):
        other.sweep(parts(each=each), into=tmp_path / f"of {each}")
        mixed = shutil.copytree(tmp_path / "one", tmp_path / f"mixed {each}")
        shutil.copy(tmp_path / f"of {each}" / name, mixed)
        with pytest.raises(ValueError, match=r"impacts-.*\.npz.*another s.*; move this file"):
            len(SweepFolder(mixed))


def test_failures_and_cautions_are_those_of_the_result(tmp_path):
    steps = contactlab.create("integrator.symplectic", steps=5, refine=False)
    simulation = Simulation(tangential="springs", integrator=steps)
    whole = simulation.sweep(scene())
    folder = simulation.sweep(parts(), into=tmp_path / "failing")
    assert whole.failures
    assert folder.failures == whole.failures
    assert [*folder["status"]] == [status.name for status in whole.status]
    assert sum(folder.statuses.values()) == 150
    with pytest.raises(ImpactError) as raised:
        folder.check()
    with pytest.raises(ImpactError) as expected:
        whole.check()
    assert (str(raised.value), raised.value.status) == (
        str(expected.value), expected.value.status)  # fmt: skip
    assert "failed (impact" in str(folder)


def test_cautions_are_told_once_with_the_largest_numbers(tmp_path):
    soft = Material(young_modulus=2e11, poisson_ratio=0.3, density=7800.0, yield_stress=1e9)
    bodies = Sphere(0.01, soft), HalfSpace(soft)
    speeds = np.geomspace(0.01, 60.0, 60)

    def scenes():
        return (Scene(*bodies, 0.3, speeds[first : first + 20], 1.0) for first in (0, 20, 40))

    whole = Simulation().sweep(Scene(*bodies, 0.3, speeds, 1.0))
    one = Simulation().sweep(Scene(*bodies, 0.3, speeds, 1.0), into=tmp_path / "one").check()
    assert any("yield" in words for words in whole.cautions)
    assert one.cautions == whole.cautions
    folder = Simulation().sweep(scenes(), into=tmp_path / "three").check()
    last = Simulation().sweep([*scenes()][2])
    assert len(folder.cautions) == len(whole.cautions)
    for words in last.cautions:  # the fastest
        (told,) = (each for each in folder.cautions if words in each)
        assert told.startswith("impacts 40 to 60: ")
    assert any("so say 3 of 3 chunks" in words for words in folder.cautions)
    assert all(f"caution: {words}" in str(folder) for words in folder.cautions)
    with pytest.raises(ImpactError, match="caution"):
        folder.check(cautions=True)


def test_a_full_disk_leaves_the_chunks_before(tmp_path, monkeypatch):
    simulation, target = Simulation(**RIGID), tmp_path / "swept"
    with monkeypatch.context() as patched:
        full_disk(patched, after=3)
        with pytest.raises(OSError, match="No space left on device") as caught:
            simulation.sweep(parts(), into=target)
    assert caught.value.errno == errno.ENOSPC
    assert f"into = {str(target)!r}: impacts 80 to 120 are not written" in str(caught.value)
    assert "holds 80 impacts; the same sweep goes on" in str(caught.value)
    assert len(simulation.sweep(parts(), into=target).check()) == 150


def test_a_disk_that_is_full_from_the_start_is_told(tmp_path, monkeypatch):
    simulation, target = Simulation(**RIGID), tmp_path / "swept"
    with monkeypatch.context() as patched:
        full_disk(patched, after=1)
        with pytest.raises(OSError, match=r"impacts 0 to 40 .*holds 0 impacts; .* begins again"):
            simulation.sweep(parts(), into=target)
    with pytest.raises(ImpactError, match=r"not complete: no chunk is finished; the same sweep"):
        SweepFolder(target).check()
    assert len(simulation.sweep(parts(), into=target).check()) == 150


def test_a_folder_that_goes_in_the_middle_is_told(tmp_path):
    target = tmp_path / "swept"
    with pytest.raises(OSError, match=r"impacts 40 to 80.*there is no folder"):
        Simulation(**RIGID).sweep(
            parts(), into=target, progress=lambda *_: shutil.rmtree(target, ignore_errors=True)
        )


@pytest.mark.slow
def test_an_executor_changes_no_bit(tmp_path):
    simulation = Simulation(tangential="springs")
    here = simulation.sweep(parts(), into=tmp_path / "here").check()
    with processes(2) as executor:
        there = simulation.sweep(parts(), into=tmp_path / "there", executor=executor).check()
    for name in here.units:
        assert here[name].tobytes() == there[name].tobytes()
    assert here.cautions == there.cautions


def test_an_executor_has_a_limited_number_of_chunks(tmp_path, monkeypatch):
    monkeypatch.setattr("contactlab.runs.into.AHEAD", 3)
    made, seen = [], []

    def counted():
        for part in parts(size=400, each=20):
            made.append(part)
            yield part

    folder = Simulation(**RIGID).sweep(
        counted(),
        into=tmp_path / "swept",
        executor=ThreadPoolExecutor(1),
        progress=lambda done, _: seen.append(len(made) - done // 20),
    )
    assert len(folder.check()) == 400
    assert max(seen) <= 3


@pytest.mark.parametrize("executor", [None, ThreadPoolExecutor(1)], ids=["here", "a thread"])
def test_what_makes_scenes_may_raise(tmp_path, executor):
    """Chunks made before are in the folder, also those that an executor has not answered yet."""

    def ending():
        yield from [*parts()][:3]
        raise OSError("the end of the file")

    simulation, target = Simulation(**RIGID), tmp_path / "swept"
    with pytest.raises(OSError, match="the end of the file"):
        simulation.sweep(ending(), into=target, executor=executor)
    assert (len(SweepFolder(target)), SweepFolder(target).complete) == (120, False)
    assert len(simulation.sweep(parts(), into=target).check()) == 150


class Losing:
    """An executor that loses all calls from the second to one, as a broken machine does."""

    def __init__(self, last):
        self.calls, self.last = 0, last

    def submit(self, call, *arguments):
        self.calls += 1
        future = Future()
        if 2 <= self.calls <= self.last:
            future.set_exception(OSError("lost"))
        else:
            future.set_result(call(*arguments))
        return future


def test_a_chunk_that_is_lost_once_is_sent_again(tmp_path):
    folder = Simulation(**RIGID).sweep(parts(), into=tmp_path / "swept", executor=Losing(2))
    here = Simulation(**RIGID).sweep(parts(), into=tmp_path / "here")
    assert folder.check()["psi2"].tobytes() == here["psi2"].tobytes()


def test_chunks_that_are_lost_are_missing_until_the_next_run(tmp_path):
    simulation, target = Simulation(**RIGID), tmp_path / "swept"
    folder = simulation.sweep(parts(), into=target, executor=Losing(99))
    assert (folder.missing, folder.complete, len(folder)) == ([(40, 150)], False, 40)
    assert len(simulation.sweep(parts(), into=target).check()) == 150


def test_a_law_that_raises_costs_its_impacts_only(tmp_path):
    raising = Simulation(tangential=Raising(), integrator="symplectic")
    whole = raising.sweep(scene())
    folder = raising.sweep(scene(), into=tmp_path / "swept")
    assert folder.failures == whole.failures
    assert_columns(folder, whole)
    with pytest.raises(ImpactError) as raised:
        folder.check()
    assert raised.value.status is Status.LAW_RAISED


def test_the_status_is_a_byte_and_empty_columns_are_not_stored(tmp_path):
    target = tmp_path / "swept"
    Simulation(**RIGID).sweep(scene(), into=target)
    (path,) = target.glob("impacts-*.npz")
    with np.load(path) as content:
        assert content["status"].dtype == np.uint8
        assert content["chi"].shape == ()
        assert content["psi2"].shape == (150,)
        assert "rebound_tangential_velocity" not in content.files
    names = json.loads((target / "sweep.json").read_text("utf-8"))["statuses"].split()
    assert names == [status.name for status in Status]


PEAK = """
import resource, sys
import numpy as np
from contactlab import Scene, Simulation
def drawn(count):
    draw = np.random.default_rng(1)
    for first in range(0, count, 1 << 17):
        size = min(1 << 17, count - first)
        yield Scene.nondimensional(psi1=draw.uniform(-6, 6, size), chi=draw.uniform(0.3, 2.5, size))
Simulation().sweep(drawn(int(sys.argv[1])), into=sys.argv[2])
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="counts in kB on Linux")
@pytest.mark.slow
def test_memory_is_that_of_two_chunks(tmp_path):
    """Three million impacts take as much as the first two chunks do: a number an impact is seen."""
    peaks = []
    for impacts in (1 << 18, 3_000_000):
        command = [sys.executable, "-c", PEAK, str(impacts), str(tmp_path / str(impacts))]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        peaks.append(int(done.stdout) / 1024)
        shutil.rmtree(tmp_path / str(impacts))
    assert peaks[1] < peaks[0] + 20.0
