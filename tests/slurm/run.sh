#!/usr/bin/env bash
# Runs a study under a real Slurm: starts one node of Debian's slurm-wlm (installed if missing) on
# the loopback device in a directory of its own, submits the scripts that `lilytank study slurm`
# prints, disturbs them, and compares the merged tables byte for byte with a run without Slurm.
# Any number of these tests may run at the same time, on a machine that is busy with other work.
#
# usage: run.sh PROGRAM        exit code 77: skipped, the last line says why
set -euo pipefail
program=$(realpath "$1")
root=$(realpath "${BASH_SOURCE[0]%/*}/../..")
source "$root/.ci/packages.sh"
PATH=$PATH:/usr/sbin:/sbin

say() { printf '%3d s  %s\n' "$SECONDS" "$*"; }

fail() {
  say "failed: $1"
  exit 1
}

skip() {
  echo "skipped: $1"
  exit 77
}

installed() { (($(command -v munged slurmctld slurmd sbatch | wc -l) == 4)); }

((EUID == 0)) || skip "only root can start a Slurm node"
if ! installed; then
  command -v apt-get > /dev/null || skip "Slurm is not installed, and this is not Debian"
  need_packages "${slurm_packages[@]}" || skip "Debian's slurm-wlm cannot be installed"
  installed || skip "Debian's slurm-wlm brought no munged, slurmctld, slurmd and sbatch"
fi

# The test may itself run within a job of another Slurm.
for name in $(compgen -e | grep -E '^(SLURM|SBATCH|SRUN|SCANCEL|SQUEUE|SINFO|SCONTROL|OMPI)_' || true); do
  unset "$name"
done

home=$(mktemp -d)
export SLURM_CONF=$home/slurm.conf  # all of Slurm's commands then talk to our node and to no other
daemons=()
up=0  # the node has been seen

# --- waiting, and how it ends -------------------------------------------------------------------

# await SECONDS COMMAND...: until the command succeeds. The bounds are for a machine that is busy
# with much else; none is reached in a run that goes well.
await() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < end)) || {
      say "waited in vain for: $*"
      return 1
    }
    sleep 0.1
  done
}

# What Slurm thinks, and what all parts have said.
diagnose() {
  local ask
  for ask in 'sinfo -N -l' 'sinfo -R' 'squeue -a' 'scontrol show job' 'scontrol show node'; do
    echo "--- $ask"
    timeout 20 $ask 2>&1 || true
  done
  find "$home" \( -name '*.log' -o -name '*.out' \) -type f -size +0 |
    sort | while read -r file; do
      [[ $file != *.out || ! -s ${file%.out}.log ]] || continue  # the same again
      echo "--- ${file#"$home"/}"
      tail -n 40 "$file"
    done
}

