#!/usr/bin/env python3
"""Feeds mutated system files to the program and judges how it ends.

    validation/fuzz/fuzz.py --count 1000
    validation/fuzz/fuzz.py --from 712 --count 1          # case 712 alone, again
    validation/fuzz/fuzz.py --count 100 --silence 20      # also: a line of progress within 20 s

A case is a function of --seed and its index (and of the built-in systems and the guide, which are its sources): a
system file that was good is changed in one to six places and given to one command with a small load. After --seconds
the program gets SIGTERM and must end. Cases that are not fine are kept in --keep: INDEX.toml is the file, INDEX.txt
the verdict, the command and what the program said. Exit status 1 if there is one.

Verdicts
  fine      status 0; 1 with a message that names a place; 2; 3 with a reason; 130 or SIGTERM after the signal
  crash     another signal or status, "terminate called", a report of a sanitizer
  internal  "internal error": a promise inside the program was broken
  lost      a trajectory was lost: an error of the engine
  null      status 0 and no number for x, y, vx, vy or t of a run that is completed, or in a point of a section
  deaf      it goes on for more than PATIENCE seconds after SIGTERM
  silent    with --silence: no line of progress for so long
  memory    it holds more than 2 GB, or asks for more than 4 GB
  place     status 1, and the message names neither a file, a line, a key nor an option
  output    no valid JSON with status 0 or 3, something on standard output with status 1, 3 without a reason,
            or fates of escape that do not add up to its trajectories

Busy machines: a program that waits for a processor is not deaf. The kernel counts that time (/proc/PID/schedstat), and
it is taken off. Builds with sanitizers (--sanitized) reserve addresses without end and are slow: there is no
limit of memory, and patience is ten times as long.
"""
import argparse
import collections
import json
import multiprocessing
import os
import pathlib
import pty
import re
import resource
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import mutants

PATIENCE = 2.0                 # seconds between SIGTERM and the end
MOST_MEMORY = 2 << 30          # bytes that a program may hold
MOST_ADDRESSES = 4 << 30       # bytes that it may ask for

# ---- running ----------------------------------------------------------------------------------------------------

def waited(pid):
    """Seconds that the threads of a process have waited for a processor: the longest of them, by thread."""
    times = {}
    try:
        for thread in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{thread}/schedstat") as file:
                times[thread] = int(file.read().split()[1]) * 1e-9
    except (OSError, IndexError):
        pass
    return times


class Ended:
    """How a program ended: code as of subprocess (negative: a signal), memory in bytes, and the texts."""
    code = memory = None
    out = said = ""
    stopped = deaf = silent = False
    seconds = 0.0


def run(arguments, folder, limits):
    ended = Ended()
    terminal, far_end = pty.openpty() if limits.silence else (None, None)
    with open(folder / "stdout", "w+b") as out, open(folder / "stderr", "w+b") as said:
        environment = dict(os.environ, ASAN_OPTIONS="detect_leaks=0:allocator_may_return_null=0:max_allocation_size_mb=4096",
                           UBSAN_OPTIONS="print_stacktrace=1")

        def restrict():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
            if not limits.sanitized:
                resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))

        begin = time.monotonic()
        process = subprocess.Popen(arguments, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=out,
                                   stderr=far_end if terminal else said, preexec_fn=restrict)
        if terminal:
            os.close(far_end)
        watch = select.poll()
        handle = os.pidfd_open(process.pid)
        watch.register(handle, select.POLLIN)
        if terminal:
            watch.register(terminal, select.POLLIN)
        heard, signalled, waits, written = begin, None, {}, b""
        while True:
            ready = {descriptor for descriptor, _ in watch.poll(100)}
            if terminal in ready:
                try:
                    written += os.read(terminal, 65536)
                    heard = time.monotonic()
                except OSError:  # the program closed its end
                    watch.unregister(terminal)
            if handle in ready:
                break
            now = time.monotonic()
            if terminal and signalled is None and now - heard > limits.silence:
                ended.silent = True
            patient = terminal and heard == begin and not ended.silent  # it may still say its first line
            if signalled is None and now - begin > limits.seconds and not patient:
                waits, signalled = waited(process.pid), now
                os.kill(process.pid, signal.SIGTERM)
                ended.stopped = True
            elif signalled is not None:
                queue = max([seconds - waits.get(thread, 0.0) for thread, seconds in waited(process.pid).items()], default=0.0)
                if now - signalled - queue > limits.patience:
                    ended.deaf = True
                    process.kill()
                    break
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = ended.code = os.waitstatus_to_exitcode(status)
        ended.seconds, ended.memory = time.monotonic() - begin, usage.ru_maxrss * 1024
        os.close(handle)
        out.seek(0)
        said.seek(0)
        ended.out = out.read(500_000_000).decode(errors="replace")
        ended.said = (said.read(1_000_000) + written).decode(errors="replace")
    if terminal:
        os.close(terminal)
    return ended


