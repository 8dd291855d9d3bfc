#!/usr/bin/env bash
# Starts a Slurm of one node on this machine, to try the recipes without a cluster. It uses Debian's packages, without systemd and cgroups.
# Run it as root on a machine that nobody else uses; `slurm-node.sh stop` ends it.
set -euo pipefail

state=${SLURM_STATE:-/tmp/slurm-node}
export SLURM_CONF=$state/slurm.conf

if [ "${1:-start}" = stop ]; then
    for daemon in slurmd slurmctld munged; do pkill -x "$daemon" || true; done
    rm -rf "$state"
    exit
fi

command -v slurmctld >/dev/null || {
    apt-get update -q
    apt-get install -y -q --no-install-recommends slurm-wlm munge
}
mkdir -p "$state/control" "$state/node" /run/munge
node=$(hostname -s)
cat >"$SLURM_CONF" <<END
ClusterName=one
SlurmctldHost=$node(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
StateSaveLocation=$state/control
SlurmdSpoolDir=$state/node
SlurmctldLogFile=$state/slurmctld.log
SlurmdLogFile=$state/slurmd.log
SlurmctldPidFile=$state/slurmctld.pid
SlurmdPidFile=$state/slurmd.pid
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(free --mega | awk '/^Mem/ { print int(0.8 * $2) }') State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
# One user runs all daemons, as munge requires.
chown root: /etc/munge/munge.key /run/munge /var/log/munge /var/lib/munge
pgrep -x munged >/dev/null || munged --force
pgrep -x slurmctld >/dev/null || slurmctld
pgrep -x slurmd >/dev/null || slurmd
for _ in $(seq 60); do
    if sinfo --noheader --format %t | grep -q idle; then
        echo "export SLURM_CONF=$SLURM_CONF"
        exit
    fi
    sleep 0.5
done
echo "the node does not become idle; see $state/*.log" >&2
exit 1
