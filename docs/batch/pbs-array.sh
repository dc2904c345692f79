#!/bin/sh
# A run in parts, one a job of an array, then put together:
#   parts=$(qsub -v DECK=deck.nml pbs-array.sh)
#   echo 'cd $PBS_O_WORKDIR && resonance --merge deck.nml' | qsub -W depend=afterok:$parts
# The array begins with 1, and PARTS is its last number: PBS does not tell it to the jobs.
#PBS -N resonance
#PBS -J 1-8
#PBS -l select=1:ncpus=8
#PBS -l walltime=04:00:00
#PBS -r y
PARTS=8
cd "$PBS_O_WORKDIR" || exit 1
exec resonance --resume --shard=auto/$PARTS --threads="${NCPUS:-1}" "$DECK"
