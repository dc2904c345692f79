#!/bin/sh
# Ranks of MPI, two a node with half of its cores each: sbatch slurm-mpi.sh deck.nml
# The program is built with `make MPI=1` and the MPI that srun knows (srun --mpi=list).
#SBATCH --job-name=resonance
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=2
#SBATCH --cpus-per-task=16
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
srun --cpus-per-task="$SLURM_CPUS_PER_TASK" resonance --resume \
  --threads="$SLURM_CPUS_PER_TASK" "$@"
code=$?
# 75, or whatever srun makes of ranks that were stopped: the journal says what is left to do.
[ $code -ne 0 ] && [ $code -ne 3 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 20 ] &&
  exec scontrol requeue "$SLURM_JOB_ID"
exit $code