# ---- judging ----------------------------------------------------------------------------------------------------

PLACE = re.compile(r"carom: [\w.\[\]]+: |fuzz\.toml|line \d+|command line|--[a-z]|\b[a-z_]+(\[\d+\])?\.[a-z_]+|scatterers\.csv|starts\.txt|out\.h5|out\.svg")
SANITIZER = re.compile(r"AddressSanitizer|runtime error:|UndefinedBehaviorSanitizer|LeakSanitizer")


def values_of(node, keys):
    """What JSON has under these keys, at any depth."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key in keys:
                yield value
            yield from values_of(value, keys)
    elif isinstance(node, list):
        for value in node:
            yield from values_of(value, keys)


def holds_null(node):
    if isinstance(node, list):
        return any(holds_null(value) for value in node)
    if isinstance(node, dict):
        return any(holds_null(value) for value in node.values())
    return node is None or node in ("nan", "inf", "-inf")


def judge(ended, command, limits):
    """The verdict and a word on it."""
    last = ended.said.strip().splitlines()[-1] if ended.said.strip() else ""
    if "allocation-size-too-big" in ended.said or "out of memory" in ended.said:
        return "memory", last
    if SANITIZER.search(ended.said) or "terminate called" in ended.said:
        return "crash", next((line for line in ended.said.splitlines() if SANITIZER.search(line)), last)
    if ended.deaf:
        return "deaf", f"after {ended.seconds:.1f} s"
    if ended.silent:
        return "silent", f"after {ended.seconds:.1f} s"
    if ended.memory > MOST_MEMORY and not limits.sanitized:
        return "memory", f"{ended.memory / 2**30:.1f} GB"
    if "internal error" in ended.said:
        return "internal", last
    if ended.code == -signal.SIGTERM and ended.stopped or ended.code == 2:
        return "fine", ""
    if ended.code not in (0, 1, 3, 130) or ended.code == 130 and not ended.stopped:
        return "crash", f"status {ended.code} {last}"
    if ended.code == 1:
        if ended.out:
            return "output", "something on standard output with status 1"
        return ("fine", "") if PLACE.search(ended.said) else ("place", last)
    if ended.code == 130 and not ended.out:
        return "fine", ""
    try:
        report = json.loads(ended.out)
    except ValueError as error:
        return "output", f"no JSON: {error}"
    if any(isinstance(n, int) and n > 0 for n in values_of(report, {"lost"})) or "lost" in values_of(report, {"status"}):
        return "lost", last
    if command == "escape" and "trajectories" in report:
        fates = ("escaped", "survived", "singular", "unresolved", "lost")
        if report.get("status") == "completed" and report["trajectories"] != sum(report[fate] for fate in fates):
            return "output", "the fates do not add up"
    if ended.code == 0:
        if command == "run" and report.get("status") == "completed" and holds_null(list(values_of(report, {"x", "y", "vx", "vy", "t"}))):
            return "null", "completed"
        if command == "section" and holds_null(report.get("points")):
            return "null", "in a point"
    energies = [n for error in values_of(report, {"energy_error"}) if isinstance(error, dict) for n in error.values() if n != 0]
    if ended.code == 3 and not ended.said.strip() and not energies:
        return "output", "status 3 without a reason"
    return "fine", ""


# ---- the whole --------------------------------------------------------------------------------------------------

def one_case(index):
    data, command, options = mutants.make_case(SETTINGS.seed, index, SYSTEMS)
    arguments = [SETTINGS.program, command, "fuzz.toml"] + options + ([] if SETTINGS.silence else ["--quiet"])
    folder = pathlib.Path(tempfile.mkdtemp(prefix="carom-fuzz-"))
    try:
        for name, text in mutants.FILES.items():
            (folder / name).write_text(text)
        (folder / "fuzz.toml").write_bytes(data)
        ended = run(arguments, folder, SETTINGS)
        verdict, why = judge(ended, command, SETTINGS)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if verdict != "fine":
        kept = pathlib.Path(SETTINGS.keep)
        (kept / f"{index}.toml").write_bytes(data)
        (kept / f"{index}.txt").write_text(
            f"verdict: {verdict} ({why})\ncommand: {' '.join(arguments).replace('fuzz.toml', f'./{index}.toml')}\n"
            f"status {ended.code} after {ended.seconds:.1f} s, {ended.memory / 2**20:.0f} MB\n"
            f"--- standard error\n{ended.said[:20000]}\n--- standard output\n{ended.out[:20000]}\n")
    return index, command, verdict, why, "stopped" if ended.stopped else str(ended.code)


def main():
    global SETTINGS, SYSTEMS
    parser = argparse.ArgumentParser(description="Mutated system files for the program.")
    parser.add_argument("--program", default=str(mutants.ROOT / "build/release/carom"))
    parser.add_argument("--count", type=int, default=1000, help="number of cases")
    parser.add_argument("--from", type=int, default=0, dest="first", help="index of the first")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="cases at a time")
    parser.add_argument("--seconds", type=float, default=1.5, help="when SIGTERM is sent")
    parser.add_argument("--silence", type=float, default=0.0, help="standard error is a terminal, and the program must not say nothing for so many seconds")
    parser.add_argument("--sanitized", action="store_true", help="a build with sanitizers")
    parser.add_argument("--keep", default="fuzz-findings", help="folder for what is not fine")
    parser.add_argument("--show", action="store_true", help="print the files and commands instead of running them")
    SETTINGS = parser.parse_args()
    SETTINGS.program = str(pathlib.Path(SETTINGS.program).resolve())
    SETTINGS.patience = PATIENCE * (10 if SETTINGS.sanitized else 1)
    SYSTEMS = mutants.whole_systems(SETTINGS.program)
    indices = range(SETTINGS.first, SETTINGS.first + SETTINGS.count)
    if SETTINGS.show:
        for index in indices:
            data, command, options = mutants.make_case(SETTINGS.seed, index, SYSTEMS)
            print(f"# case {index}: carom {command} fuzz.toml {' '.join(options)}\n{data.decode(errors='replace')}")
        return 0
    os.makedirs(SETTINGS.keep, exist_ok=True)
    verdicts, ends = collections.Counter(), collections.Counter()
    with multiprocessing.get_context("fork").Pool(SETTINGS.jobs) as pool:
        for index, command, verdict, why, end in pool.imap_unordered(one_case, indices):
            verdicts[verdict] += 1
            ends[end] += 1
            if verdict != "fine":
                print(f"{index:7} {command:9} {verdict:8} {why[:160]}", flush=True)
            if sum(ends.values()) % 500 == 0:
                print(f"# {sum(ends.values())} cases: {dict(verdicts.most_common())}", file=sys.stderr, flush=True)
    print(f"{sum(ends.values())} cases, seed {SETTINGS.seed}: " + ", ".join(f"{n} {v}" for v, n in verdicts.most_common()))
    print("ends: " + ", ".join(f"{n} with {'SIGTERM' if e == 'stopped' else 'status ' + e}" for e, n in ends.most_common()))
    return 0 if set(verdicts) <= {"fine"} else 1


if __name__ == "__main__":
    sys.exit(main())
