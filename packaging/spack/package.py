# SPDX-License-Identifier: GPL-2.0-or-later
"""Recipe of Spack: copy this file to var/spack/repos/.../py-epdem/package.py."""

from spack.package import PythonPackage, depends_on, license, maintainers, version


class PyEpdem(PythonPackage):
    """Elastic-plastic particle contact for LIGGGHTS, YADE and LAMMPS, checked against theory."""

    pypi = "epdem/epdem-0.2.0.tar.gz"

    maintainers()
    license("GPL-2.0-or-later AND BSD-3-Clause")

    version("0.2.0")  # spack checksum py-epdem adds the checksum of the release

    depends_on("cxx", type="build")
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("py-scikit-build-core@0.11:", type="build")
    depends_on("cmake@3.20:", type="build")
    depends_on("py-numpy@1.26:", type=("build", "run"))
    depends_on("py-pandas@2.1:", type=("build", "run"))
    depends_on("py-h5py@3.10:", type=("build", "run"))
    depends_on("py-jinja2@3.1:", type=("build", "run"))
    depends_on("py-pint@0.24.4:", type=("build", "run"))
    depends_on("py-pydantic@2.7:", type=("build", "run"))
    depends_on("py-tomlkit@0.12:", type=("build", "run"))
    depends_on("py-pyyaml@6:", type=("build", "run"))
    depends_on("py-typer@0.29:", type=("build", "run"))
    depends_on("py-rich@15:", type=("build", "run"))
    depends_on("py-matplotlib@3.8:", type=("build", "run"))
    depends_on("py-psutil@5.9.8:", type=("build", "run"))
    depends_on("py-scipy@1.11.1:", type=("build", "run"))
    depends_on("py-trimesh@4.5:", type=("build", "run"))

    def config_settings(self, spec, prefix):
        """The LIGGGHTS plugin needs Debian's LIGGGHTS; 'epdem export liggghts' serves other trees."""
        return {"cmake.define.EPDEM_PLUGIN": "OFF"}
