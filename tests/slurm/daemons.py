"""A Slurm of one's own: munged, slurmctld and one slurmd, on the loopback, in a folder, of this user."""

import contextlib
import getpass
import os
import pathlib
import secrets
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel", "sinfo")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"

# One node that claims eight processors, whatever the machine has: jobs share what there is. No
# cgroups, no task affinity, no accounting. A requeued job starts again once its credentials have
# expired, which takes two minutes by default.
CONFIGURATION = """
ClusterName=jostle-test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=6
CredType=cred/munge
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmdParameters=config_overrides
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs=8 RealMemory=8192 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class NoSlurm(Exception):
    """Slurm cannot be started here, and why."""


def free_ports(n):
    with contextlib.ExitStack() as sockets:
        found = [sockets.enter_context(socket.socket()) for _ in range(n)]
        for one in found:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in found]


class Slurm:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.daemons = []
        self.environment = {"SLURM_CONF": str(self.folder / "slurm.conf"), "PATH": PATH}

    def start(self):
        missing = [name for name in PROGRAMS if not shutil.which(name, path=PATH)]
        if missing:
            raise NoSlurm(f"there is no {', '.join(missing)}")
        for name in ("munge", "state", "spool"):
            (self.folder / name).mkdir(mode=0o700)
        self.folder.chmod(0o755)
        (self.folder / "munge/key").write_bytes(secrets.token_bytes(1024))
        (self.folder / "munge/key").chmod(0o400)
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], user=getpass.getuser(), folder=self.folder,
            ports=free_ports(2)))
        munge = self.folder / "munge"
        self.begin("munged", "--foreground", "--force", f"--key-file={munge}/key",
                   f"--socket={munge}/socket", f"--pid-file={munge}/pid",
                   f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        self.wait("munged", (munge / "socket").exists)
        self.begin("slurmctld", "-D", "-c")
        self.wait("slurmctld", lambda: self.answer("scontrol", "ping"))
        self.begin("slurmd", "-D")
        self.wait("slurmd", lambda: "idle" in self.answer("sinfo", "--noheader", "--format=%t"))

    def begin(self, name, *arguments):
        with open(self.folder / f"{name}.out", "wb") as out:
            self.daemons.append(subprocess.Popen(
                [shutil.which(name, path=PATH), *arguments], stdin=subprocess.DEVNULL, stdout=out,
                stderr=out, env={**os.environ, **self.environment}, start_new_session=True))

    def wait(self, name, ready):
        daemon = self.daemons[-1]
        for _ in range(200):
            if daemon.poll() is not None:
                raise NoSlurm(f"{name} ended with {daemon.returncode}: {self.last_words(name)}")
            if ready():
                return
            time.sleep(0.1)
        raise NoSlurm(f"{name} does not get ready: {self.last_words(name)}")

    def last_words(self, name):
        texts = [path.read_text(errors="replace") for path in
                 (self.folder / f"{name}.out", self.folder / f"{name}.log") if path.exists()]
        return " / ".join("".join(texts).strip().splitlines()[-5:])

    def answer(self, *command):
        done = subprocess.run(command, text=True, capture_output=True, timeout=60,
                              env={**os.environ, **self.environment})
        return done.stdout if done.returncode == 0 else ""

    def stop(self):
        self.answer("scancel", "--signal=KILL", "--full", f"--user={getpass.getuser()}")
        self.answer("scancel", f"--user={getpass.getuser()}")
        for daemon in reversed(self.daemons):
            if daemon.poll() is None:
                daemon.send_signal(signal.SIGTERM)
                try:
                    daemon.wait(timeout=20)
                except subprocess.TimeoutExpired:
                    daemon.kill()
                    daemon.wait()
