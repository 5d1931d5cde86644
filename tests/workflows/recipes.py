#!/usr/bin/env python3
"""Runs a sweep by a recipe of scripts/workflows, and compares its runs with single ones, bit for bit.

    recipes.py snakemake|slurm|slurm_by_hand|parallel COMMAND SOURCE

The exit code is 77 if the recipe's program is not installed.
"""

import csv
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SKIPPED = 77
# What does not depend on the jet: times of the clock, and where the file came from.
# References of dimension scales are addresses; their names are compared.
NOT_COMPARED = {"wall_time", "scene_file", "message", "resumed_at", "current", "DIMENSION_LIST", "REFERENCE_LIST"}


def need(*programs):
    missing = [p for p in programs if not shutil.which(p)]
    try:
        import h5py  # noqa: F401
    except ImportError:
        missing.append("python3-h5py")
    if missing:
        print(f"skipped: {', '.join(missing)} is not installed (scripts/install-packages --tests)")
        sys.exit(SKIPPED)


def check(truth, what):
    if not truth:
        sys.exit(f"FAILED: {what}")


def call(*arguments, **options):
    print("+", *arguments, flush=True)
    subprocess.run([str(a) for a in arguments], check=True, **options)


def wait_until(condition, what, seconds=120):
    end = time.monotonic() + seconds
    while not condition():
        check(time.monotonic() < end, f"waited {seconds} s for {what}")
        time.sleep(0.02)


class Sweep:
    """A sweep in a folder of its own, and the same runs one by one."""

    def __init__(self, work, command, source, voltages, viscosities, end_time):
        self.work, self.command = work, command
        self.recipes = source / "scripts" / "workflows"
        self.folder = work / "sweep"
        plan = work / "plan.toml"
        plan.write_text(
            f"""scene = "{source}/scenes/quickstart.toml"
[set]
run.end_time = {end_time}
output.observables = 1e-5
output.frames = 2e-4
output.checkpoints = 5e-5
output.flush = 0.01
[grid]
field.potential = {voltages}
viscoelasticity.viscosity = {viscosities}
"""
        )
        call(command, "sweep", plan, "-o", self.folder)
        with open(self.folder / "index.csv", newline="") as index:
            self.runs = list(csv.DictReader(index))
        check(len(self.runs) == len(voltages) * len(viscosities), "number of runs")

    def single(self, run):
        file = self.work / ("single-" + run["run"])
        call(self.command, "run", self.folder / run["scene"], "-o", file, "--threads", 1, "--quiet")
        return file

    def expect_equal_to_single_runs(self):
        import h5py

        for run in self.runs:
            with h5py.File(self.folder / run["run"]) as a, h5py.File(self.single(run)) as b:
                check(a.attrs["status"] == "complete", f"{run['run']} is {a.attrs['status']}")
                check(len(a["observables/time"]) > 10, "rows of observables")
                expect_equal(a, b, run["id"])

    def expect_table(self, file):
        """The table agrees with the run files, read without ehdjet."""
        import h5py

        with open(file, newline="") as text:
            rows = list(csv.DictReader(text))
        check(len(rows) == len(self.runs), "a row per run")
        for row, run in zip(rows, self.runs):
            check(row["status"] == "complete", f"{row['run']}: {row['status']}")
            check(Path(row["run"]).name == run["run"], "order of the rows")
            for key in ("field.potential_v", "viscoelasticity.viscosity_pa_s"):
                check(float(row[key]) == float(run[key]), f"{key} of {run['id']}")
            with h5py.File(self.folder / run["run"]) as data:
                at = data["observables/time"][:]
                late = data["observables/path_length"][:][at >= at[-1] / 2]
            check(abs(float(row["path_length_m"]) / late.mean() - 1) < 1e-13, "mean path length")
        check(len({row["path_length_m"] for row in rows}) == len(rows), "runs that differ")


