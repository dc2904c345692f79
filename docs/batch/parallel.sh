#!/bin/sh
# A run in parts with GNU parallel, four at a time with two threads each, then put together:
#   sh parallel.sh deck.nml
# Started again after it was stopped, it goes on. On several machines that share this folder: add
# --sshlogin host1,host2 --workdir . to parallel's options.
PARTS=16
parallel --jobs 4 --halt now,fail=1 resonance --quiet --resume --threads=2 --shard={}/$PARTS "$@" \
  ::: $(seq $PARTS) && exec resonance --merge "$@"
