#!/bin/sh
# Ranks of MPI, two a node with half of its cores each: sbatch slurm-mpi.sh deck.nml
# Slurm sends TERM to the ranks two minutes before the limit; they leave with 75, and the job is put
# back into the queue. The program is built with `make MPI=1` and the MPI that srun knows
# (srun --mpi=list).
#SBATCH --job-name=resonance
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=2
#SBATCH --cpus-per-task=16
#SBATCH --time=04:00:00
#SBATCH --signal=TERM@120
#SBATCH --requeue
#SBATCH --open-mode=append
srun --cpus-per-task="$SLURM_CPUS_PER_TASK" resonance --resume \
  --threads="$SLURM_CPUS_PER_TASK" "$@"
code=$?
# 75, or whatever srun makes of ranks that were stopped or lost: the journal says what is left to do.
# Done, a bad deck, done but for some points: another run would end the same.
case $code in 0 | 2 | 3) exit $code ;; esac
[ "${SLURM_RESTART_COUNT:-0}" -lt 20 ] && exec scontrol requeue "$SLURM_JOB_ID"
exit $code
