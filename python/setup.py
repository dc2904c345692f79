"""Puts the public headers of libpendres, and their version, into the package that is built."""
import importlib.util
import os
import re
import subprocess

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = os.path.dirname(os.path.abspath(__file__))


def header_text():
    """The headers of the source tree around this folder, or of the library that is installed."""
    where = os.path.join(HERE, "..", "include", "pendres")
    if not os.path.exists(where):
        where = os.path.join(subprocess.check_output(
            ["pkg-config", "--variable=includedir", "pendres"], text=True).strip(), "pendres")
    spec = importlib.util.spec_from_file_location(
        "headers", os.path.join(HERE, "pendres", "_headers.py"))
    headers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(headers)
    return headers.folder_text(where)


class BuildWithHeaders(build_py):
    """build_py, and the headers beside the modules."""

    def run(self):
        super().run()
        with open(os.path.join(self.build_lib, "pendres", "headers.txt"), "w",
                  encoding="utf-8") as out:
            out.write(header_text())


setup(version=re.search(r'PENDRES_VERSION "(.*)"', header_text()).group(1),
      cmdclass={"build_py": BuildWithHeaders})
