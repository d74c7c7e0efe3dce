#!/usr/bin/env bash
# Runs a study under a real Slurm: installs Debian's slurm-wlm if it is missing, starts one node on
# the loopback device in a directory of its own, submits the scripts that `lilytank study slurm`
# prints, disturbs them, and compares the merged tables byte for byte with a run without Slurm.
#
# usage: run.sh PROGRAM        exit code 77: skipped, the last line says why
set -euo pipefail
program=$(realpath "$1")
PATH=$PATH:/usr/sbin:/sbin

fail() {
  echo "failed: $1"
  exit 1
}

skip() {
  echo "skipped: $1"
  exit 77
}

installed() { command -v slurmctld slurmd sbatch | wc -l | grep -qx 3; }

if ! installed; then
  ((EUID == 0)) || skip "Slurm is not installed, and only root can install it"
  command -v apt-get > /dev/null || skip "Slurm is not installed, and this is not Debian"
  (apt-get -qq update && DEBIAN_FRONTEND=noninteractive apt-get -qq -o=Dpkg::Use-Pty=0 install \
    --no-install-recommends slurm-wlm) > /dev/null 2>&1 || skip "Debian's slurm-wlm cannot be installed"
  installed || skip "Debian's slurm-wlm brought no slurmctld, slurmd and sbatch"
fi
((EUID == 0)) || skip "only root can start a Slurm node"
grep -q ' /sys/fs/cgroup' /proc/mounts || skip "slurmd needs /sys/fs/cgroup, which is not mounted here"

# The test may itself run within a job of another Slurm.
for name in $(compgen -e | grep -E '^(SLURM|SBATCH|SRUN|SCANCEL|SQUEUE|OMPI)_' || true); do
  unset "$name"
done

home=$(mktemp -d)
daemons=()

