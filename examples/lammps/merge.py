"""``mindlin_springs`` in a source tree of LAMMPS: sub-model with the kernel, pages, tests, input.

``python build.py merge lammps-4Feb2025`` applies all. Headers and style are the tree's own.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from importlib import resources
from pathlib import Path

HERE = Path(__file__).resolve().parent
SUB_MODEL = ("gran_sub_mod_tangential_springs.h", "gran_sub_mod_tangential_springs.cpp")
UNIT_TEST = "atomic-pair-granular_mindlin_springs.yaml"
#: Impacts on a wall for ``unittest/granular``, which sources of 2026 have, and their model.
IMPACTS = ("dem05-mindlin-springs-3d.yaml", "dem05-mindlin-springs-elastic-3d.yaml")
PARTIAL_SLIP = (HERE / "partial_slip.cpp").read_text("utf-8")
INPUT = "in.oblique"
AUTHOR = """
/* ----------------------------------------------------------------------
   Contributing authors: The contactlab developers
   The springs are contactlab's kernel, which is under the MIT license
------------------------------------------------------------------------- */
"""
#: From the kernel in C, for any kind of number, to C++ for double.
PLAIN = (
    (r"#define CONTACTLAB_SPRINGS_STATE\(n\) \((.*)\)\n",
     "static constexpr int springs_state(int n)\n{\n  return 2 + 3 * n;\n}\n"),
    (r"#define CONTACTLAB_SPRINGS_TOUCH \(\(CONTACTLAB_REAL\) (\S+)\)",
     r"static constexpr double SPRINGS_TOUCH = \1;"),
    (r"\((CONTACTLAB_REAL|double)\) ", ""),
    ("CONTACTLAB_REAL", "double"),
    ("CONTACTLAB_SPRINGS_STATE", "springs_state"),
    ("CONTACTLAB_SPRINGS_TOUCH", "SPRINGS_TOUCH"),
    ("contactlab_springs_", "springs_"),
    ("static inline", "static"),
)  # fmt: skip

ITEM = (
    r"7. *mindlin_springs* : :math:`k_t` or NULL, :math:`x_{\gamma,t}` or NULL, "
    r":math:`\mu_s`, :math:`N`"
    "\n"
)
SECTION = r"""
.. versionadded:: TBD

The *mindlin_springs* option resolves the partial slip within a contact, for
which the options above take one spring with a cap.  Of :math:`N` springs in
the middle of equal cells of :math:`[0, A]`, those at :math:`r_i < a` carry the
force

.. math::

   \mathbf{F}_{te} = -k_t \frac{A}{N} \sum_i \mathbf{w}_i , \qquad
   \|\mathbf{w}_i\| \le l_i \propto a^2 - r_i^2 , \qquad
   k_t \frac{A}{N} \sum_i l_i = \mu_s F_{n0}

where every :math:`\mathbf{w}_i` follows the tangential displacement since the
contact reached :math:`r_i`.  This is the theory of
:ref:`Mindlin and Deresiewicz <Mindlin1953>` for any path of load and
displacement.  :math:`A` begins as a power of two times the effective radius.
When the contact outgrows :math:`A`, neighboring springs are merged and :math:`A`
doubles, or with damping grows by a quarter; when :math:`a \le A/4`, every cell
is split into halves and :math:`A` halves.  Nothing about the future of the
contact needs to be known, and no path gains energy.  A change of the tangent
plane is treated as for *mindlin*.

The number of springs :math:`N` is even, from 2 to 64, and a contact stores
:math:`3 + 3N` values, and three more with damping.  After an impact of elastic
spheres, the tangential velocity of the contact point, in units of
:math:`\mu_s v_n E_{eff}/(4 G_{eff})`, differs from the solution of
:ref:`Maw et al <Maw1976>` by at most 0.022 with :math:`N = 8`, and by 0.47 to
0.66 with the *mindlin* options, if a contact takes 50 time steps.  A contact
needs at least 14 time steps.  The stiffness :math:`k_t` is that of *mindlin*.

The damping :math:`x_{\gamma,t}` is that of a contact that sticks over the normal
damping, as for *mindlin*, but each spring carries its part up to its own limit:
with :math:`A = x_{\gamma,t} \eta_n / (k_t a)` its force is
:math:`\mathbf{f}_i = \mathbf{w}_i + A \dot{\mathbf{w}}_i`,
:math:`\|\mathbf{f}_i\| \le l_i`, and the limits share the normal damping too.
*NULL* takes one relaxation time for normal and tangential motion,
:math:`x_{\gamma,t} = 4 G_{eff}/E_{eff}`, which is :math:`2 (1 - \nu)/(2 - \nu)`
for like materials.  Zero is elastic shear.

.. note::

   A run that is restarted with another :math:`N`, or with *mindlin_springs*
   after another tangential model, stops with an error, because the histories
   of the contacts do not fit.
"""
MIXING = r"""
For *tangential mindlin_springs* the stiffness, also that from *NULL*, is mixed as

.. math::

   k_{t,ij} = \frac{2 k_{t,i} k_{t,j}}{k_{t,i} + k_{t,j}}

which is the stiffness of the two materials in contact.  The ratio
:math:`x_{\gamma,t}/k_t` is averaged, and the larger :math:`N` is used.
"""
MAW = """Maw, N., Barber, J. R., & Fawcett, J. N. (1976).
The oblique impact of elastic spheres. Wear, 38(1), 101-114."""
MODEL = r"""   * - partial_slip
     - rebound for :math:`\nu = 0.3` from stick to gross slip, by a table of slip
       velocities :math:`\psi_1` before and :math:`\psi_2` after it:
       :math:`v_x' = v_x + (\psi_2 - \psi_1) \mu v_z / (3.5 \kappa)`,
       :math:`\omega_y = \tfrac{5}{2} (v_x - v_x')/r`,
       :math:`\kappa = 2 (1 - \nu)/(2 - \nu)`,
       for :math:`e = 1` from :ref:`Maw et al <Maw1976>`
