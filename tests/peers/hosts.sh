# Sourced by tests that need several hosts. The script that sources it is run again in namespaces of its
# own (processes, mounts, network, host name), where two "hosts" share the file system and are joined by
# a cable: host1, on which the script runs, and host2. All that it starts ends with it.
#   on_host2 COMMAND...   runs a command on host2
#   $work                 a folder of its own;  $bin  the folder of the binaries, in PATH
#   $disk                 a folder that each host has for itself, also for temporary files
# shellcheck shell=bash
set -eu
if [ "${INSIDE:-}" != yes ]; then
  skip() { echo "SKIPPED: $1"; exit 0; }
  [ "${NEEDS_ROOT:-no}" = no ] || [ "$(id -u)" -eq 0 ] || skip "it needs root"
  for program in ip unshare nsenter sqlite3 ${NEEDED_PROGRAMS:-}; do
    command -v "$program" >/dev/null || skip "there is no $program"
  done
  as_root=  # in their namespaces everybody can be root
  [ "$(id -u)" -eq 0 ] || as_root=--map-root-user
  unshare $as_root --pid --fork --mount --mount-proc --net --uts true 2>/dev/null || skip "namespaces cannot be made here"
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  export work INSIDE=yes
  status=0
  unshare $as_root --pid --fork --kill-child --mount --mount-proc --net --uts "$0" "$@" || status=$?
  exit $status
fi

bin=$(cd "$1" && pwd)
root=$(cd "$(dirname "$0")/../.." && pwd)
disk=$work/disk
PATH=$bin:$PATH
unset FAULTSWEEP_STORE FAULTSIM_BINARY
export PATH TMPDIR=$disk
mkdir "$disk" "$work/disk1" "$work/disk2"
printf '127.0.0.1 localhost\n10.0.0.1 host1\n10.0.0.2 host2\n' >"$work/hosts"
mount --bind "$work/hosts" /etc/hosts
mkfifo "$work/ready"
unshare --net --uts --mount sh -c "
  hostname host2
  mount --bind $work/disk2 $disk
  echo >$work/ready
  exec sleep infinity" &
host2=$!
read -r _ <"$work/ready"
hostname host1
mount --bind "$work/disk1" "$disk"
on_host2() { nsenter --target $host2 --net --uts --mount --wd="$PWD" "$@"; }
ip link add eth1 type veth peer name eth2
ip link set eth2 netns $host2
ip link set lo up
ip addr add 10.0.0.1/24 dev eth1
ip link set eth1 up
on_host2 ip link set lo up
on_host2 ip addr add 10.0.0.2/24 dev eth2
on_host2 ip link set eth2 up
cat >"$work/agent" <<A
#!/bin/sh
# What ssh is elsewhere: agent HOST COMMAND...
[ "\$1" = host2 ] || { echo "agent: no host \$1" >&2; exit 1; }
shift
exec nsenter --target $host2 --net --uts --mount sh -c "\$*"
A
chmod +x "$work/agent"
cd "$work"

fail() { echo "FAILED: $1" >&2; exit 1; }
expect() {  # WHAT FOUND WANTED
  [ "$2" = "$3" ] || fail "$1: $2, not $3"
}
# A campaign of 2 families of milliseconds each case, in plane strain: write_spec NUMBER_OF_ANGLES [NAME]
write_spec() {
  cat >spec.json <<J
{ "format": 1, "name": "${2:-field}", "base": "$root/docs/examples/scenes/rotliegend.json",
  "set": { "/tier": "custom", "/mesh": { "dip": "25 m", "normal": "25 m" }, "/numerics/plane_strain": "on",
           "/numerics/activation_length": "100 m" },
  "design": { "kind": "grid", "parameters": { "offset": ["0 m", "100 m"],
    "friction_angle": { "from": "15 deg", "to": "30 deg", "count": $1 } } } }
J
}
submit() {  # STORE
  faultsweep submit spec.json --store "$1" >/dev/null 2>&1
}
sql() {  # STORE QUERY
  sqlite3 -cmd ".timeout 10000" "$1/campaign.sqlite" "$2"
}
# All numbers of all cases at full precision, in an order that does not depend on who ran what.
numbers() {  # STORE
  sqlite3 -cmd ".timeout 10000" -quote "$1/campaign.sqlite" \
    "select * from stage_ranking order by 1, 2, 3; select * from ranking order by 1, 2;
     select cc.position, h.fault, h.step, h.chi_bar, h.chi_max, h.area_chi_080_m2, h.slipping_area_m2, h.max_slip_m,
       h.potency_m3, h.moment_nm from chi_history h join campaign_cases cc on cc.case_id = h.case_id order by 1, 2, 3"
}
expect_same_numbers() {  # STORE OTHER
  numbers "$1" >"$work/numbers1"
  numbers "$2" >"$work/numbers2"
  [ -s "$work/numbers1" ] || fail "there are no numbers in $1"
  cmp -s "$work/numbers1" "$work/numbers2" || fail "the numbers of $2 are not those of $1"
}
wait_for_cases() {  # STORE NUMBER [CONDITION]: completed runs
  for _ in $(seq 300); do
    [ "$(sql "$1" "select count(*) from runs where status = 'completed' and ${3:-1}")" -ge "$2" ] && return
    sleep 0.1
  done
  fail "there are no $2 completed cases in $1"
}
