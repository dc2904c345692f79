#!/bin/sh
# One job that goes on after its time limit: sbatch slurm-requeue.sh deck.nml
# Slurm sends TERM to the batch shell two minutes before the limit (B:); the program keeps what is
# done and leaves with 75, and the job is put back into the queue.
#SBATCH --job-name=resonance
#SBATCH --cpus-per-task=16
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@120
#SBATCH --requeue
#SBATCH --open-mode=append
resonance --resume --threads="${SLURM_CPUS_PER_TASK:-1}" "$@" &
pid=$!
trap 'kill -TERM $pid' TERM
wait $pid
code=$?
[ $code -gt 128 ] && { wait $pid; code=$?; } # the first wait ended with the signal
[ $code -eq 75 ] && exec scontrol requeue "$SLURM_JOB_ID"
exit $code
