"""Builds the extension echopath._core with CMake. Everything else is declared in pyproject.toml.

Environment: ECHOPATH_BUILD_DIR keeps CMake's build folder (default: the temporary one of this build), CMAKE_ARGS adds
arguments to its configuration.
"""
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).parent.resolve()


def configure_command(build_dir):
    import pybind11

    command = ["cmake", "-S", str(ROOT), "-B", str(build_dir), "-DECHOPATH_BUILD_PYTHON=ON", "-DECHOPATH_BUILD_TESTS=OFF",
               f"-DPython_EXECUTABLE={sys.executable}", f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]
    if shutil.which("ninja") and not (build_dir / "CMakeCache.txt").exists():
        command += ["-G", "Ninja"]
    return command + shlex.split(os.environ.get("CMAKE_ARGS", ""))


class BuildWithCMake(build_ext):
    def build_extension(self, extension):
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        build_dir = Path(os.environ.get("ECHOPATH_BUILD_DIR") or self.build_temp).resolve()
        build_dir.mkdir(parents=True, exist_ok=True)
        subprocess.run(configure_command(build_dir), check=True)
        subprocess.run(["cmake", "--build", str(build_dir), "--target", "_core", "--parallel", str(os.cpu_count())],
                       check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)  # a running program may have the old file mapped: never write into it
        shutil.copy2(build_dir / "python" / "bindings" / target.name, target)


setup(
    packages=find_packages("python") + find_packages("viewer") + ["echopath.data"],
    package_dir={"": "python", "echopath_viewer": "viewer/echopath_viewer", "echopath.data": "data"},
    package_data={"echopath": ["py.typed", "*.pyi"], "echopath.data": ["**/*"]},
    ext_modules=[Extension("echopath._core", sources=[])],
    cmdclass={"build_ext": BuildWithCMake},
)
