"""Write public outputs of contactlab, to compare before and after a change.

    python .ci/corpus.py OUT.json [--against OLD.json]

Every number is whole, no entry holds a time, and nothing is rendered: of a figure its data are
written. ``--against`` prints the entries that differ from an earlier file; the exit status is then
1 if there are any. About 30 s on one core.
"""

import argparse
import contextlib
import enum
import functools
import io
import itertools
import json
import os
import sys
import tempfile
import time
import warnings
import zlib
from pathlib import Path

os.environ["COLUMNS"] = "100"  # of the terminal that commands print for

import numpy as np
from corpus_cases import COMMANDS, INTEGRATORS, NORMAL, TANGENTIAL, doors, encounters, fits, scenes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import contactlab as cl
from contactlab.cli.main import main
from contactlab.study import validation

EXAMPLES = Path(__file__).parents[1] / "examples"
#: Numbers of an array, and letters of a text, above which a checksum is written.
MANY, LONG = 500, 50_000
WRONG = (-1.0, 0.0, np.nan, np.inf, "x", None, True, [1.0, -2.0], [], [[1.0]], 10**400, 1 + 2j)


def told(value, depth=4):
    """Return plain data: of the package's own objects the public attributes, but no run time."""
    if isinstance(value, str) and len(value) > LONG:
        return f"{len(value)} {zlib.crc32(value.encode())}"
    if value is None or isinstance(value, bool | int | float | str):
        return value.name if isinstance(value, enum.Enum) else value
    if isinstance(value, BaseException):
        return f"{type(value).__name__}: {value}"
    if isinstance(value, np.ndarray | np.generic):
        value = np.ma.filled(value, np.nan) if value.dtype.kind == "f" else value
        if value.size > MANY:
            return f"{value.shape} {zlib.crc32(value.tobytes())}"
        return told(value.tolist(), depth)
    if isinstance(value, dict) or hasattr(value, "items"):
        return {str(key): told(each, depth) for key, each in value.items()}
    if isinstance(value, Figure):
        return [*map(drawn_on, value.axes)]
    if isinstance(value, tuple | list) or hasattr(value, "__next__"):
        return [told(each, depth) for each in value]
    laws = cl.contracts.NormalLaw, cl.contracts.TangentialLaw, cl.contracts.Integrator
    if not depth or not type(value).__module__.startswith("contactlab") or isinstance(value, laws):
        return type(value).__name__
    names = [name for name in dir(value) if name[0] != "_" and "run_time" not in name]
    each = {name: getattr(value, name, None) for name in names}
    each = {name: told(one, depth - 1) for name, one in each.items() if not callable(one)}
    return {"str": str(value), **each}


def drawn_on(axes):
    """Return what axes hold: curves, areas, words, limits, patches and images."""
    looks = ("color", "linestyle", "linewidth", "marker", "label", "xydata")
    lines = [[told(getattr(line, f"get_{look}")()) for look in looks] for line in axes.lines]
    areas = [
        (each.get_offsets(), [p.vertices for p in each.get_paths()]) for each in axes.collections
    ]
    legend = axes.get_legend()
    words = [*axes.texts, axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label]
    words += [] if legend is None else legend.get_texts()
    words = [(each.get_text(), each.get_position()) for each in words]
    ends = [*axes.get_xlim(), *axes.get_ylim(), axes.get_xscale(), axes.get_yscale()]
    patches = [each.get_path().vertices for each in axes.patches]
    return told([lines, areas, words, ends, patches, [each.get_array() for each in axes.images]])


def command(*words):
    """Return a command's status, what it prints and draws, and the files that it writes."""
    out, err, drawn = io.StringIO(), io.StringIO(), []

    def draw(canvas, *_, **__):
        canvas.get_renderer()  # a blank picture
        drawn.append(told(canvas.figure) if len(drawn) % 20 == 0 else None)

    def write(figure, file, **_):
        drawn.append(told(figure))
        if isinstance(file, io.TextIOBase):
            file.write("<svg>")

    kept = FigureCanvasAgg.draw, Figure.savefig
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        FigureCanvasAgg.draw, Figure.savefig = draw, write
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                status = main([word.replace("@", f"{EXAMPLES}/") for word in words])
        finally:
            FigureCanvasAgg.draw, Figure.savefig = kept
        files = [each for each in sorted(Path(folder).rglob("*")) if each.is_file()]
        files = [(each.name, told(each.read_text(errors="replace"))) for each in files]
    return [
        status,
        *(text.getvalue().replace(f"{EXAMPLES}/", "@") for text in (out, err)),
        drawn,
        files,
    ]


