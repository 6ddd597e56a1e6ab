"""The arrows between folders: engine <- structure <- ensemble; fitting is independent; config and results use those;
study joins them; cli is its command line; bench measures. Read from the include lines, independent of the links of
CMake. Modules of the Python package import one another in one direction, too."""

import ast
import graphlib
import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])

MAY_INCLUDE = {
    "engine": {"engine"},
    "structure": {"engine", "structure"},
    "fitting": {"fitting"},
    "ensemble": {"engine", "structure", "fitting", "ensemble"},
    "config": {"engine", "structure", "ensemble", "config"},
    "results": {"engine", "structure", "ensemble", "results"},
    "bench": {"engine", "structure", "fitting", "ensemble", "config", "results", "bench", "tests"},
    "study": {"engine", "structure", "fitting", "ensemble", "config", "results", "study"},
    "sdk": {"engine", "structure", "fitting", "ensemble", "config", "results", "study"},
    "cli": {"engine", "structure", "fitting", "ensemble", "bench", "config", "results", "study",
            "cli"},
}

# The rooms of a folder, and the rooms that each may include; the folder's root holds what all of them use.
ROOMS = {
    "study": {"tables": set(), "running": {"tables"}, "drawing": {"tables", "running"},
              "planning": {"tables", "running"}},
    "results": {"disk": set(), "locks": {"disk"}, "content": {"disk"}, "hdf5": {"disk"},
                "checkpoints": {"disk", "content"},
                "groups": {"disk", "content", "hdf5", "checkpoints"},
                "file": {"disk", "locks", "content", "hdf5", "checkpoints", "groups"},
                "export": {"disk", "content", "hdf5", "groups", "file"},
                "run": {"disk", "locks", "content", "checkpoints", "file"}},
}

