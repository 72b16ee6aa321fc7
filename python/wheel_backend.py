"""What pip asks to build the module (PEP 517), with CMake and nothing else: no network, no other build tools.

FAULTSIM_BUILD=FOLDER takes what is built there already; otherwise everything is built from nothing, in a folder that is
gone afterwards.
"""

import base64
import hashlib
import os
import subprocess
import sysconfig
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
NAME = f"{PROJECT['name']}-{PROJECT['version']}"
PYTHON = sysconfig.get_config_var("py_version_nodot")
TAG = f"cp{PYTHON}-cp{PYTHON}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def metadata():
    lines = ["Metadata-Version: 2.1", f"Name: {PROJECT['name']}", f"Version: {PROJECT['version']}",
             f"Summary: {PROJECT['description']}", f"Requires-Python: {PROJECT['requires-python']}"]
    return "\n".join(lines + [f"Requires-Dist: {one}" for one in PROJECT["dependencies"]]) + "\n"


def build_into(folder):
    """The package, as cmake --install puts it."""
    with tempfile.TemporaryDirectory() as scratch:
        build = os.environ.get("FAULTSIM_BUILD", "")
        if not build:
            build = scratch
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF",
                            "-DFAULTSIM_PRECOMPILE=ON", "-DCMAKE_UNITY_BUILD=ON"], check=True)
            subprocess.run(["cmake", "--build", build, "--target", "faultsim_python"], check=True)
        subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", folder, "--strip"], check=True)


def record_line(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Called by pip."""
    wheel = Path(wheel_directory) / f"{NAME}-{TAG}.whl"
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as out:
        build_into(folder)
        files = {f"faultsim/{path.name}": path.read_bytes() for path in sorted(Path(folder).glob("**/faultsim/*"))}
        files[f"{NAME}.dist-info/METADATA"] = metadata().encode()
        files[f"{NAME}.dist-info/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: faultsim\nRoot-Is-Purelib: false\nTag: {TAG}\n".encode()
        files[f"{NAME}.dist-info/LICENSE"] = (ROOT / "LICENSE").read_bytes()
        record = "".join(record_line(name, data) for name, data in files.items())
        files[f"{NAME}.dist-info/RECORD"] = f"{record}{NAME}.dist-info/RECORD,,\n".encode()
        for name, data in files.items():
            out.writestr(name, data)
    return wheel.name
