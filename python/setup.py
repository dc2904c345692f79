"""Puts the public headers of libpendres, and their version, into the package that is built; where
the library's sources are beside this file, as in a source distribution, library and program too.

They are made with the Makefile, which sees the environment: CC, CPPFLAGS, LDFLAGS, SUNDIALS_DIR.
"""
import glob
import importlib.util
import os
import re
import shutil
import subprocess

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from setuptools.errors import ExecError

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # before setuptools 70
    from wheel.bdist_wheel import bdist_wheel

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCES = os.path.join(HERE, "library")
WHOLE = os.path.exists(SOURCES)
NEEDS = """the library was not built ({why}). Its sources need a C compiler, GNU make, pkg-config,
SUNDIALS 6.4 or later, HDF5, GSL, Random123 and zlib; a wheel needs none of them. Debian and Ubuntu:
    apt-get install gcc libc6-dev libgsl-dev libhdf5-dev librandom123-dev libsundials-dev make \\
      pkg-config zlib1g-dev"""


def header_text():
    """The headers of the sources here, of the source tree around this folder, or of the library
    that is installed."""
    wheres = [os.path.join(top, "include", "pendres") for top in (SOURCES, os.path.dirname(HERE))]
    where = next(filter(os.path.exists, wheres), None)
    if not where:
        where = os.path.join(subprocess.check_output(
            ["pkg-config", "--variable=includedir", "pendres"], text=True).strip(), "pendres")
    spec = importlib.util.spec_from_file_location(
        "headers", os.path.join(HERE, "pendres", "_headers.py"))
    headers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(headers)
    return headers.folder_text(where)


class BuildPackage(build_py):
    """build_py, and beside the modules the headers and, if we have its sources, the library."""

    def run(self):
        super().run()
        package = os.path.join(self.build_lib, "pendres")
        with open(os.path.join(package, "headers.txt"), "w", encoding="utf-8") as out:
            out.write(header_text())
        if WHOLE:
            jobs = f"-j{os.cpu_count() or 1}"
            try:
                subprocess.check_call(["make", "-C", SOURCES, "BUILD=build", jobs],
                                      env={"CFLAGS": "-O3", **os.environ})
            except (OSError, subprocess.CalledProcessError) as why:
                raise ExecError(NEEDS.format(why=why)) from None
            library, = glob.glob(os.path.join(SOURCES, "build", "libpendres.so.*.*.*"))
            shutil.copy(library, os.path.join(package, "libpendres.so"))


class PlatformWheel(bdist_wheel):
    """A wheel with compiled code that no version of Python matters to."""

    def get_tag(self):
        return ("py3", "none", super().get_tag()[2]) if WHOLE else super().get_tag()


class Compiled(Distribution):
    """It goes where compiled code goes."""

    def has_ext_modules(self):
        return WHOLE


# Where `make install` puts them below its prefix, which is the environment's here.
DATA = {"bin": "resonance", "share/man/man1": "man/resonance.1",
        "share/pendres/input": "input/*.nml", "share/pendres/plots": "plots/*.py"}


def data_files():
    """The program, which is made later, and what belongs to it."""
    return [(folder, glob.glob(os.path.join("library", files)) or [os.path.join("library", files)])
            for folder, files in DATA.items()]


setup(version=re.search(r'PENDRES_VERSION "(.*)"', header_text()).group(1),
      data_files=data_files() if WHOLE else [],
      distclass=Compiled,
      cmdclass={"build_py": BuildPackage, "bdist_wheel": PlatformWheel})
