#!/bin/sh
# Runs `harness verify` on many seeds and says what it found: alarms, checks that were not testable, power, and the share of
# p-values below 0.01. Not part of the tests: 50 quick seeds take about an hour of one core, 8 full ones as long.
#
#   scripts/verify-seeds.sh FOLDER SEEDS [--quick]
#
# One JSON file per seed in FOLDER; a seed whose file is there already is not run again.
set -eu
folder=$1 seeds=$2
shift 2
cargo build --release
mkdir -p "$folder"
for seed in $(seq 1 "$seeds"); do
    file=$folder/$seed.json
    [ -e "$file" ] && continue
    code=0
    target/release/harness verify --json --seed "$seed" "$@" > "$file.partial" || code=$?
    # 1: an alarm, which the summary tells.
    [ "$code" -le 1 ] || exit "$code"
    mv "$file.partial" "$file"
done
cargo run --quiet -p fairflight-tests --example verify_seeds -- "$folder"/*.json
