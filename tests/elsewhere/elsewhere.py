"""Builds and runs jostle on another Debian by the commands of its README, in a chroot of its own.

./dev test-elsewhere debian13 [--tests | --user | --pip] calls it, with SOURCE (the checkout) and BUILD (where the chroots
are kept). The tracked files of the checkout are copied in, `./dev run config/scenes/quickstart.json` installs
what it needs, builds, and runs, and the digest of the results must be the recorded one. With --tests,
`./dev test` follows there. With --user an ordinary user does so, with the packages installed by the command
that ./dev printed. With --pip the commands of the Containerfile are run instead: `pip install .` into a virtual
environment, without a network except for apt-get. Needs root or user namespaces, mmdebstrap, and a Debian mirror.
"""

import argparse
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time

SOURCE = pathlib.Path(os.environ["SOURCE"])
BUILD = pathlib.Path(os.environ["BUILD"])
SUITES = {"debian12": "bookworm", "debian13": "trixie", "testing": "testing", "unstable": "unstable"}
QUICKSTART = "config/scenes/quickstart.json"
USER = "grain"


def run(*command, accept=(0,), **options):
    """Runs a command; an exit code not in `accept` ends this program with the command's output."""
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **options)
    if done.returncode not in accept:
        sys.exit(f"{shlex.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-20000:]}")
    return done.stdout


class Chroot:
    """A minimal Debian of one suite. It is made once; the checkout in it is made anew each time."""

    def __init__(self, suite):
        self.root = BUILD / suite
        if not (self.root / "usr/bin/apt-get").exists():
            shutil.rmtree(self.root, ignore_errors=True)
            # A mirror's snapshot of testing or unstable outlives its signature's date.
            run("mmdebstrap", "--variant=minbase", "--include=ca-certificates",
                '--aptopt=Acquire::Check-Valid-Until "false"', suite, self.root)
        shutil.copy("/etc/resolv.conf", self.root / "etc/resolv.conf")

    def copy_sources(self):
        checkout = self.root / "root/jostle"
        shutil.rmtree(checkout, ignore_errors=True)
        checkout.mkdir(parents=True)
        checkout.parent.chmod(0o755)  # tests run the program as other users, too
        archive = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z"], check=True, stdout=subprocess.PIPE)
        files = [name for name in archive.stdout.split(b"\0") if (SOURCE / os.fsdecode(name)).is_file()]
        packed = subprocess.run(["tar", "-C", SOURCE, "--null", "--files-from=-", "-c"], check=True,
                                input=b"\0".join(files), stdout=subprocess.PIPE)
        subprocess.run(["tar", "-C", checkout, "-x"], check=True, input=packed.stdout)

    def sh(self, script, user="root", network=True, accept=(0,)):
        """Runs a script in the user's checkout, with /proc and /dev; returns what it printed."""
        home = "/root" if user == "root" else f"/home/{user}"
        inside = 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && exec chroot "$0" "$@"'
        return run("unshare", "--mount", *([] if network else ["--net"]), "bash", "-c", inside, self.root,
                   "/usr/sbin/runuser", "-u", user, "--", "/usr/bin/env", "-i", f"HOME={home}", "LANG=C.UTF-8",
                   "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
                   "sh", "-ec", f"cd {home}/jostle\n{script}", accept=accept)

    def add_user(self):
        """An ordinary user with a checkout of its own."""
        self.sh(f"id {USER} >/dev/null 2>&1 || useradd --create-home {USER}; rm -rf /home/{USER}/jostle; "
                f"cp -r /root/jostle /home/{USER}/jostle; chown -R {USER}: /home/{USER}/jostle")


def quickstart(chroot, platform, digest, user="root"):
    """From the README's command to the table, and the recorded digest by both programs of ./dev."""
    began = time.monotonic()
    print(chroot.sh(f"./dev run {QUICKSTART}", user))
    print(f"{platform}: {time.monotonic() - began:.0f} s from the command to the table")
    expect_digest(platform, chroot.sh("./dev info --digest quickstart.h5", user), digest)
    print(chroot.sh(f"./dev selftest; ./dev run {QUICKSTART} --force --quiet", user))  # builds all of jostle
    expect_digest(platform, chroot.sh("./dev info --digest quickstart.h5", user), digest)


def expect_digest(platform, printed, digest):
    if printed.split()[-1] != digest:
        sys.exit(f"{platform}: the quickstart's digest is {printed.split()[-1]}, not {digest}")
    print(f"{platform}: the quickstart's digest is the recorded one")


def ordinary_user(chroot, platform, digest):
    """A user who is not root is given the command that installs what is missing, and needs no other."""
    chroot.add_user()
    refused = chroot.sh(f"./dev run {QUICKSTART}", USER, accept=(0, 4))
    command = re.search(r"sudo (apt-get install .*)", refused)
    if command:
        print(f"{platform}: {command[0]}")
        chroot.sh(f"apt-get update >/dev/null; DEBIAN_FRONTEND=noninteractive {command[1]} -y </dev/null")
    quickstart(chroot, platform, digest, USER)


def container(chroot, platform, digest):
    """The Containerfile's commands, then the program and the package, as an ordinary user, outside the environment."""
    text = (SOURCE / "Containerfile").read_text().replace("\\\n", " ")
    path = re.search(r"^ENV PATH=(.*):\$PATH$", text, re.MULTILINE)[1]
    for command in re.findall(r"^RUN (.*)$", text, re.MULTILINE):
        began = time.monotonic()
        chroot.sh(f"export DEBIAN_FRONTEND=noninteractive; {command}", network="apt-get" in command)
        print(f"{platform}: {time.monotonic() - began:.0f} s: {' '.join(command.split())}")
    chroot.add_user()
    print(chroot.sh(f"cd; export PATH={path}:$PATH; jostle --version; rm -f quickstart.h5; "
                    f"jostle run jostle/{QUICKSTART} --quiet", USER, network=False))
    found = chroot.sh(f"""cd; {path}/python3 -c '
import importlib.metadata, jostle
assert jostle.__file__.startswith("{path}"[:-3]), jostle.__file__
assert jostle.program_path() == "{path}/jostle", jostle.program_path()
assert jostle.__version__ == importlib.metadata.version("jostle")
assert jostle.open("quickstart.h5").points[0].mean["mean_height"][-1] > 3
print(jostle.check("jostle/{QUICKSTART}").resolved["name"], jostle.__version__)
print(jostle.open("quickstart.h5").digest())'""", USER, network=False)
    print(found)
    expect_digest(platform, found, digest)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("platform", choices=SUITES)
    parser.add_argument("--tests", action="store_true", help="./dev test as well")
    parser.add_argument("--user", action="store_true", help="as an ordinary user")
    parser.add_argument("--pip", action="store_true", help="the Containerfile: pip install . without a network")
    arguments = parser.parse_args()
    if subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode != 0:
        sys.exit("no chroot can be made here: that needs root or user namespaces")
    recorded = json.loads((SOURCE / "tests/data/quickstart_digest.json").read_text())["sha256"]
    chroot = Chroot(SUITES[arguments.platform])
    chroot.copy_sources()
    if arguments.pip:
        container(chroot, arguments.platform, recorded)
    elif arguments.user:
        ordinary_user(chroot, arguments.platform, recorded)
    else:
        quickstart(chroot, arguments.platform, recorded)
    if arguments.tests:
        print(chroot.sh("./dev test </dev/null")[-2000:])


main()