finish() {
  local code=$?
  trap - EXIT
  trap '' INT TERM
  set +e
  ((code == 0 || code == 77)) || diagnose
  # Jobs first: their helpers would wait for the daemons for ever.
  ((up)) && timeout 30 scancel --user root 2> /dev/null && await 60 queue_is_empty
  local i daemon
  for ((i = ${#daemons[@]} - 1; i >= 0; --i)); do
    daemon=${daemons[i]}
    kill "$daemon" 2> /dev/null
    await 20 has_ended "$daemon" || kill -KILL "$daemon"
  done
  rm -rf "$home"
  exit "$code"
}
trap finish EXIT
trap 'exit 130' INT TERM HUP

has_ended() { ! kill -0 "$1" 2> /dev/null; }
queue_is_empty() {
  local queue
  queue=$(timeout 30 squeue -h 2> /dev/null) && [[ -z $queue ]]
}

# --- one node -----------------------------------------------------------------------------------

taken() { (: < "/dev/tcp/127.0.0.1/$1") 2> /dev/null; }

# Two ports in a row that nobody listens on, below those that the kernel hands out. Tests that run at
# the same time have other process numbers and so begin elsewhere.
free_ports() {
  local pair
  for ((pair = $$; pair < $$ + 10000; ++pair)); do
    port=$((10000 + 2 * (pair % 10000)))
    taken "$port" || taken $((port + 1)) || return 0
  done
  fail "no free ports"
}

# How long Slurm waits for what: a busy machine must not look like a broken one, or Slurm drains the
# node and holds its jobs. A requeued job starts only after cred_expire and 1 s.
write_configuration() {
  local host
  host=$(hostname -s)
  # No control groups are used; another plugin would insist on finding them.
  echo 'CgroupPlugin=cgroup/v1' > "$home/cgroup.conf"
  cat > "$SLURM_CONF" << CONF
ClusterName=lilytank
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$home/munge/socket,cred_expire=8
CredType=cred/munge
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
BatchStartTimeout=120
MessageTimeout=60
TCPTimeout=30
SlurmdTimeout=600
UnkillableStepTimeout=600
NodeName=tank NodeHostname=$host NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=all Nodes=tank Default=YES MaxTime=INFINITE State=UP
CONF
}

# start NAME COMMAND...
start() {
  "${@:2}" > "$home/$1.out" 2>&1 &
  daemons+=($!)
}

# A key of our own: nobody else on the machine can talk to this node.
start_munge() {
  mkdir "$home/munge"
  (umask 077 && head -c 1024 /dev/urandom > "$home/munge/key")
  start munged munged --foreground --force --num-threads=4 --key-file="$home/munge/key" \
    --socket="$home/munge/socket" --seed-file="$home/munge/seed" --pid-file="$home/munge/pid"
  await 60 answers_or_ended test -S "$home/munge/socket"
}

start_slurm() {
  free_ports
  write_configuration
  mkdir "$home/state" "$home/spool"
  start_munge
  start slurmctld slurmctld -D
  start slurmd slurmd -D -N tank
  await 120 answers_or_ended node_is_idle
  up=1
}

node_is_idle() { [[ $(timeout 30 sinfo -h -o %T 2> /dev/null) == idle ]]; }

# answers_or_ended COMMAND...: the command succeeds, or a daemon has given up: then nothing can be
# tested here.
answers_or_ended() {
  "$@" && return 0
  local daemon
  for daemon in "${daemons[@]}"; do
    has_ended "$daemon" || continue
    tail -n 5 "$home"/*.out
    skip "one of munged, slurmctld and slurmd does not run here (its words are above)"
  done
  return 1
}

# --- what jobs do -------------------------------------------------------------------------------

rows() { cat work/out/"$1"/rows-*.csv 2> /dev/null | grep -vc '^study,' || true; }
has_rows() { (($(rows "$1") >= $2)); }
# Whether task $3 of array $2 of a study has set to work.
at_work() { grep -q 'to do' "work/$1-$2_$3.log" 2> /dev/null; }
# The number that Slurm gave to task $2 of array $1.
job_of() { squeue -h -j "${1}_$2" -o %A; }
# property JOB NAME
property() { scontrol show job "$1" | tr ' ' '\n' | sed -n "s/^$2=//p"; }

# signal_task SIGNAL JOB: to the program of a job, once. (scancel --signal repeats itself, even to
# the job's next start, and its exit code does not tell whether a signal has arrived.)
signal_task() {
  local process
  process=$(scontrol listpids "$2.0" tank | awk '$4 == 0 { print $1 }')
  [[ -n $process ]] && kill -s "$1" "$process" || fail "job $2 was too quick for SIG$1"
}

# --- the studies --------------------------------------------------------------------------------

# Many short worlds: all shards get a similar part, and each takes far longer than disturbing it.
write_studies() {
  local n
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
duration = "6 min"
[module]
count = 12
[ruleset]
file = "pair.rules"
SCENARIO
  for n in 2 5; do
    cat > work/shards$n.toml << 'STUDY'
[study]
scenario = "pair.toml"
replicates = 100
[[axis]]
path = "rules.part.p"
values = [0.02, 0.5]
STUDY
  done
}
readonly runs=200

submit() {  # STUDY SHARDS: the array's number
  (cd work && "$program" study slurm "$1.toml" --shards "$2" --cpus 1 --time 00:30:00 > "$1.sbatch" &&
    sbatch --parsable "$1.sbatch")
}

# merging_of SCRIPT ARRAY: submits what the script's head says, and tells its number.
merging_of() {
  local command
  command=$(grep -oE 'sbatch --dependency=.*' "work/$1.sbatch")
  (cd work && job=$2 && eval "${command/sbatch/sbatch --parsable}")
}

compare() {
  cmp "work/out/$1/table.csv" work/whole/table.csv
  local done
  done=$(rows "$1")
  say "$1: the same table, byte for byte ($((done - runs)) of $runs runs were done twice)"
}

# A start that Slurm refuses is no success, and the merging does not wait for it for ever.
refused_start() {
  local array merging state
  (cd work && "$program" study slurm shards2.toml --shards 2 --cpus 1 > refused.sbatch)
  sed -i 's/^srun /srun --nodelist=elsewhere /' work/refused.sbatch
  array=$(cd work && sbatch --parsable refused.sbatch)
  merging=$(merging_of refused "$array")
  await 120 queue_is_empty
  for state in "$(property "${array}_0" JobState)" "$(property "${array}_1" JobState)"; do
    [[ $state == FAILED ]] || fail "refused, but $state"
  done
  state=$(property "$merging" JobState)
  [[ $state == CANCELLED ]] || fail "nothing to merge, but $state"
  say "starts that Slurm refuses have failed, and cancelled the merging"
}

two_shards() {
  local array killed state
  say "two shards, cancelled after their first runs"
  array=$(submit shards2 2)
  await 120 has_rows shards2 2
  scancel "$array"
  await 120 queue_is_empty  # a cancelled task does not take itself up again
  say "submitted again, one task killed half-way"
  array=$(submit shards2 2)
  await 120 at_work shards2 "$array" 0
  await 120 has_rows shards2 $((runs / 4))
  killed=$(job_of "$array" 0)
  signal_task KILL "$killed"
  await 240 queue_is_empty
  state=$(property "$killed" JobState)
  [[ $state == FAILED ]] || fail "killed, but $state"
  if "$program" study merge work/out/shards2; then fail "complete in spite of the kill?"; fi
  say "submitted again"
  submit shards2 2 > /dev/null
  await 240 queue_is_empty
  "$program" study merge work/out/shards2
  compare shards2
}

five_shards() {
  local array stopped requeued job
  say "five shards, one stopped by TERM as before a time limit, one requeued by the scheduler"
  array=$(submit shards5 5)
  merging_of shards5 "$array" > /dev/null
  await 120 at_work shards5 "$array" 0
  stopped=$(job_of "$array" 0)
  signal_task TERM "$stopped"
  await 120 at_work shards5 "$array" 1
  requeued=$(job_of "$array" 1)
  scontrol requeue "$requeued" || fail "task 1 was too quick to be requeued"
  await 300 queue_is_empty
  for job in "$stopped" "$requeued"; do
    [[ $(property "$job" Restarts) == 1 ]] || fail "job $job was not taken up again"
  done
  [[ -e work/out/shards5/summary.txt ]] || fail "the merging job has not reported"
  compare shards5
}

cd "$home"
mkdir work
write_studies
say "starting a node"
start_slurm
say "$(slurmctld -V), node $(sinfo -h -o '%N is %T, %c processors')"
(cd work && "$program" study shards2.toml --out whole --quiet) > /dev/null
say "the study without Slurm is done"
refused_start
two_shards
five_shards