"""
WALL = (
    "   fix 7 all wall/gran granular hertz/material 1e8 0.8 0.3 "
    "tangential mindlin_springs NULL 0.0 0.5 8 damping tsuji zplane 0.0 NULL\n"
)
#: Pages: what is inserted, after the last line that has these words.
PAGES: dict[str, tuple[tuple[str, str], ...]] = {
    "doc/src/pair_granular.rst": (
        ("6. *mindlin_rescale/force* :", ITEM),
        ("particularly Appendix A.", SECTION),
        ("   E_{eff,ij} = \\frac{E_{ij}}{2(1-\\nu_{ij}^2)}", MIXING),
        ("I. Assembling process", f"\n.. _Maw1976:\n\n**(Maw et al, 1976)** {MAW}\n"),
    ),
    "doc/src/fix_wall_gran.rst": (("   fix 6 all wall/gran hooke ", WALL),),
    "doc/src/Bibliography.rst": (
        ("   Mattice", "\n**(Maw et al, 1976)**\n   " + MAW.replace("\n", " ") + "\n"),
    ),
    "doc/utils/sphinx-config/false_positives.txt": (("Fava", "Fawcett\n"),),
    "unittest/granular/test_analytic_models.cpp": (
        ('"spin_no_friction: spurious vy";', PARTIAL_SLIP),
        ("#include <string>", "#include <utility>\n#include <vector>\n"),
    ),
    "doc/src/Developer_unittest.rst": (("   * - oblique_impact", MODEL),),
    "src/.gitignore": (
        ("/gran_sub_mod_tangential.h", "".join(f"/{name}\n" for name in SUB_MODEL[::-1])),
    ),
}  # fmt: skip
#: Of what is inserted, what a tree of before 2026 has no place for.
OF_IMPACTS = ("unittest/granular/test_analytic_models.cpp", "doc/src/Developer_unittest.rst")


def plain(text: str) -> str:
    """Return code of the kernel, or that calls the kernel, as C++ without macros."""
    for pattern, to in PLAIN:
        text = re.sub(pattern, to, text)
    return text


def kernel() -> str:
    """Return the kernel of contactlab as C++ without macros."""
    file = resources.files("contactlab").joinpath("kernels", "contactlab_springs.h")
    text = file.read_text("utf-8")
    return plain(text[text.index("/* Length of the state") : text.rindex("#endif")].strip())


def merge(lammps: Path) -> None:
    """Write sub-model, unit test and pages into a tree; what is there already is left."""
    granular = lammps / "src" / "GRANULAR"
    head = (granular / "gran_sub_mod.h").read_text("utf-8")
    head = head[: head.index("*/") + 3]
    for name in SUB_MODEL:
        text = (HERE / name).read_text("utf-8")
        text = text[text.index("*/") + 3 :]
        text = re.sub(r'#include "contactlab_springs.h".*', lambda _: kernel(), text)
        (granular / name).write_text(f"{head}{AUTHOR}\n{plain(text).strip()}\n", "utf-8")
    if shutil.which("clang-format"):
        subprocess.run(["clang-format", "-i", *SUB_MODEL], cwd=granular, check=True)
    shutil.copy(HERE / UNIT_TEST, lammps / "unittest" / "force-styles" / "tests")
    shutil.copy(HERE / INPUT, lammps / "examples" / "granular")
    impacts = (lammps / "unittest" / "granular").exists()
    if impacts:
        for name in IMPACTS:
            shutil.copy(HERE / name, lammps / "unittest" / "granular" / "tests")
    for page, inserted in PAGES.items():
        path = lammps / page
        # An archive has no .gitignore.
        if (page in OF_IMPACTS and not impacts) or (path.name[0] == "." and not path.exists()):
            continue
        text = path.read_text("utf-8")
        for anchor, more in inserted:
            if more in text:
                continue
            at = text.rfind(anchor)
            if at < 0:
                sys.exit(f"{path}: no line has {anchor!r}: sources of another year?")
            end = text.index("\n", at) + 1
            if path.suffix == ".rst" and text[end : end + 1] == " ":  # the entry goes on
                end = text.index("\n", end) + 1
            text = text[:end] + more + text[end:]
        path.write_text(text, "utf-8")


def style(lammps: Path) -> int:
    """Run the checks of style of a tree; return how many lines they say of our files."""
    names = (*SUB_MODEL, UNIT_TEST, *IMPACTS, INPUT, *(Path(page).name for page in PAGES))
    told = []
    for check in ("whitespace", "permissions", "homepage", "errordocs", "fmtlib"):
        script = lammps / "tools" / "coding_standard" / f"{check}.py"
        words = [sys.executable, str(script), str(lammps)]
        run = subprocess.run(words, capture_output=True, text=True, check=False)
        told += [line for line in run.stdout.splitlines() if any(name in line for name in names)]
    granular = lammps / "src" / "GRANULAR"
    words = ["clang-format", "--dry-run", "--Werror", *SUB_MODEL]
    run = subprocess.run(words, cwd=granular, capture_output=True, text=True, check=False)
    told += [line for line in run.stderr.splitlines() if "error" in line]
    print("\n".join([*told, f"style: {len(told)} complaints of our files"]))
    return len(told)
