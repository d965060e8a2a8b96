"""Lets pip build the Python module by CMake, in build/pip."""

import pathlib
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        build = ROOT / "build" / "pip"
        subprocess.run(
            [
                "cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG", "-DCAROM_BUILD_PYTHON=ON",
                "-DCAROM_BUILD_TESTS=OFF", "-DCAROM_BUILD_BENCHMARKS=OFF",
                f"-DPython_EXECUTABLE={sys.executable}",
            ],
            check=True,
        )
        subprocess.run(["cmake", "--build", str(build), "--target", "carom_python"], check=True)
        made = next((build / "python" / "carom").glob("_carom*.so"))
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(made.read_bytes())


setup(ext_modules=[Extension("carom._carom", [])], cmdclass={"build_ext": BuildByCMake})