def expect_equal(a, b, where):
    """Groups, data sets and attributes have the same names and bits."""
    names = set(a.attrs) - NOT_COMPARED
    check(names == set(b.attrs) - NOT_COMPARED, f"{where}: attributes {names} {set(b.attrs)}")
    for name in names:
        x, y = a.attrs[name], b.attrs[name]
        check(x == y, f"{where}@{name}: {x} != {y}")
    if where.endswith("/checkpoint"):
        expect_equal_checkpoints(a, b, where)
    elif hasattr(a, "keys"):
        check(a.keys() == b.keys(), f"{where}: {set(a.keys()) ^ set(b.keys())}")
        for name in a:
            expect_equal(a[name], b[name], f"{where}/{name}")
    elif a.shape == ():
        check(a[()] == b[()], f"{where}: text")
    else:
        scales = [[scale.name for scale in data.dims[0].values()] for data in (a, b)]
        check(scales[0] == scales[1], f"{where}: dimension scales {scales}")
        check(a.dtype == b.dtype and a[:].tobytes() == b[:].tobytes(), f"{where}: numbers")


def expect_equal_checkpoints(a, b, where):
    """The last checkpoint, whichever slot it is in, apart from its times of the clock."""
    lists = []
    for group in (a, b):
        slot = group["ab"[group.attrs["current"]]]
        names, offset, numbers = group["names"][()].decode().split(), slot["offset"][:], slot["numbers"][:]
        check(len(offset) > len(names), f"{where}: offsets")
        lists.append({name: numbers[offset[k] : offset[k + 1]].tobytes()
                      for k, name in enumerate(names) if "wall_time" not in name})
    check(lists[0].keys() == lists[1].keys() and len(lists[0]) > 50, f"{where}: names")
    for name in lists[0]:
        check(lists[0][name] == lists[1][name], f"{where}: {name}")


def snakemake(sweep):
    """Kills Snakemake and all runs after the first ones, and lets it go on."""
    done = lambda: len(list(sweep.folder.glob("*.done")))
    started = lambda: len(list(sweep.folder.glob("*.h5")))
    line = ["snakemake", "-s", sweep.recipes / "Snakefile", "--cores", "2", "--config",
            f"sweep={sweep.folder}", f"ehdjet={sweep.command}"]
    line = [str(word) for word in line]
    environment = dict(os.environ, HOME=str(sweep.work), XDG_CACHE_HOME=str(sweep.work))
    options = dict(cwd=sweep.work, env=environment)

    print("+", *line, "(to be killed)", flush=True)
    first = subprocess.Popen(line, start_new_session=True, stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL, **options)
    wait_until(lambda: done() >= 3 and started() > done(), "three runs and the start of another")
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    killed_at = done()
    print(f"killed with {killed_at} runs complete, {started()} started", flush=True)
    check(killed_at < len(sweep.runs), "all runs were complete before the kill")
    kept = {f: f.stat().st_mtime_ns for f in (m.with_suffix(".h5") for m in sweep.folder.glob("*.done"))}

    call(*line, "--unlock", "--quiet", "all", **options)
    call(*line, "--rerun-incomplete", "--quiet", "all", **options)
    check(done() == len(sweep.runs), "all runs are complete")
    for file, changed in kept.items():
        check(file.stat().st_mtime_ns == changed, f"{file.name} was run again")
    sweep.expect_table(sweep.folder / "table.csv")
    again = subprocess.run(line, capture_output=True, text=True, check=True, **options)
    check("Nothing to be done" in again.stdout + again.stderr, "a third call does nothing")


def parallel(sweep):
    """The line of docs/sweeps.md."""
    line = ("parallel --will-cite --jobs 2 --colsep , --header : "
            '"$EHDJET" run sweep/{scene} -o sweep/{run} --resume --threads 1 --quiet :::: sweep/index.csv')
    environment = dict(os.environ, EHDJET=str(sweep.command), HOME=str(sweep.work))
    for _ in range(2):  # the second time nothing is left to do
        call("bash", "-c", line, cwd=sweep.work, env=environment)
    call(sweep.command, "gather", *[sweep.folder / run["run"] for run in sweep.runs], "-o",
         sweep.work / "table.csv")
    sweep.expect_table(sweep.work / "table.csv")


