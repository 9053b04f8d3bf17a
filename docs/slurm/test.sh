#!/bin/bash
# Pictures by a Slurm job array on this one machine, with daemons of its own (slurm-wlm of Debian; as root): tasks are
# killed, parts doubled; what is lost is found and redone, and every picture must be the single machine's to the byte.
#   docs/slurm/test.sh [CREX] [FOLDER]      default: target/release/crex, a folder that is removed
# Exit code 0: all held; 77: skipped, Slurm is not installed; else: something did not hold.
set -eu
for daemon in slurmctld slurmd munged; do
    PATH=$PATH:/usr/sbin command -v $daemon >/dev/null || {
        echo "SKIPPED, nothing was tested: no $daemon; on Debian: apt-get install slurm-wlm munge" >&2
        exit 77
    }
done
[ "$(id -u)" = 0 ] || { echo "SKIPPED, nothing was tested: Slurm's daemons want root" >&2; exit 77; }
PATH=$PATH:/usr/sbin
here=$(dirname "$(readlink -f "$0")")
root=$here/../..
crex=$(readlink -f "${1:-$root/target/release/crex}")
[ -x "$crex" ] || { echo "$crex: no such program: cargo build --release -p renderer" >&2; exit 1; }
if [ $# -ge 2 ]; then work=$(readlink -f "$2"); mkdir -p "$work"; else work=$(mktemp -d); fi
pids=()
finish() {
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
    wait 2>/dev/null || true
    [ -n "$keep" ] || rm -rf "$work"
}
keep=${2:-}
trap finish EXIT
failed() { echo "FAILED: $*" >&2; tail -n 5 "$work"/*.log >&2; exit 1; }
step() { echo "== $*"; }

step "a cluster of one node: $(slurmctld -V)"
mkdir -p "$work/bin" "$work/state" "$work/spool"
ln -sf "$crex" "$work/bin/crex"
export PATH=$work/bin:$PATH SLURM_CONF=$work/slurm.conf
chmod 755 "$work"
dd if=/dev/urandom of="$work/munge.key" bs=64 count=1 status=none
chmod 400 "$work/munge.key"
cat >"$SLURM_CONF" <<CONF
ClusterName=here
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmUser=root
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CryptoType=crypto/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
KillWait=2
MpiDefault=none
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$(hostname -s) Default=YES MaxTime=INFINITE State=UP
CONF
munged --foreground --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munge.pid" \
    --log-file="$work/munged.log" --seed-file="$work/munge.seed" 2>>"$work/munged.log" &
pids+=($!)
for _ in $(seq 100); do [ -S "$work/munge.socket" ] && break; sleep .1; done
slurmctld -D -i >"$work/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D >"$work/slurmd.log" 2>&1 &
pids+=($!)
for _ in $(seq 300); do [ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && break; sleep .2; done
[ "$(sinfo -h -o %t)" = idle ] || failed "the node did not come up: $(sinfo -h)"
sinfo

# The corridor, small; cheap enough for a test, long enough to be killed in the middle.
study=$(readlink -f "$root/stimuli/corridor")
cd "$work"
scene=("$study"/{materials,shell,layout_a}.rad -vf "$study/corridor.vf" -x 320 -y 256 -lr -12 -lw .2 -av .3213 .2833 .2225
    --crex '(TRSGM{D})*' --importance "$study/maps/a.png" --spp "${SPP:-16}" --seed 1)
step "the picture by one machine"
crex render "${scene[@]}" -o whole.exr --stats whole.json

step "the same as an array of 4 tasks, one of which is killed"
job=$(sbatch --parsable --output=task-%a.log --array=1-4 "$here/part.sh" 4 array.exr "${scene[@]}")
for _ in $(seq 3000); do
    [ "$(squeue -h -j "${job}_3" -o %T 2>/dev/null)" = RUNNING ] && break
    sleep .1
done
sleep .5
scancel --signal=KILL "${job}_3"
while [ -n "$(squeue -h -j "$job" 2>/dev/null)" ]; do sleep .2; done
scontrol -o show job "$job" | grep -o 'ArrayTaskId=[0-9]* \|JobState=[A-Z]*' | paste - - || true
[ ! -e array.exr.3-of-4.part ] || failed "task 3 was killed, yet its part is there (it was too quick: give a higher SPP)"
if crex merge --json array.exr.*-of-4.part -o array.exr >report.json; then failed "a missing part was not found"; fi
grep -q '"missing":\[3\],"array":"3"' report.json || failed "$(cat report.json)"
[ ! -e array.exr ] || failed "a picture without all its parts"

step "the lost part is rendered again"
sbatch --quiet --wait --output=task-%a.log --array="$(sed 's/.*"array":"\([^"]*\)".*/\1/' report.json)" "$here/part.sh" 4 array.exr "${scene[@]}"
crex merge array.exr.*-of-4.part -o array.exr --stats array.json
cmp whole.exr array.exr || failed "the array's picture differs from the single machine's"
sha256sum whole.exr array.exr

step "a part that is there twice"
rm array.exr
cp array.exr.2-of-4.part array.exr.2b-of-4.part
if crex merge --json array.exr.*-of-4.part -o array.exr >report.json; then failed "a doubled part was not found"; fi
grep -q '"double":\[2\]' report.json || failed "$(cat report.json)"
rm array.exr.2-of-4.part array.exr.2b-of-4.part
"$here/render.sh" 4 array.exr "${scene[@]}"
cmp whole.exr array.exr || failed "the array's picture differs from the single machine's"

step "a study: the corridor at 160 x 128, on one machine and as an array of 3, of whose parts one is lost"
for copy in alone together; do
    cp -r "$study" $copy
    rm -rf $copy/pictures $copy/manifest.json $copy/maps
    sed -i -e 's/width_px = 1280/width_px = 160/' -e 's/height_px = 1024/height_px = 128/' -e 's/^spp = .*/spp = 1/' $copy/study.toml
done
crex stimuli alone 2>>study.log
crex stimuli together --maps 2>>study.log
sbatch --quiet --wait --output=task-%a.log --array=1-3 "$here/study.sh" 3 together
lost=$(find together/pictures -name 'a_hq*.2-of-3.part')
rm "$lost"
if crex stimuli together --merge 2>merge.log; then failed "a missing part of a study was not found"; fi
grep -q 'part 2 of 3 is missing' merge.log || failed "$(cat merge.log)"
sbatch --quiet --wait --output=task-%a.log --array=2 "$here/study.sh" 3 together
crex stimuli together --merge 2>>study.log
for picture in alone/pictures/*; do cmp "$picture" "together/pictures/${picture##*/}" || failed "$picture differs"; done
crex stimuli together --check || failed "the study is not what would be made"
[ "$(ls together/pictures | wc -l)" = "$(ls alone/pictures | wc -l)" ] || failed "part files are left"
echo "PASSED: every picture is the single machine's to the byte"