def simulation(**laws):
    """Return the simulation of three laws, each a name and options."""
    made = {kind: cl.create(f"{kind}.{name}", **options) for kind, (name, options) in laws.items()}
    return cl.Simulation(**made)


def runs():
    """Yield impacts under every pair of laws, richer runs of each law, bodies and load paths."""
    met, bodies = scenes(), encounters()
    for place, (normal, law) in enumerate(itertools.product(NORMAL, TANGENTIAL[::2])):
        name = INTEGRATORS[0 if law[0] == "fronts" else 1 + place % 3]
        three = {"normal": normal, "tangential": law, "integrator": name}
        yield f"run {three}", lambda s=three: simulation(**s).run(met["thrown"])
    approach, moved = np.sin(np.linspace(0.1, 3.0, 40)), np.sin(np.linspace(0.0, 9.0, 40))
    for law in TANGENTIAL:
        name = INTEGRATORS[0] if law[0] == "fronts" else INTEGRATORS[2]
        made = functools.partial(simulation, tangential=law, integrator=name)
        for what, scene in met.items():
            history = "fields" if not scene.shape else False
            yield f"{what} {law}", lambda s=scene, h=history, m=made: m().run(s, history=h)
        yield f"sweep {law}", lambda m=made: m().sweep(met["batch"])
        yield f"estimate {law}", lambda m=made: m().run(met["plain"], estimate_error=True)
        for what in ("rod", "box", "egg"):
            scene = bodies[what].scene
            yield f"{what} {law}", lambda s=scene, m=made: m().run(s, history=True)
        path = functools.partial(cl.load_path, met["unlike"], 1e-6 * approach, 1e-6 * moved)
        yield f"path {law}", lambda p=path, m=made: p(tangential=m().tangential)
    for (what, encounter), e in itertools.product(bodies.items(), (1.0, 0.7, [1.0, 0.6])):
        how = {"separating": "pass", "restitution": e}
        yield f"collide {what} {e}", functools.partial(cl.collide, encounter, **how)
    psi1, chi = np.linspace(-7.0, 7.0, 57), np.array([[0.9], [1.44], [2.1], [4.0]])
    yield "rebound", lambda: cl.rebound(psi1, chi)
    yield "derivatives", lambda: cl.rebound(psi1, chi[:3], derivatives=True)
    for c, e in ((1.44, 0.8), (1.0, np.linspace(0.5, 1.0, 7)), (2.0, 0.3), (12.0, 0.9)):
        yield f"rebound {c} {e}", functools.partial(cl.rebound, psi1[::9], c, restitution=e)
    for p, c in itertools.product((0, 0.3, -1.0, 2.5, 1e6), (0.2, 1, 1.44, 2.4999, 3.0)):
        yield f"rebound {p} {c}", functools.partial(cl.rebound, p, c)


def others():
    """Yield commands, wrong calls at each door, fits, and plots and frames of results."""
    for line in COMMANDS:
        yield f"$ {line}", functools.partial(command, *line.split())
    for (door, call), value in itertools.product(doors().items(), WRONG):
        yield f"wrong {door} {str(value)[:9]}", functools.partial(call, value)
    yield from fits()
    yield "validate", lambda: [*itertools.islice(validation.validate(), 9)]
    for name, scene in scenes().items():
        result = functools.partial(cl.Simulation().run, scene, history=not scene.shape)
        yield f"plot {name}", lambda r=result: r().plot().figure
        yield f"frame {name}", lambda r=result: r().to_dataframe().reset_index().to_dict("list")
        yield f"dataset {name}", lambda r=result: r().to_xarray().to_dict()


def tried(call):
    """Return what a call gives, or its refusal, and its warnings; the clock ticks at each look."""
    ticks = itertools.count()
    time.perf_counter = lambda: 0.1 * next(ticks)
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        try:
            answer = told(call())
        except Exception as error:
            answer = told(error)
    return [answer, *(str(each.message) for each in warned)] if warned else answer


def entries():
    """Yield the name of each entry, and a call that returns its plain data."""
    for name, call in itertools.chain(runs(), others()):
        yield name, functools.partial(tried, call)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("out", type=Path, metavar="OUT.json")
    parser.add_argument("--against", type=Path, metavar="OLD.json")
    given = parser.parse_args()
    given.out.write_text(json.dumps({name: call() for name, call in entries()}, indent=0))
    if given.against:
        new, old = (json.loads(path.read_text()) for path in (given.out, given.against))
        names = [n for n in new | old if json.dumps(new.get(n)) != json.dumps(old.get(n))]
        print(*names, f"{len(names)} of {len(new | old)} entries differ", sep="\n")
        sys.exit(bool(names))
