"""Builds the program of a first run, then jostle, then everything in a fresh folder without a compiler cache.
Prints what that takes: wall time, processor time, processor time of other programs, and where the time of the
steps goes. Run as ./dev build-time."""

import collections
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

TICKS = os.sysconf("SC_CLK_TCK")
# Beyond this share of the processors, other programs slow a build noticeably.
MOST_OF_OTHERS = 0.05


def busy_seconds():
    """Processor time of all programs since the machine started; None if the system does not report it."""
    try:
        user, nice, system, _, _, irq, soft_irq = map(int, open("/proc/stat").readline().split()[1:8])
    except OSError:
        return None
    return (user + nice + system + irq + soft_irq) / TICKS


def children_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime, used.ru_stime


def measured(command, folder, environment):
    """Wall, user and system seconds of a command, and those of other programs meanwhile (None: unknown)."""
    wall, (user, system), busy = time.monotonic(), children_seconds(), busy_seconds()
    done = subprocess.run(command, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit(f"{done.stdout[-4000:]}\n{' '.join(map(str, command))} failed")
    more_user, more_system = children_seconds()
    user, system, busy_now = more_user - user, more_system - system, busy_seconds()
    others = None if busy is None else max(0.0, busy_now - busy - user - system)
    return time.monotonic() - wall, user, system, others


def room(output):
    """The folder of the sources that an output of the build is made from."""
    parts = pathlib.PurePath(output).parts
    if len(parts) < 2 or parts[0] == "/" or parts[0].startswith("CMakeFiles"):
        return "build files"
    return "/".join(parts[:2]) if parts[0] == "tests" and not parts[1].startswith("CMake") else parts[0]


def rooms(log):
    """Seconds of the steps of each room. A step with several outputs counts once."""
    steps = {}
    for line in log.read_text().splitlines()[1:]:
        start, end, _, output, command = line.split("\t")
        steps[start, end, command] = output, (int(end) - int(start)) / 1000
    seconds = collections.Counter()
    for output, duration in steps.values():
        seconds[room(output)] += duration
    return seconds


def main():
    source, folder = map(pathlib.Path, sys.argv[1:3])
    jobs = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    shutil.rmtree(folder, ignore_errors=True)
    environment = {key: value for key, value in os.environ.items() if not key.endswith("_COMPILER_LAUNCHER")}
    environment["CCACHE_DISABLE"] = "1"
    load = os.getloadavg()[0]
    print(f"load average before: {load:.1f} on {jobs} processors", flush=True)

    options = ["-D", "CMAKE_CXX_COMPILER_LAUNCHER=", "-D", "CMAKE_C_COMPILER_LAUNCHER="]
    measured(["cmake", "--preset", "release", "-B", folder, *options, "-D", "JOSTLE_TESTS=ON"], source,
             environment)
    print(f"{'':24}{'wall':>8}{'user':>8}{'system':>8}{'user + system':>15}{'other programs':>16}   (s)")
    total = [0.0] * 4
    idle = load < 0.5
    targets = {"program of a first run": "jostle_first_run", "rest of jostle": "jostle", "tests and all else": "all"}
    for name, target in targets.items():
        build = ["cmake", "--build", folder, "--target", target, "--parallel", str(jobs)]
        wall, user, system, others = measured(build, source, environment)
        row(name, wall, user, system, others)
        idle = idle and others is not None and others < MOST_OF_OTHERS * jobs * wall
        total = [sum(pair) for pair in zip(total, (wall, user, system, others or 0))]
    row("everything", *total)
    print("the machine was idle" if idle else
          "the machine was not idle: wall times are too long, and processor times somewhat")
    seconds = rooms(folder / ".ninja_log")
    print("\nroom, and the wall time of its steps (s)")
    for name, duration in seconds.most_common():
        print(f"{name:24}{duration:8.1f}")


def row(name, wall, user, system, others):
    told = "unknown" if others is None else f"{others:.1f}"
    print(f"{name:24}{wall:8.1f}{user:8.1f}{system:8.1f}{user + system:15.1f}{told:>16}", flush=True)


if __name__ == "__main__":
    main()
