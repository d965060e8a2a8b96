#!/usr/bin/env python3
"""Feeds damaged system files, archives and work folders to the readers within one process, and judges them.

    cmake --build build/release --target fuzz_readers
    validation/fuzz/readers.py systems --count 100000
    validation/fuzz/readers.py archives --count 100000
    validation/fuzz/readers.py archives --from 712 --count 1 --keep found    # case 712 alone, again

readers.cpp reads thousands of files a second where fuzz.py starts the program for each. Its readers are compiled with
AddressSanitizer and UndefinedBehaviorSanitizer. Systems are those of mutants.py. Archives are one of each kind of
result, checkpoints with records, and the work folder of a sweep; bits are flipped, bytes filled, copied or cut off.
A case is a function of --seed and its index, and of what the program writes.

Verdicts
  read      it was read, and gave what was written (of a system: its resolved text reads as itself)
  refused   an InputError that names the file
  crash     a signal, a report of a sanitizer, an exception that is no InputError
  internal  a promise inside the program was broken
  changed   it was read and gave something else, or what was written was refused
  deaf      more than 10 s of the processor for three readings (60 s with sanitizers), or no answer within 15 min
  memory    more than 2 GB
  place     an InputError that does not name the file
Exit status 1 if there is anything but read and refused. Cases that are neither are printed; --keep FOLDER keeps the
texts of systems.
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import mutants

FINE = {"read", "refused"}
SILENCE = 120.0                # seconds of the processor without an answer: a busy machine is no fault
HANG = 900.0                   # seconds of a clock without an answer
ENVIRONMENT = {
    "ASAN_OPTIONS": "detect_leaks=0:malloc_context_size=1:max_allocation_size_mb=2048:hard_rss_limit_mb=4096:allocator_may_return_null=0",
    "UBSAN_OPTIONS": "print_stacktrace=1",
    "OMP_NUM_THREADS": "1",
}

# One of each kind of result. Each line leaves a.h5 or its work folder.
SLOW = "mushroom --trajectories 20000 --t-max 300 --block 50"
KILLED = (
    "$carom {} -o a.h5 --quiet --threads 1 --checkpoint blocks:5 & pid=$!; "
    "c=a.h5.part/checkpoint.h5; until [ -e $c ]; do sleep 0.02; done; first=$(stat -c %i $c); "  # the first is empty
    "while [ $(stat -c %i $c) = $first ]; do sleep 0.02; done; kill -9 $pid; wait $pid; true"
)
SOURCES = {
    "run": "$carom run stadium --closed --t-max 60 --set run.sample=0.5 -o a.h5 --quiet",
    "run-forces": "$carom run soft-lorentz --t-max 20 --set run.sample=1 -o a.h5 --quiet",
    "section": "$carom section stadium --closed --orbits 3 --points 300 -o a.h5 --quiet",
    "certified": "$carom run stadium --precision certified --collisions 40 -o a.h5 --quiet",
    "escape": "$carom escape stadium --trajectories 2000 --t-max 20 --per-trajectory -o a.h5 --quiet",
    "diffusion": "$carom diffusion lorentz-triangular --trajectories 50 --t-max 5 -o a.h5 --quiet",
    "lyapunov": "$carom lyapunov mushroom --closed --trajectories 50 --t-max 100 --per-trajectory -o a.h5 --quiet",
    "returns": "$carom returns stadium --closed --on wall:bottom --trajectories 50 --t-max 100 -o a.h5 --quiet",
    "orbit": "$carom orbit three-disc --hits 4 -o a.h5 --quiet",
    "relax": "$carom relax wigner --starts 5 --set particles.count=5 -o a.h5 --quiet",
    "compare": "$carom compare henon-heiles --steps 0.1,0.05,0.025 --t-max 10 -o a.h5 --quiet",
    "sweep": "$carom escape magnetic-square --trajectories 200 --t-max 20 --sweep field.B=list:0,1,2 -o a.h5 --quiet",
    "escape-checkpoint": KILLED.format(f"escape {SLOW} --per-trajectory"),
    "diffusion-checkpoint": KILLED.format("diffusion lorentz-triangular --trajectories 20000 --t-max 100 --block 50"),
    "sweep-folder":
        "$carom escape magnetic-square --trajectories 20000 --t-max 300 --sweep field.B=list:0.1,0.2,0.3,0.4,0.5,0.6 "
        "--threads 1 -o a.h5 --quiet & pid=$!; "
        "until [ -e a.h5.part/value-1 ]; do sleep 0.02; done; kill -9 $pid; wait $pid; true",
}


def make_sources(program, folder):
    for name, line in SOURCES.items():
        place = folder / name
        place.mkdir(parents=True)
        subprocess.run(["bash", "-c", line], cwd=place, env=dict(os.environ, carom=program, OMP_NUM_THREADS="1"), check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if not any(place.iterdir()):
            sys.exit(f"readers.py: nothing was made by {line}")


class Driver:
    """One process that answers case by case, and is started anew where it ends."""

    def __init__(self, arguments, feed):
        self.said = tempfile.TemporaryFile()
        self.process = subprocess.Popen(arguments, stdin=subprocess.PIPE if feed else subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=self.said, env=dict(os.environ, **ENVIRONMENT))
        self.answers = queue.Queue()
        threading.Thread(target=self.listen, daemon=True).start()
        if feed:
            threading.Thread(target=self.tell, args=(feed,), daemon=True).start()

    def listen(self):
        for line in self.process.stdout:
            self.answers.put(line.decode(errors="replace").rstrip("\n"))
        self.answers.put(None)

    def tell(self, feed):
        try:
            for index, data in feed:
                self.process.stdin.write(b"%d %d\n" % (index, len(data)) + data)
            self.process.stdin.close()
        except OSError:  # it has ended
            pass

    def answer(self):
        """The next line, None where the process has ended. Raises queue.Empty where it is deaf."""
        begin, used = time.monotonic(), self.processor_seconds()
        while True:
            try:
                return self.answers.get(timeout=1.0)
            except queue.Empty:
                if time.monotonic() - begin > HANG or self.processor_seconds() - used > SILENCE:
                    raise

    def processor_seconds(self):
        try:
            fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        except OSError:  # it has ended
            return 0.0
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def why(self):
        self.said.seek(0)
        lines = self.said.read(1_000_000).decode(errors="replace").splitlines()
        return next((line for line in lines if "ERROR" in line or "runtime error" in line), lines[-1] if lines else "")


def cases(settings, first, count, folder, systems):
    """(index, verdict, word) of each case from `first` on."""
    at, end = first, first + count
    while at < end:
        if settings.what == "systems":
            feed = ((i, mutants.make_case(settings.seed, i, systems)[0]) for i in range(at, end))
            driver = Driver([settings.driver, "systems"], feed)
        else:  # one that crashed left a damaged file
            shutil.rmtree(folder)
            shutil.copytree(settings.sources, folder)
            driver = Driver([settings.driver, "archives", folder, str(settings.seed), str(at), str(end - at)], None)
        while at < end:
            try:
                line = driver.answer()
            except queue.Empty:
                driver.process.kill()
                yield at, "deaf", "no answer"
                at += 1
                break
            if line is None:
                yield at, "crash", f"status {driver.process.wait()}: {driver.why()}"
                at += 1
                break
            index, verdict, *word = line.split(" ", 2)
            assert int(index) == at, (index, at)
            yield at, verdict, word[0] if word else ""
            at += 1
            if verdict == "memory":  # the peak of the next ones would not be seen
                driver.process.kill()
                break
        driver.process.wait()


def judge(settings, first, count, systems):
    verdicts = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="carom-readers-", dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        for index, verdict, word in cases(settings, first, count, folder, systems):
            verdicts[verdict] += 1
            if verdict in FINE:
                continue
            print(f"{index:7} {verdict:8} {word[:200]}", flush=True)
            if settings.keep and settings.what == "systems":
                (settings.keep / f"{index}.toml").write_bytes(mutants.make_case(settings.seed, index, systems)[0])
    return verdicts


def main():
    parser = argparse.ArgumentParser(description="Damaged files for the readers, within one process.")
    parser.add_argument("what", choices=("systems", "archives"))
    parser.add_argument("--driver", default=str(mutants.ROOT / "build/release/validation/fuzz/fuzz_readers"))
    parser.add_argument("--program", default=str(mutants.ROOT / "build/release/carom"))
    parser.add_argument("--count", type=int, default=2000, help="number of cases")
    parser.add_argument("--from", type=int, default=0, dest="first", help="index of the first")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for systems that are not fine")
    settings = parser.parse_args()
    settings.program = str(pathlib.Path(settings.program).resolve())
    if settings.keep:
        settings.keep.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    systems = None
    if settings.what == "systems":  # the guide's hundred thousand discs, in a mutant of forty, would take nearly all of the time
        systems = [re.sub(r"(count *= *)100000\b", r"\g<1>1000", text) for text in mutants.whole_systems(settings.program)]
    total = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="carom-readers-") as folder:
        settings.sources = pathlib.Path(folder)
        if settings.what == "archives":
            make_sources(settings.program, settings.sources)
        share = -(-settings.count // settings.jobs)
        with concurrent.futures.ThreadPoolExecutor(settings.jobs) as pool:
            parts = [pool.submit(judge, settings, settings.first + k * share, min(share, settings.count - k * share), systems)
                     for k in range(settings.jobs) if settings.count > k * share]
            for part in parts:
                total += part.result()
    print(f"{sum(total.values())} {settings.what}, seed {settings.seed}, {time.monotonic() - begin:.0f} s: "
          + ", ".join(f"{n} {v}" for v, n in total.most_common()))
    return 0 if set(total) <= FINE else 1


if __name__ == "__main__":
    sys.exit(main())
