# Spack recipe: put this folder as packages/pendres into a repository of your own
# (`spack repo create`), then `spack dev-build -d FOLDER pendres@1.0.0` builds what is in FOLDER, the
# source tree.
from spack.package import *

try:  # Since Spack 1.0 build systems are beside the packages; before, spack.package has them.
    from spack_repo.builtin.build_systems.makefile import MakefilePackage
except ImportError:
    pass


class Pendres(MakefilePackage):
    """Resonance of driven, damped and noisy pendulums: a C library and a batch program."""

    url = "https://localhost/pendres-1.0.0.tar.gz"
    license("GPL-3.0-or-later")

    version("1.0.0")

    depends_on("c", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("gmake@4.2:", type="build")
    depends_on("sundials@6.4: +ARKODE +CVODE ~mpi")
    depends_on("hdf5@1.10: ~mpi +hl")
    depends_on("gsl@2:")
    depends_on("zlib-api")  # in the folders that Spack's compiler looks through by itself
    depends_on("random123", type="build")

    def settings(self, spec, prefix):
        return [f"PREFIX={prefix}", f"SUNDIALS_DIR={spec['sundials'].prefix}",
                f"HDF5_DIR={spec['hdf5'].prefix}", f"GSL_DIR={spec['gsl'].prefix}",
                f"CPPFLAGS=-I{spec['random123'].prefix.include}", "LDCONFIG=:"]

    def build(self, spec, prefix):
        make(*self.settings(spec, prefix))

    def install(self, spec, prefix):
        make("install", *self.settings(spec, prefix))
