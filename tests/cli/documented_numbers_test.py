"""Numbers in README and tutorial are those that the commands beside them print.

Every indented block of output must occur, line by line and in order, in what the page's commands print, and every
value with an error in a sentence, a(b), must occur there too. "..." in a block stands for text left out."""

import os
import re
import shutil
import subprocess
import unittest

from support import JOSTLE, PLAIN, SOURCE, Case

VALUE = r"-?\d[\d.]*\(\d[\d.]*\)(?:e[-+]\d+)?"


def words(text):
    return " ".join(text.split())


def blocks(page):
    """The indented blocks of a page: lists of lines."""
    found, block = [], []
    for line in page.splitlines() + [""]:
        if line.startswith("    "):
            block.append(line[4:])
        elif block:
            found.append(block)
            block = []
    return found


class DocumentedNumbers(Case):
    def printed(self, page):
        """Output of the page's commands, run in the order of the page in a folder with the shipped scenes."""
        folder = self.folder / "pages"
        shutil.copytree(SOURCE / "config", folder / "config")
        (folder / "bin").mkdir()
        (folder / "bin/jostle").symlink_to(JOSTLE)
        environment = {**PLAIN, "PATH": f"{folder}/bin:{os.environ['PATH']}"}
        printed = []
        for line in (line for block in blocks(page) for line in block):
            command = re.match(r"(?:jostle|\./dev) (.*?)(?:\s{2,}#.*)?$", line)
            if command is None or command.group(1).split()[0] == "test":
                continue
            done = subprocess.run(["bash", "-c", f"jostle {command.group(1)}"], cwd=folder, env=environment,
                                  text=True, capture_output=True)
            self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}{done.stderr}")
            printed.append(done.stdout)
        return words("\n".join(printed))

    def check(self, name, least_lines, least_values):
        page = (SOURCE / name).read_text()
        printed = self.printed(page)
        n_lines = 0
        for block in blocks(page):
            at = 0
            for line in block:
                if re.match(r"(jostle|\./dev) ", line):
                    continue
                for part in filter(None, (words(part) for part in line.split("..."))):
                    n_lines += 1
                    found = printed.find(part, at)
                    self.assertGreaterEqual(found, 0, f"{name}: no command of the page prints this: {part}")
                    at = found + len(part)
        sentences = "\n".join(line for line in page.splitlines() if not line.startswith("    "))
        values = re.findall(VALUE, sentences)
        for value in values:
            self.assertIn(value, printed, f"{name}: no command of the page prints this value")
        self.assertGreaterEqual(n_lines, least_lines)
        self.assertGreaterEqual(len(values), least_values)

    def test_the_readme(self):
        self.check("README.md", least_lines=9, least_values=1)

    def test_the_tutorial(self):
        self.check("docs/tutorial.md", least_lines=15, least_values=8)


if __name__ == "__main__":
    unittest.main()
