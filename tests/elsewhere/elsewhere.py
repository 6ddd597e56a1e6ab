"""Builds and runs jostle on another Debian than this one, as its README says, in a chroot of its own.

./dev test-elsewhere debian13 [--tests] calls it, with SOURCE (the checkout) and BUILD (where the chroots
are kept). The tracked files of the checkout are copied in, `./dev run config/scenes/quickstart.json` installs
what it needs, builds, and runs, and the digest of the results must be the recorded one. With --tests,
`./dev test` follows there. Needs root or user namespaces, mmdebstrap, and a Debian mirror.
"""

import argparse
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time

SOURCE = pathlib.Path(os.environ["SOURCE"])
BUILD = pathlib.Path(os.environ["BUILD"])
SUITES = {"debian12": "bookworm", "debian13": "trixie", "testing": "testing", "unstable": "unstable"}
QUICKSTART = "config/scenes/quickstart.json"


def run(*command, **options):
    """Runs a command; a failure ends this program with the command's output."""
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **options)
    if done.returncode != 0:
        sys.exit(f"{shlex.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-20000:]}")
    return done.stdout


class Chroot:
    """A minimal Debian of one suite. It is made once; the checkout in it is made anew each time."""

    def __init__(self, suite):
        self.root = BUILD / suite
        if not (self.root / "usr/bin/apt-get").exists():
            shutil.rmtree(self.root, ignore_errors=True)
            run("mmdebstrap", "--variant=minbase", "--include=ca-certificates", suite, self.root)
        shutil.copy("/etc/resolv.conf", self.root / "etc/resolv.conf")

    def copy_sources(self):
        checkout = self.root / "root/jostle"
        shutil.rmtree(checkout, ignore_errors=True)
        checkout.mkdir(parents=True)
        archive = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z"], check=True, stdout=subprocess.PIPE)
        files = [name for name in archive.stdout.split(b"\0") if (SOURCE / os.fsdecode(name)).is_file()]
        packed = subprocess.run(["tar", "-C", SOURCE, "--null", "--files-from=-", "-c"], check=True,
                                input=b"\0".join(files), stdout=subprocess.PIPE)
        subprocess.run(["tar", "-C", checkout, "-x"], check=True, input=packed.stdout)

    def sh(self, script):
        """Runs a script in the checkout, with /proc and /dev; returns what it printed."""
        inside = ("mount -t proc proc \"$0/proc\" && mount --bind /dev \"$0/dev\" && "
                  "exec chroot \"$0\" /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "
                  "HOME=/root LANG=C.UTF-8 sh -ec \"cd /root/jostle; $1\"")
        return run("unshare", "--mount", "bash", "-c", inside, self.root, script)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("platform", choices=SUITES)
    parser.add_argument("--tests", action="store_true", help="./dev test as well")
    arguments = parser.parse_args()
    if subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode != 0:
        sys.exit("no chroot can be made here: that needs root or user namespaces")
    recorded = json.loads((SOURCE / "tests/data/quickstart_digest.json").read_text())["sha256"]
    chroot = Chroot(SUITES[arguments.platform])
    chroot.copy_sources()
    began = time.monotonic()
    print(chroot.sh(f"./dev run {QUICKSTART}"))
    print(f"{arguments.platform}: {time.monotonic() - began:.0f} s from the command to the table")
    digest = chroot.sh("./dev info --digest quickstart.h5").split()[-1]
    if digest != recorded:
        sys.exit(f"{arguments.platform}: the quickstart's digest is {digest}, not {recorded}")
    print(f"{arguments.platform}: the quickstart's digest is the recorded one")
    if arguments.tests:
        print(chroot.sh("./dev test </dev/null")[-2000:])


main()