# Other headers that only some folders may include.
RESERVED = {
    r"hdf5|H5\w*\.h": {"results"},
    r"openssl/": {"results"},
    r"tbb/|oneapi/tbb": {"ensemble/parallel.cpp", "cli/terminal/version.cpp"},
    r"nlohmann/": {"config/json/parse_and_print.cpp", "results/file/validate.cpp"},
    r"CLI/": {"cli/options/command.cpp", "cli/options/command_line.cpp",
             "cli/options/command_text.cpp", "cli/terminal/version.cpp"},
    r"Eigen/Core": {"fitting", "ensemble"},
    r"unsupported/Eigen/FFT": {"ensemble/statistics/autocorrelation.cpp",
                               "ensemble/analysis/spectra/spectra.cpp"},
    r"Eigen/(?!Core)": {"fitting/solver/decompositions.cpp"},
    r"muParser": {"study/tables/laws/law_formula.cpp"},
    r"spdlog/": {"cli/terminal/log.cpp", "cli/terminal/version.cpp"},
    r"Random123/": {"engine/bed/philox.hpp"},
    r"thread$|mutex$|atomic$|condition_variable$|future$|pthread": {"ensemble", "bench", "results", "study", "cli"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.MULTILINE)


def includes():
    """(file, kind of quotes, what it includes) of every source, files relative to the root."""
    for folder in MAY_INCLUDE:
        for path in sorted((SOURCE / folder).rglob("*.[ch]pp")):
            for quote, name in INCLUDE.findall(path.read_text()):
                yield path.relative_to(SOURCE), quote, name


# Types in an anonymous namespace may have any name.
ANONYMOUS = re.compile(r"^namespace \{.*?^\}  // namespace$", re.DOTALL | re.MULTILINE)
# A class, struct, union or enumeration that is defined here: neither declared nor specialised.
DEFINED = re.compile(r"(?<!template <>\n)^(?:template <[^>\n]+> )?(?:class|struct|union|enum class|enum)"
                     r"\s+(?:alignas\([^)]*\)\s*)?(\w+)\b(?!::|<)[^;{(]*\{", re.MULTILINE)


def types_by_name():
    """{name: files that define a type of this name for all to see}."""
    found = {}
    for folder in MAY_INCLUDE:
        for path in sorted((SOURCE / folder).rglob("*.[ch]pp")):
            for name in DEFINED.findall(ANONYMOUS.sub("", path.read_text())):
                found.setdefault(name, []).append(str(path.relative_to(SOURCE)))
    return found


def python_imports():
    """{module of the package: modules of the package that it imports}, anywhere in it, for annotations too."""
    root = SOURCE / "python/jostle"
    files = {path.relative_to(root).with_suffix("").parts: path for path in sorted(root.rglob("*.py"))}
    modules = {tuple(part for part in parts if part != "__init__"): parts for parts in files}
    found = {}
    for module, parts in modules.items():
        found[module] = set()
        for node in ast.walk(ast.parse(files[parts].read_text())):
            if isinstance(node, ast.ImportFrom) and node.level:
                source = parts[:len(parts) - node.level] + tuple((node.module or "").split(".") if node.module else ())
                names = [source + (name.name,) for name in node.names]
                found[module] |= {name if name in modules else source for name in names}
    return found


class Architecture(unittest.TestCase):
    def test_there_is_something_to_look_at(self):
        folders = {file.parts[0] for file, _, _ in includes()}
        self.assertEqual(folders, set(MAY_INCLUDE))

    def test_own_headers_are_named_from_the_root_and_follow_the_arrows(self):
        wrong = [f"{file} includes {name}" for file, quote, name in includes()
                 if quote == '"' and name.split("/")[0] not in MAY_INCLUDE[file.parts[0]]]
        self.assertEqual(wrong, [])

    def test_rooms_follow_their_arrows(self):
        for folder, may_include in ROOMS.items():
            rooms = {path.name for path in (SOURCE / folder).iterdir() if path.is_dir()}
            self.assertEqual(rooms, set(may_include))
            wrong = []
            for file, quote, name in includes():
                target = pathlib.PurePath(name).parts
                if quote != '"' or file.parts[0] != folder or target[0] != folder or len(target) < 3:
                    continue
                room = file.parts[1] if len(file.parts) > 2 else "the root"
                if target[1] not in may_include.get(room, set()) | {room}:
                    wrong.append(f"{file} includes {name}")
            self.assertEqual(wrong, [])

    def test_python_modules_import_one_another_in_one_direction(self):
        imports = python_imports()
        self.assertIn(("errors",), imports[("results",)])
        self.assertIn(("results",), imports[("plot", "curves")])
        try:
            graphlib.TopologicalSorter(imports).prepare()
        except graphlib.CycleError as error:
            self.fail("circle: " + " -> ".join(".".join(module) for module in error.args[1]))

    def test_folders_and_files_keep_their_size(self):
        """About twenty sources and about 400 lines: what a reader can survey."""
        folders, files = {}, {}
        for folder in MAY_INCLUDE:
            for path in (SOURCE / folder).rglob("*.[ch]pp"):
                room = str(path.parent.relative_to(SOURCE))
                folders[room] = folders.get(room, 0) + 1
                files[str(path.relative_to(SOURCE))] = path.read_text().count("\n")
        self.assertEqual({folder: n for folder, n in folders.items() if n > 22}, {})
        self.assertEqual({file: n for file, n in files.items() if n > 420}, {})

    def test_every_type_is_defined_once(self):
        """Two of one name would be one to the linker, which takes either."""
        types = types_by_name()
        self.assertGreater(len(types), 200)
        self.assertEqual({name: files for name, files in types.items() if len(files) > 1}, {})

    def test_every_library_has_a_namespace_of_its_own(self):
        wrong = []
        for folder in set(MAY_INCLUDE) - {"bench"}:
            for path in sorted((SOURCE / folder).rglob("*.[ch]pp")):
                for name in re.findall(r"^namespace jostle\b(.*) \{$", path.read_text(), re.MULTILINE):
                    if not re.fullmatch(rf"::inline {folder}(::JOSTLE_KERNELS)?", name):
                        wrong.append(f"{path.relative_to(SOURCE)}: namespace jostle{name}")
        self.assertEqual(wrong, [])

    def test_texts_of_the_libraries_name_no_options(self):
        """Callers from C++ or Python have no options; the command line names them."""
        wrong = []
        for folder in set(MAY_INCLUDE) - {"cli", "bench"}:
            for path in sorted((SOURCE / folder).rglob("*.[ch]pp")):
                for text in re.findall(r'"[^"\n]*(?<![\w-])--[a-z][^"\n]*"', path.read_text()):
                    wrong.append(f"{path.relative_to(SOURCE)}: {text}")
        self.assertEqual(wrong, [])

    def test_libraries_are_seen_only_where_they_belong(self):
        wrong = []
        for file, quote, name in includes():
            for pattern, places in RESERVED.items():
                seen = quote == "<" and re.match(pattern, name)
                if seen and not {file.parts[0], str(file)} & places:
                    wrong.append(f"{file} includes <{name}>, which is for {sorted(places)}")
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
