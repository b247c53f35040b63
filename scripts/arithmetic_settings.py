"""Lists the arithmetic settings that this machine offers, one a line: name, tab, variables.

Processors round differently because libraries choose other instructions for each: OpenBLAS by the
core, numpy by the vector units it was built for, numba by the processor's name. A setting makes
them take those of another processor. Only settings that take effect here are listed: OpenBLAS is
asked which core it took, numpy which units are left on.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

CORES = {
    "SkylakeX": {"avx512f", "avx512bw", "avx512dq", "avx512vl", "avx512cd"},
    "Haswell": {"avx2", "fma"},
    "Zen": {"avx2", "fma"},
    "Sandybridge": {"avx"},
    "Nehalem": {"sse4_2"},
    "Prescott": {"pni"},
}
"""OpenBLAS's names for x86 cores, and the processor's flags that each needs."""
ASK = "import arithmetic_settings as s; print(s.blas_core(), s.numpy_units(), sep=chr(10))"


def blas_core() -> str:
    """The core that numpy's OpenBLAS took in this process, or nothing where it does not say."""
    import numpy as np

    for folder in Path(np.__file__).resolve().parent.parent.glob("numpy.libs"):
        for file in folder.glob("*openblas*"):
            library = ctypes.CDLL(str(file))
            for name in ("scipy_openblas_get_corename64_", "openblas_get_corename64_",
                         "openblas_get_corename"):  # fmt: skip
                call = getattr(library, name, None)
                if call is not None:
                    call.restype = ctypes.c_char_p
                    return bytes(call()).decode()
    return ""


def numpy_units() -> str:
    """The vector units beyond numpy's baseline that it dispatches to in this process."""
    from numpy._core import _multiarray_umath as core

    return " ".join(name for name in core.__cpu_dispatch__ if core.__cpu_features__.get(name))


def flags() -> set[str]:
    """The processor's flags, as Linux tells them; empty elsewhere."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text(encoding="utf-8").splitlines() if info.is_file() else []
    return next((set(line.split(":")[1].split()) for line in lines if line.startswith("flags")),
                set())  # fmt: skip


def under(variables: dict[str, str]) -> list[str]:
    """Core and units of a fresh process under the variables."""
    done = subprocess.run(
        [sys.executable, "-c", ASK], env={**os.environ, **variables}, capture_output=True,
        text=True, cwd=Path(__file__).parent, check=True,
    )  # fmt: skip
    return [*done.stdout.splitlines(), "", ""][:2]


def settings() -> Iterator[tuple[str, dict[str, str]]]:
    """Name and variables of each, the machine's own first and the plainest last."""
    own, units = under({})
    yield "native", {}
    plain: dict[str, str] = {"NUMBA_CPU_NAME": "generic"}
    for core, needed in CORES.items():
        choice = {"OPENBLAS_CORETYPE": core}
        if core != own and needed <= flags() and under(choice)[0] == core:
            yield f"blas-{core}", choice
            plain |= choice
    off = {"NPY_DISABLE_CPU_FEATURES": units}
    if units and not under(off)[1]:
        yield "numpy-baseline", off
        plain |= off
    yield "numba-generic", {"NUMBA_CPU_NAME": "generic"}
    yield "plainest", plain


if __name__ == "__main__":
    for label, variables in settings():
        print(label, *(f"{name}={value}" for name, value in variables.items()), sep="\t")
