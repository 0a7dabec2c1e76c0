"""Build hook: compiles laws with the package; without a compiler the wheel is pure."""

import hashlib
import os
import shlex
import shutil
import subprocess
import sysconfig
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HEADERS = Path("contactlab/kernels")
FOLDER = "contactlab_laws/compiled"
#: The order of ``SOURCES`` there: the library tells by their digest whether it is of today.
SOURCES = (
    HEADERS / "contactlab_impact.h", HEADERS / "contactlab_march.h",
    Path("plugins", FOLDER, "impacts.c"), Path("plugins", FOLDER, "marches.c"),
)  # fmt: skip
LIBRARY = f"{FOLDER}/_compiled.so"
#: No contraction of products and sums: the same bits on every machine. Loops over rows of springs
#: are made of instructions that take several numbers by -O3, roots only where they set no errno.
FLAGS = ("-std=c99", "-O3", "-fno-math-errno", "-ffp-contract=off", "-shared", "-fPIC")


class CompiledHook(BuildHookInterface):
    """Adds the library to a wheel; an editable installation has it beside its source."""

    PLUGIN_NAME = "custom"
    folder = None

    def initialize(self, version, build_data):
        """Compile the library; say so where that is not possible."""
        compiler = shlex.split(os.environ.get("CC") or "cc")  # it may have options, or a wrapper
        found = compiler and shutil.which(compiler[0])
        wanted = os.environ.get("CONTACTLAB_COMPILED", "").strip().lower()
        if wanted in ("0", "false", "no", "off") or not found:
            self.app.display_info("contactlab: no C compiler is used, Python computes all")
            return
        root = Path(self.root)
        editable = version == "editable"
        # not beside the wheel, where everything is uploaded
        self.folder = None if editable else tempfile.TemporaryDirectory()
        target = (
            root / "plugins" / LIBRARY if editable else Path(self.folder.name) / Path(LIBRARY).name
        )
        digest = hashlib.sha256(b"".join((root / each).read_bytes() for each in SOURCES))
        fresh = target.with_name(f"{target.name}.{os.getpid()}")
        command = [
            *compiler, *FLAGS, f'-DCONTACTLAB_SOURCES="{digest.hexdigest()}"',
            f"-I{root / HEADERS}", *(str(root / each) for each in SOURCES if each.suffix == ".c"),
            "-o", str(fresh), "-lm",
        ]  # fmt: skip
        made = subprocess.run(command, capture_output=True, text=True, check=False)
        if made.returncode:
            self.app.display_warning(f"contactlab: Python computes all: {made.stderr}")
            return
        fresh.replace(target)
        if not editable:
            build_data["force_include"][str(target)] = LIBRARY
            build_data["pure_python"] = False
            platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
            build_data["tag"] = f"py3-none-{platform}"

    def finalize(self, version, build_data, artifact_path):
        """Remove the library that the wheel now holds."""
        if self.folder is not None:
            self.folder.cleanup()
