# Sourced by ./quickstart and ./check: installs the Debian 12 packages that are missing.
# Works as root and as a user with sudo; does nothing (and needs no rights) when all are there.

build_packages="g++ cmake ninja-build pkg-config libeigen3-dev libsuitesparse-dev libmetis-dev
  libopenblas-dev libhypre-dev libhdf5-dev libsqlite3-dev sqlite3 nlohmann-json3-dev libvalijson-dev libudunits2-dev
  libopenmpi-dev openmpi-bin libcli11-dev libxxhash-dev libboost-dev"
test_packages="libgtest-dev libgmock-dev libbenchmark-dev librapidcheck-dev python3
  chromium chromium-driver python3-selenium fonts-liberation python3-pandas python3-h5py gmsh
  python3-dev python3-numpy pybind11-dev mypy python3-pip lintian dpkg-dev"   # the module for Python; packages
flow_packages="libopm-common-dev"   # optional: EGRID and restart files of flow simulators
peer_packages="slurmctld slurmd slurm-client iproute2 procps libfclib-dev libsiconos-numerics-dev
  paraview python3-paraview libopm-simulators-bin libpetsc-real-dev libmumps-dev"
lint_packages="clang-tidy"

install_packages() {  # package names
  missing=""
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q "ok installed" || missing="$missing $package"
  done
  [ -z "$missing" ] && return 0
  echo "Installing Debian packages:$missing"
  as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
      echo "These packages are missing and there is neither root nor sudo to install them:$missing" >&2
      return 4
    fi
    as_root="sudo"
  fi
  $as_root apt-get update -qq
  # shellcheck disable=SC2086
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
}
