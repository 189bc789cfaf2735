#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# slurm_single_node.sh MAREY MOTIONS WORK
#
# Builds a library of the folder MOTIONS twice: by `marey library build`, and by
# `marey library plan --slurm` on a Slurm of this machine alone, which the script starts
# in the folder WORK and stops at the end. A running task is killed and queued again.
# Fails if a file of one library differs from the other's. Prints "skipped:" and a reason
# if Slurm and munge are not installed.
set -euo pipefail
readonly MAREY=$1 MOTIONS=$2 WORK=$3
export PATH=$PATH:/usr/sbin:/sbin
readonly SHARDS=4 MAX_S=400

for command in munged slurmctld slurmd sbatch; do
  if ! command -v $command >/dev/null; then
    echo "skipped: $command is missing; apt-get install slurm-wlm munge"
    exit 0
  fi
done
if [[ $(id -u) != 0 ]]; then
  echo "skipped: slurmd starts tasks as root only"
  exit 0
fi

if [[ ! -d $MOTIONS ]]; then
  echo "skipped: $MOTIONS is missing"
  exit 0
fi

# Daemons are children in the foreground, and end with this script, even if it is killed.
daemons=()
readonly DAEMON="setpriv --pdeathsig KILL"
stop_daemons() {
  local status=$? pid
  trap - EXIT
  if ((${#daemons[@]} == 3)); then
    scancel --user=root >/dev/null 2>&1 || true
    for _ in $(seq 100); do
      [[ $(squeue --noheader 2>/dev/null) ]] || break
      sleep 0.1
    done
  fi
  # In the order slurmd, slurmctld, munged: each needs the next one to end its work.
  for ((k = ${#daemons[@]} - 1; k >= 0; --k)); do
    pid=${daemons[k]}
    kill "$pid" 2>/dev/null || true
    for _ in $(seq 50); do
      kill -0 "$pid" 2>/dev/null || break
      sleep 0.1
    done
    kill -9 "$pid" 2>/dev/null || true
  done
  wait 2>/dev/null || true
  if [[ $status != 0 ]]; then tail -n 20 "$WORK"/slurm/log/*.log "$WORK"/*.log >&2 || true; fi
  rm -rf "$WORK"
  exit "$status"
}

fail() {
  echo "error: $*" >&2
  exit 1
}

free_port() {
  local port
  for _ in $(seq 50); do
    port=$((20000 + RANDOM % 20000))
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
  done
  echo "$port"
}

# Waits until a command succeeds.
await() {
  local what=$1
  shift
  until "$@"; do
    ((SECONDS < MAX_S)) || fail "$what: not within $MAX_S s"
    sleep 0.2
  done
}

start_slurm() {
  local base=$WORK/slurm host
  host=$(hostname -s)
  mkdir -p "$base"/{state,spool,log,run}
  # munged refuses folders that others may write to, and tasks need its socket.
  chmod 755 "$base" "$base/run"
  chmod 700 "$base/log"
  dd if=/dev/urandom of="$base/munge.key" bs=128 count=1 status=none
  chmod 600 "$base/munge.key"
  $DAEMON munged --foreground --force --key-file="$base/munge.key" --socket="$base/run/munge.sock" \
    --pid-file="$base/run/munged.pid" --log-file="$base/log/munged.log" \
    --seed-file="$base/run/seed" >"$base/log/munged_out.log" 2>&1 &
  daemons+=($!)
  cat >"$base/slurm.conf" <<TEXT
ClusterName=marey
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$base/run/munge.sock
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$base/state
SlurmdSpoolDir=$base/spool
SlurmctldPidFile=$base/run/slurmctld.pid
SlurmdPidFile=$base/run/slurmd.pid
SlurmctldLogFile=$base/log/slurmctld.log
SlurmdLogFile=$base/log/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE State=UP
TEXT
  export SLURM_CONF=$base/slurm.conf
  await "munged" test -S "$base/run/munge.sock"
  $DAEMON slurmctld -D -f "$SLURM_CONF" >"$base/log/slurmctld_out.log" 2>&1 &
  daemons+=($!)
  $DAEMON slurmd -D -f "$SLURM_CONF" >"$base/log/slurmd_out.log" 2>&1 &
  daemons+=($!)
  await "the node of Slurm" is_idle
}

is_idle() { sinfo --noheader --format=%t 2>/dev/null | grep -qx idle; }
has_no_job() {
  # Slurm waits two minutes before a task that was queued again starts.
  if [[ $task ]]; then scontrol update "JobId=$task" StartTime=now 2>/dev/null || true; fi
  [[ -z $(squeue --noheader 2>/dev/null || echo failed) ]]
}
first_started() { [[ $(squeue --noheader --array --states=running 2>/dev/null) || -e $1/library.sqlite ]]; }

make_library() {
  mkdir -p "$1"
  cat >"$1/library.toml" <<TEXT
format = 1
name = "walks"
[[source]]
path = "$MOTIONS"
licence = "CC0-1.0"
TEXT
}

# Prints the SHA-256 of every file that a build made.
built_files() {
  (cd "$1" && find . -type f ! -path './.cache/*' ! -name library.toml ! -name '*.log' \
    -print0 | sort -z | xargs -0 sha256sum)
}

rm -rf "$WORK"
mkdir -p "$WORK"
task=
trap stop_daemons EXIT
trap 'exit 130' INT TERM HUP
start_slurm

make_library "$WORK/plain"
"$MAREY" library build "$WORK/plain"

readonly LIBRARY=$WORK/slurm_library
make_library "$LIBRARY"
"$MAREY" library plan "$LIBRARY" --shards $SHARDS --slurm >"$WORK/job.sh"
sh "$WORK/job.sh"
await "a task" first_started "$LIBRARY"
task=$(squeue --noheader --array --states=running --format=%i | head -n 1)
if [[ $task ]] && scontrol requeue "$task"; then
  echo "task $task was killed and queued again"
else
  echo "no task was killed: they ended at once"
fi
await "the jobs" has_no_job
cat "$LIBRARY/merge.log"

built_files "$WORK/plain" >"$WORK/plain.txt"
built_files "$LIBRARY" >"$WORK/slurm.txt"
[[ -s $WORK/plain.txt ]] || fail "the plain build made nothing"
diff "$WORK/plain.txt" "$WORK/slurm.txt" || fail "the libraries differ"
echo "$(wc -l <"$WORK/plain.txt") files are the same"