finish() {
  local code=$?
  trap - EXIT
  if ((code != 0)); then
    tail -n 20 "$home"/*.log "$home"/work/*.log 2> /dev/null || true
  fi
  # Jobs first: their helpers would wait for the daemons for ever. SLURM_CONF tells of our node only.
  timeout 10 scancel --user root 2> /dev/null || true
  await 30 queue_is_empty > /dev/null || true
  for daemon in "${daemons[@]}"; do
    kill "$daemon" 2> /dev/null || true
    await 10 has_ended "$daemon" > /dev/null || kill -KILL "$daemon" 2> /dev/null || true
  done
  rm -rf "$home"
  exit "$code"
}
export SLURM_CONF=$home/slurm.conf
trap finish EXIT
trap 'exit 1' INT TERM

fail_waiting() {
  echo "waited in vain: $*"
  return 1
}

# await SECONDS COMMAND...: until the command succeeds.
await() {
  local until=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < until)) || fail_waiting "$@" || return 1
    sleep 0.2
  done
}

has_ended() { ! kill -0 "$1" 2> /dev/null; }
queue_is_empty() { [[ -z $(timeout 10 squeue -h 2> /dev/null) ]]; }

# --- one node ---------------------------------------------------------------------------------

start_slurm() {
  local host port
  host=$(hostname -s)
  port=$((10000 + 2 * $$ % 20000))  # others may test at the same time
  mkdir "$home/state" "$home/spool"
  cat > "$SLURM_CONF" << CONF
ClusterName=lilytank
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
StateSaveLocation=$home/state
SlurmdSpoolDir=$home/spool
SlurmctldPidFile=$home/slurmctld.pid
SlurmdPidFile=$home/slurmd.pid
SlurmctldLogFile=$home/slurmctld.log
SlurmdLogFile=$home/slurmd.log
MailProg=/bin/true
ReturnToService=2
KillWait=5
NodeName=tank NodeHostname=$host NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=all Nodes=tank Default=YES MaxTime=INFINITE State=UP
CONF
  slurmctld -D > "$home/slurmctld.out" 2>&1 &
  daemons+=($!)
  slurmd -D -N tank > "$home/slurmd.out" 2>&1 &
  daemons+=($!)
  await 30 node_is_idle
}
node_is_idle() { [[ $(sinfo -h -o %T 2> /dev/null) == idle ]]; }

rows() { cat work/out/"$1"/rows-*.csv 2> /dev/null | grep -vc '^study,' || true; }
has_rows() { (($(rows "$1") >= $2)); }
# Whether task $3 of array $2 of a study has set to work.
at_work() { grep -q 'to do' "work/$1-$2_$3.log" 2> /dev/null; }
# The number that Slurm gave to task $2 of array $1.
job_of() { squeue -h -j "${1}_$2" -o %A; }
state_of() { scontrol show job "$1" | grep -oE 'JobState=[A-Z]+'; }

# --- the study ---------------------------------------------------------------------------------

cd "$home"
mkdir work
cat > work/pair.rules << 'RULES'
lilytank ruleset 1
name pair
hops counter-clockwise
target
  ##
end
join: (0,0) (0,0) -> (1,1)-(2,1)  p=1
part: (1,1)-(2,1) -> (0,0) (0,0)  p=0.02
RULES
cat > work/pair.toml << 'SCENARIO'
[run]
duration = "25 min"
[module]
count = 12
[ruleset]
file = "pair.rules"
SCENARIO
for n in 2 5; do
  cat > work/shards$n.toml << 'STUDY'
[study]
scenario = "pair.toml"
replicates = 20
[[axis]]
path = "rules.part.p"
values = [0.02, 0.5]
STUDY
done

echo "starting a node"
start_slurm
cd work

echo "without Slurm"
"$program" study shards2.toml --out whole --quiet > /dev/null
cd ..

submit() {  # STUDY SHARDS: the array's number
  (cd work && "$program" study slurm "$1.toml" --shards "$2" --cpus 1 --time 00:10:00 > "$1.sbatch" &&
    sbatch --parsable "$1.sbatch")
}

compare() {
  cmp work/out/"$1"/table.csv work/whole/table.csv
  [[ $(rows "$1") == 40 ]] || echo "(some runs were done twice: $(rows "$1") rows)"
  echo "$1: the same table"
}

echo "two shards: cancelled, then one killed half-way, then submitted again"
array=$(submit shards2 2)
await 60 has_rows shards2 2
scancel "$array"
await 60 queue_is_empty  # a cancelled task does not take itself up again
array=$(submit shards2 2)
await 60 at_work shards2 "$array" 0
await 60 has_rows shards2 6
victim=$(job_of "$array" 0)
scancel --signal=KILL "$victim.0" || fail "task 0 was too quick to be killed"
await 120 queue_is_empty
[[ $(state_of "$victim") == JobState=FAILED ]] || fail "killed, but $(state_of "$victim")"
if "$program" study merge work/out/shards2; then fail "complete in spite of the kill?"; fi
submit shards2 2 > /dev/null
await 120 queue_is_empty
"$program" study merge work/out/shards2
compare shards2

echo "five shards: one stopped by TERM, as before a time limit, one requeued by the scheduler"
array=$(submit shards5 5)
# The merging waits for the array, as the script's head says.
merging=$(grep -oE 'sbatch --dependency=.*' work/shards5.sbatch)
(cd work && job=$array && eval "$merging" > /dev/null)
await 60 at_work shards5 "$array" 0
stopped=$(job_of "$array" 0)
scancel --signal=TERM "$stopped.0" || fail "task 0 was too quick to be stopped"
await 60 at_work shards5 "$array" 1
scontrol requeue "$(job_of "$array" 1)" || fail "task 1 was too quick to be requeued"
await 150 queue_is_empty
scontrol show job "$stopped" | grep -q 'Restarts=1' || fail "task 0 was not taken up again"
[[ -e work/out/shards5/summary.txt ]] || fail "the merging job has not reported"
compare shards5