def slurm_by_hand(sweep):
    """The array script with the variables that SLURM sets for a task."""
    script = sweep.recipes / "slurm-array"
    environment = dict(os.environ, EHDJET=str(sweep.command), SLURM_CPUS_PER_TASK="1")
    for task in range(1, len(sweep.runs) + 1):
        call(script, sweep.folder, env=dict(environment, SLURM_ARRAY_TASK_ID=str(task)))
    for task in (0, len(sweep.runs) + 1):
        wrong = subprocess.run([script, sweep.folder], capture_output=True, text=True,
                               env=dict(environment, SLURM_ARRAY_TASK_ID=str(task)))
        check(wrong.returncode == 2 and f"there is no run {task}" in wrong.stderr, "a wrong task")


class OneNodeSlurm:
    """A SLURM of this machine alone, with all its files in one folder."""

    def __init__(self, folder):
        folder.mkdir()
        self.folder, self.daemons = folder, []
        host = socket.gethostname().split(".")[0]
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        (folder / "key").write_bytes(os.urandom(1024))
        (folder / "key").chmod(0o600)
        ports = []
        for _ in range(2):
            with socket.socket() as free:
                free.bind(("127.0.0.1", 0))
                ports.append(free.getsockname()[1])
        (folder / "slurm.conf").write_text(
            f"""ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/ctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0
MailProg=/bin/true
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES State=UP
"""
        )
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"))

    def __enter__(self):
        at = self.folder
        self.start("munged", "--foreground", "--force", f"--key-file={at}/key",
                   f"--socket={at}/munge.socket", f"--pid-file={at}/munged.pid",
                   f"--log-file={at}/munged.log", f"--seed-file={at}/seed")
        wait_until(lambda: (at / "munge.socket").exists(), "munged", 30)
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        wait_until(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "an idle node", 60)
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait()

    def start(self, *line):
        log = open(self.folder / f"{line[0]}.out", "wb")
        # Out of the tests' environment come only the paths.
        self.daemons.append(subprocess.Popen(line, stdout=log, stderr=log, env=self.environment))

    def ask(self, *line):
        return subprocess.run(line, capture_output=True, text=True, env=self.environment).stdout


def slurm(sweep):
    """The array script under a SLURM of one node. A task is cancelled, and goes on in a second array."""
    with OneNodeSlurm(sweep.work / "slurm") as cluster:
        cluster.environment["EHDJET"] = str(sweep.command)

        def submit():
            job = cluster.ask("sbatch", "--parsable", f"--array=1-{len(sweep.runs)}", "--time=10",
                              f"--output={sweep.work}/task-%a.log",
                              sweep.recipes / "slurm-array", sweep.folder).strip()
            check(job.isdigit(), "sbatch")
            return job

        job = submit()
        wait_until(lambda: any(sweep.folder.glob("*.h5")), "the first run")
        cluster.ask("scancel", "--batch", "--signal=TERM", f"{job}_1")
        gone = lambda: not cluster.ask("squeue", "-h").strip()
        wait_until(gone, "the array")
        submit()
        wait_until(gone, "the second array")
        for log in sorted(sweep.work.glob("task-*.log")):
            check(not log.read_text(), f"{log.name}: {log.read_text()}")
    call(sweep.command, "gather", *[sweep.folder / run["run"] for run in sweep.runs], "-o",
         sweep.work / "table.csv")
    sweep.expect_table(sweep.work / "table.csv")


# The recipe, the programs that it needs, and the size of its sweep.
TWELVE = ([8000, 9000, 10000], [0.5, 1, 2, 4], 1e-3)
FOUR = ([8000, 9000], [1, 2], 5e-4)
RECIPES = {
    "snakemake": (snakemake, ["snakemake"], TWELVE),
    "slurm": (slurm, ["sbatch", "slurmd", "slurmctld", "munged"], FOUR),
    "slurm_by_hand": (slurm_by_hand, ["bash"], FOUR),
    "parallel": (parallel, ["parallel"], FOUR),
}

if __name__ == "__main__":
    recipe, programs, (voltages, viscosities, end_time) = RECIPES[sys.argv[1]]
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    need(*programs)
    with tempfile.TemporaryDirectory(prefix="ehdjet_workflow.") as scratch:
        sweep = Sweep(Path(scratch), Path(sys.argv[2]), Path(sys.argv[3]), voltages, viscosities, end_time)
        recipe(sweep)
        sweep.expect_equal_to_single_runs()
    print("passed")
