#!/usr/bin/env python3
"""Run a campaign of `obverse trials` on Ray: its shards as tasks, on as many machines as there are.

    tools/ray_trials.py --out FILE --shards N [--obverse BINARY] [--folder DIR] -- PROGRAM [ARGUMENTS]

PROGRAM and ARGUMENTS go to every shard as they are; what this script adds are --shard, --out,
--resume and --jobs 1. The address of a cluster is Ray's to find (RAY_ADDRESS); without one, Ray is
started on this machine.

The contract:

- A task is one shard: `obverse trials PROGRAM ARGUMENTS --jobs 1 --shard I/N --out DIR/I --resume`.
  Ray counts it as one core. Make shards of some seconds and more: a task costs milliseconds.
- BINARY, DIR and all files that ARGUMENTS name must be there under the same names on every machine,
  in a file system that they share. The results of a shard depend on its seeds alone, so machines of
  different speed and number do not change them; binaries of another version are refused.
- DIR holds a file for each shard that is done, and nothing that is half done under such a name. A
  task whose machine is lost is started again, three times, and goes on where its checkpoint
  (DIR/I.part) ends. Run this script again with the same arguments and DIR, and shards that are done
  are not computed again; files of another campaign are refused, not overwritten.
- When all are there, `obverse trials --merge` puts them together into FILE, whose bytes are those of
  one run without shards, and prints its table. FILE is not overwritten.
- Exit codes: 0 done, 1 a shard failed (what it said is printed; the others are kept), 2 the
  arguments are wrong.
"""

import argparse
import os
import subprocess
import sys


def arguments():
    parser = argparse.ArgumentParser(
        description="Run a campaign of `obverse trials` on Ray.", epilog="The script begins with its contract."
    )
    parser.add_argument("--out", required=True, help="the file of the whole campaign")
    parser.add_argument("--shards", required=True, type=int, help="in how many tasks")
    parser.add_argument("--obverse", default="obverse", help="the binary")
    parser.add_argument("--folder", help="where the shards are kept; FILE.shards if it is not said")
    parser.add_argument("rest", nargs="+", metavar="PROGRAM ARGUMENTS", help="after --")
    chosen = parser.parse_args()
    if not 1 <= chosen.shards <= 100_000:
        parser.error(f"--shards is {chosen.shards}, and must be from 1 to 100000")
    if os.path.exists(chosen.out):
        parser.error(f"{chosen.out} is there already, and is not overwritten")
    ours = {"--shard", "--out", "--resume", "--jobs", "--merge", "--json", "--plots"}
    taken = [word for word in chosen.rest if word.split("=")[0] in ours]
    if taken:
        parser.error(f"{taken[0]} cannot be passed on; see the contract")
    return chosen


def main():
    chosen = arguments()
    try:
        import ray
    except ImportError:
        print("Ray is not installed; `pip install ray` installs it", file=sys.stderr)
        return 2
    folder = os.path.abspath(chosen.folder or chosen.out + ".shards")
    os.makedirs(folder, exist_ok=True)
    here = os.getcwd()
    files = [os.path.join(folder, str(index)) for index in range(1, chosen.shards + 1)]

    @ray.remote(num_cpus=1, max_retries=3)
    def shard(index, out):
        command = [chosen.obverse, "trials", *chosen.rest, "--jobs", "1"]
        command += ["--shard", f"{index}/{chosen.shards}", "--out", out, "--resume"]
        done = subprocess.run(command, cwd=here, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        return index, done.returncode, done.stderr

    ray.init(log_to_driver=False, logging_level="error")
    waiting = [shard.remote(index, out) for index, out in enumerate(files, start=1)]
    failed = 0
    while waiting:
        (first,), waiting = ray.wait(waiting)
        try:
            index, code, said = ray.get(first)
        except ray.exceptions.RayError as error:
            index, code, said = "?", 1, str(error)
        if code != 0:
            failed += 1
            print(f"shard {index}: exit code {code}\n{said}", file=sys.stderr)
    ray.shutdown()
    if failed:
        print(f"{failed} of {chosen.shards} shards failed; the others are in {folder}", file=sys.stderr)
        return 1
    merge = [chosen.obverse, "trials", "--merge", *files, "--out", chosen.out]
    return 0 if subprocess.run(merge, check=False).returncode == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
