#!/bin/sh
# A run in parts, one a job of an array, then put together:
#   parts=$(sbatch --parsable slurm-array.sh deck.nml)
#   sbatch --dependency=afterok:$parts --wrap "resonance --merge deck.nml"
#SBATCH --job-name=resonance
#SBATCH --array=1-8
#SBATCH --cpus-per-task=8
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@120
#SBATCH --requeue
#SBATCH --open-mode=append
resonance --resume --shard=auto --threads="${SLURM_CPUS_PER_TASK:-1}" "$@" &
pid=$!
trap 'kill -TERM $pid' TERM
wait $pid
code=$?
[ $code -gt 128 ] && { wait $pid; code=$?; } # the first wait ended with the signal
# 75: stopped before the end, with all that was done in the journal.
[ $code -eq 75 ] && exec scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
exit $code
