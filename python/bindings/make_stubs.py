"""Writes python/echopath/_core.pyi, which tells editors and type checkers what is in the extension, from the extension itself.

    python python/bindings/make_stubs.py

To be run after a change to the bindings, with the extension built; tests/python/documents/test_stubs.py compares.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from stub_types import IMPORTS as TYPE_IMPORTS, with_known_types

from echopath import DeviceError, FileError

# The signatures that Python shows of the extension have no types: those of its docstrings have.
RUN = """
import inspect
import pybind11_stubgen
def no_signature(function): raise TypeError("to be read from the docstring")
inspect.getfullargspec = no_signature
pybind11_stubgen.main()
"""
TARGET = Path(__file__).resolve().parents[1] / "echopath" / "_core.pyi"
HEAD = ('"""The C++ core of echopath; use it through the package.\n\n'
        'Written by python/bindings/make_stubs.py: do not edit.\n"""\n')
IMPORTS = "from collections.abc import Sequence\nfrom numpy.typing import ArrayLike\nimport types\n" + TYPE_IMPORTS
# pybind11-stubgen imports them from the package, which has them from here: type checkers would find neither.
ERRORS = "".join(f'class {error.__name__}({error.__base__.__name__}):\n    """\n    {error.__doc__}\n    """\n'
                 for error in (DeviceError, FileError))
# What pybind11-stubgen writes -> what a reader and a type checker make more of.
PLAIN = [
    (r"\A\"\"\".*?\"\"\"\n", HEAD),                                       # of the module
    (r"from \. import bench\n", ""),
    (r"from echopath import (?:DeviceError|FileError)\n", ""),
    (r"(?m)^(__all__: .*\n)", rf"bench: types.ModuleType\n\1{ERRORS}"),   # only echopath.bench uses the first
    (r"typing\.SupportsFloat \| typing\.SupportsIndex", "float"),
    (r"typing\.SupportsInt \| typing\.SupportsIndex", "int"),
    (r"typing\.SupportsIndex", "int"),
    (r"\bos\.PathLike\b(?!\[)", "os.PathLike[str]"),
    (r"(: |-> )\.\.\.(?=[,):])", r"\1typing.Any"),                        # types of C++ without a name in Python
    (r"(?<![\w.\[])(dict|list|tuple|set)(?=[,):\n]| =| \|)", r"\1[typing.Any]"),
    (r"dict\[typing\.Any\]", "dict[typing.Any, typing.Any]"),
    (r"tuple\[typing\.Any\]", "tuple[typing.Any, ...]"),
    (r"\*\*kwargs\)", "**kwargs: typing.Any)"),
    (r"\*\*kwargs: typing\.Any(?=\) -> AntennaPattern)", "**kwargs: object"),  # those of its kind
    (r"\*args,", "*args: typing.Any,"),
    (r"(def __eq__\(self, [^:]*: )[^)]*\) -> (?!Selection)[^:]*:", r"\1object) -> bool:"),
    (r"numpy\.ndarray(?!\[)", "numpy.ndarray[typing.Any, typing.Any]"),
    (r"(\w+: [A-Z]\w+) = None", r"\1 | None = None"),
    (r"    def __setattr__\(self, .*\n        \.\.\.\n", ""),                   # says what to write instead
    (r"    def __r?(?:and|or)__\(self, arg0: typing\.Any\) -> None:\n        \.\.\.\n", ""),  # likewise
    (r"(    @staticmethod\n)?    def __init__\(\*args: .*\n +\"\"\"\n +Raises TypeError: is made by .*\n +\"\"\"\n", ""),
    (r"(__hash__: typing\.ClassVar\[None\] = None)", r"\1  # type: ignore[assignment]"),
    (r"def __(eq|ne)__\(self, arg0: [^)]*\) -> Selection:",
     r"def __\1__(self, arg0: object) -> Selection:  # type: ignore[override]"),
    (r"(?m)(-> (?:list|tuple)\[)(.*\b)tuple\b(?!\[)", r"\1\2tuple[typing.Any, ...]"),
    (r"(?m)[ \t]+$", ""),
]


def stubs() -> str:
    """The text that the file should hold. Raises CalledProcessError where pybind11-stubgen fails."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-c", RUN, "echopath._core", "-o", folder], check=True, capture_output=True)
        text = (Path(folder) / "echopath" / "_core" / "__init__.pyi").read_text(encoding="utf-8")
    for pattern, plain in PLAIN:
        text = re.sub(pattern, plain, text, flags=re.DOTALL) if pattern.startswith(r"\A") else re.sub(pattern, plain, text)
    text = text.replace("from __future__ import annotations\n", f"from __future__ import annotations\n{IMPORTS}", 1)
    return with_known_types(text)


if __name__ == "__main__":
    TARGET.write_text(stubs(), encoding="utf-8")
    print(f"{TARGET}: written")
