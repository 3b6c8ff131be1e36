#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Slurm with one controller and one node on this machine: a job array of a sweep, a task of it requeued; an array that joins
# one film; the same by GNU parallel. Every result must be that of one process, byte by byte.
#   tests/support/check_slurm.sh UNFURL
set -eu
PATH=$PATH:/usr/sbin
unfurl=$1
work=$(mktemp -d)
export SLURM_CONF="$work/slurm.conf"
stop() {
  for daemon in slurmd slurmctld munged; do
    [ ! -s "$work/$daemon.pid" ] || kill "$(cat "$work/$daemon.pid")" 2>/dev/null || :
  done
  sleep 1
  rm -rf "$work" || { sleep 3; rm -rf "$work"; }
}
trap stop EXIT
say() { echo "slurm: $*"; }
fail() { say "$*"; tail -n 20 "$work"/*.log; exit 1; }

mkdir "$work/state" "$work/spool"
chmod 755 "$work"
head -c 1024 /dev/urandom >"$work/munge.key"
chmod 400 "$work/munge.key"
munged --force --socket="$work/munge.socket" --key-file="$work/munge.key" --pid-file="$work/munged.pid" \
  --seed-file="$work/munge.seed" --log-file="$work/munged.log"
host=$(hostname -s)
port=$((20000 + $$ % 20000))
cat >"$SLURM_CONF" <<END
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
SlurmctldPort=$port
SlurmdPort=$((port + 1))
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
slurmctld
slurmd
tries=0
until sinfo -h -o %t 2>/dev/null | grep -qE 'idle|mix|alloc'; do
  tries=$((tries + 1))
  [ $tries -lt 100 ] || fail "the node does not come up: $(sinfo 2>&1)"
  sleep 0.2
done
cd "$work"
finished() {  # of a job: no task of it is waiting or running
  tries=0
  while squeue -h -j "$1" 2>/dev/null | grep -q .; do
    tries=$((tries + 1))
    [ $tries -lt 600 ] || fail "job $1 does not end: $(squeue)"
    sleep 0.2
  done
}

sweep="sweep hoop6_sector --vary structure.fold_angle=40:80:9 --vary structure.hinge_force=100:300:4 --measure deploy_time"
# shellcheck disable=SC2086
"$unfurl" $sweep -o one --quiet
# shellcheck disable=SC2086
"$unfurl" $sweep -o many --script slurm --jobs 3 >job.sh
sed -i "s|^exec unfurl|exec $unfurl|" job.sh
job=$(sbatch --parsable job.sh)
scontrol requeue "${job}_2" 2>/dev/null || :  # done, running or waiting: it does its share again or goes on with it
finished "$job"
# shellcheck disable=SC2086
"$unfurl" $sweep -o many --merge many --quiet || fail "the merge: $(cat slurm-*.out)"
cmp one/sweep.csv many/sweep.csv
say "a sweep by an array of three tasks, one requeued: the bytes of one process"

film="render pendulum --dpi 60 --size 64x48 --fps 10 --set solver.end_time=1 --quiet"
# shellcheck disable=SC2086
"$unfurl" $film -o film
job=$(sbatch --parsable --array=1-3 --wrap "exec '$unfurl' $film --threads 1 -o joined --join --lease 5")
finished "$job"
for frame in film/frames/*.png film/animation.webp; do cmp "$frame" "joined/${frame#film/}" || fail "$(cat slurm-*.out)"; done
say "a film that three tasks join: $(find film/frames -name '*.png' | wc -l) frames, the bytes of one process"

# shellcheck disable=SC2086
"$unfurl" $sweep -o parallel --script parallel --jobs 3 | sed "s|unfurl sweep|$unfurl sweep|g" >parallel.sh
sh parallel.sh >parallel.log 2>&1 || fail "GNU parallel"
cmp one/sweep.csv parallel/sweep.csv
say "the same by GNU parallel"
