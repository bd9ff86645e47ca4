#!/bin/sh
# A campaign on a local Ray gives the bytes of one run; a worker that is killed is started again; and
# what is done is not done twice. Apart from the main tests: it needs `pip install ray`.
# Usage: tests/ray/run.sh [BINARY]; exit code 0 passed or skipped, 1 failed.
set -eu
project=$(cd "$(dirname "$0")/../.." && pwd)
obverse=${1:-$project/target/debug/obverse}
if ! python3 -c 'import ray' 2>/dev/null; then
    echo "skipped: Ray is not installed"
    exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
campaign="$project/programs/reversal_policy.obv --runs 400 --strategy stop,explicit --seed 3"

on_ray() {
    # The words of the campaign are words.
    # shellcheck disable=SC2086
    python3 "$project/tools/ray_trials.py" --out "$1" --shards 8 --obverse "$2" -- $campaign
}

# shellcheck disable=SC2086
"$obverse" trials $campaign --out "$folder/whole" >"$folder/whole.txt"
on_ray "$folder/on_ray" "$obverse" >"$folder/on_ray.txt"
cmp "$folder/whole" "$folder/on_ray"
cmp "$folder/whole.txt" "$folder/on_ray.txt"
echo "passed: the bytes are those of one run"

# A binary whose third shard takes its worker with it, the first time.
cat >"$folder/fragile" <<END
#!/bin/sh
case "\$*" in
*"--shard 3/8"*) if mkdir "$folder/killed" 2>/dev/null; then kill -9 "\$PPID"; fi ;;
esac
exec "$obverse" "\$@"
END
chmod +x "$folder/fragile"
on_ray "$folder/fragile_run" "$folder/fragile" >/dev/null
test -d "$folder/killed"
cmp "$folder/whole" "$folder/fragile_run"
echo "passed: a killed worker is started again"

# All shards are there: a binary that only merges is enough to have the whole again.
cat >"$folder/witness" <<END
#!/bin/sh
case "\$*" in
*"--shard"*) echo "\$*" >>"$folder/asked" ;;
esac
exec "$obverse" "\$@"
END
chmod +x "$folder/witness"
before=$(cd "$folder/fragile_run.shards" && ls -l --time-style=full-iso)
rm "$folder/fragile_run"
on_ray "$folder/fragile_run" "$folder/witness" >/dev/null
test "$(wc -l <"$folder/asked")" -eq 8
test "$before" = "$(cd "$folder/fragile_run.shards" && ls -l --time-style=full-iso)"
cmp "$folder/whole" "$folder/fragile_run"
echo "passed: what is done is not done twice"

# A shard of another campaign is refused, and kept.
campaign="$project/programs/reversal_policy.obv --runs 400 --strategy stop,explicit --seed 4"
rm "$folder/fragile_run"
if on_ray "$folder/fragile_run" "$obverse" >/dev/null 2>"$folder/said"; then
    echo "failed: shards of another campaign were taken"
    exit 1
fi
grep -q "another campaign: its seed is 3, and not 4" "$folder/said"
test "$before" = "$(cd "$folder/fragile_run.shards" && ls -l --time-style=full-iso)"
echo "passed: shards of another campaign are refused"
