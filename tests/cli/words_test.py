"""Checks the wording of everything a person reads: messages, help, comments, docstrings, documents, scenes.

Each rule is a regular expression over extracted texts. `python3 words_test.py --counts` prints what each
room still contains; `--list ROOM` prints the places.
"""

import ast
import bisect
import collections
import io
import json
import os
import pathlib
import re
import sys
import tokenize
import unittest

SOURCE = pathlib.Path(os.environ.get("SOURCE", pathlib.Path(__file__).resolve().parents[2]))
ROOMS = ("bench", "cli", "cmake", "config", "docs", "engine", "ensemble", "examples", "fitting", "packages",
         "python", "report", "results", "structure", "study", "tests", "dev")

RULES = ("start", "private", "message", "per", "name", "help", "width")

# Made from texts of the schema, to which "message" applies.
GENERATED = ("docs/reference/scene-keys.md",)

# Exact phrases that are correct although a rule finds them.
# Descriptions of stored columns are part of digests. Figures print "per" (study/drawing/drawn/printed_names.cpp).
EXCEPTIONS = ("moves a sphere", "energy a sphere", "force a sphere")

PER = (r"(?:cell|command|contact|core|day|decade|entry|file|folder|hour|job|law|line|member|minute|move|node|pair|"
       r"point|process|realization|row|sample|second|snapshot|sphere|step|strength|submission|sweep|tap|"
       r"test|thread|trial|unit|value|waiting time|year)s?")
UNIT = (r"(?:[\d}%]|bytes|columns|contacts|cores|curve|cycles|energy|entries|files|growth|GB|hours|jobs|kB|lags|"
        r"lines|MB|measurements|milliseconds|minutes|moves|ms|nanoseconds|ns|numbers|once|one|pairs|points|"
        r"realizations|rows|sample|samples|seconds|spheres|steps|sweeps|taps|ten|tests|threads|time|times|trials|"
        r"twice|two|updates|us|values|volume|words|/s)")
START = re.compile(r"(?:Of|What|Whether|That|As|So|Which|Likewise|The same|The others)\b(?![.-])")
SENTENCES = re.compile(r"(?:^|(?<=[a-z)\d\"'`][.!?] ))(?=\w)")
PRIVATE = re.compile(
    r"\b(?:says?|said|tells?|telling|told|stands?(?! for|-)|stood|lies(?! (?:within|inside|outside|above|below|beyond|between|in|on|near|far)\b)|hangs? on|hung on|hold against|"
    r"held against|mends?|mended|lacks?(?! of)|lacked|wants?(?! of\b)|wanted|wanting|goes on|went on|"
    r"know better|knows better|(?:is|are|was|were) of (?!the order)|clock of the wall|"
    r"taken away|surroundings|flatter(?:s|ed)?|(?:is|are) no (?:more )?(?:fault|loss|text|one)\b)\b", re.I)
RATE = re.compile(rf"(?<!\w)(?<!-){UNIT} an? {PER}\b(?!-)")
NAMES = ("about above after again along among apart around aside at away before behind below beside between both "
         "by down each elsewhere ever everywhere from hence here how in into it many more much off of on one "
         "other others out over same some such that them then there these this those through thus to together "
         "too under up upon what whatever when where which while who whose why with within without").split()
NAME = rf"(?P<name>{'|'.join(NAMES)})_?\b(?!\s*::)"
NO_TYPES = ("and|case|co_return|co_yield|delete|else|goto|if|namespace|new|not|operator|or|return|throw|typename|using|"
            "while")
TYPE = rf"(?!(?:{NO_TYPES})\b)[A-Za-z_][\w:]*(?:<[^;=(){{}}]*>)?"
INITIAL = r"(?:\s*=[^=;,(){}]*(?:\([^()]*\)[^;,(){}]*)?|\[\w*\]|\{[^{};]*\}|\([^();]*\))?"
# A declared name follows its type, another declarator of the type, or an opening bracket. Operators, commas and
# brackets of calls precede uses.
DECLARATIONS = [re.compile(pattern, re.M) for pattern in (
    # int by;  Vec3& at = r;  auto of(int);  T Class::of(int);  for (const auto& in : all)
    rf"(?:(?<![\w.:])(?!(?:{NO_TYPES})\b)[A-Za-z_][\w:]*|(?<!\s)>)(?:\[\])?[&*]*(?:\.\.\.)?\s+(?:\w+::)*"
    rf"{NAME}(?=\s*[;,=(){{\[:])",
    # double a = 0, by = 1;  const Vec3 &from = a, &to = b;
    rf"^\s*(?:(?:const|static|constexpr|mutable)\s+)*{TYPE}[&*]*\s+[&*]?\w+{INITIAL}"
    rf"(?:,\s*[&*]?\w+{INITIAL})*?,\s*[&*]?{NAME}(?=\s*[;,={{(\[])",
    rf"^\s*(?:const\s+)?{TYPE} [&*]+{NAME}(?=\s*[;,=])",
    # auto [a, by]  [by = a]  enum Kind { by, at }
    rf"\bauto[&*]*\s*\[[^\]]*?\b{NAME}[^\]]*\]",
    rf"\[(?:[^\[\]();]*,)?\s*&?{NAME}\s*=(?!=)",
    rf"\benum\s+(?:class\s+)?\w+(?:\s*:\s*[\w:]+)?\s*\{{[^}}]*?(?:(?<=\{{)|(?<=\s)|(?<=,)){NAME}\s*(?=[,=}}])",
)]
# The standard library's names of checked access to an element and of the text of an exception.
STANDARD_NAMES = {("config/json/json.hpp", "at"), ("config/json/json.cpp", "at"), ("engine/starts/starts.hpp", "what")}
CPP_WORDS = {"this", "while"}
FUNCTION_WORDS = re.compile(
    r"(?:Of|As|With|Without|Only|Not|No|At|By|For|From|In|On|To|Where|When|How|What|Which|Whether|That|This|"
    r"These|It|Also|So|Likewise|If|And|Or)\b")

Text = collections.namedtuple("Text", "file line kind text")  # kind: comment, string, prose, code, help


def room_of(file):
    return file.split("/")[0] if "/" in file else "root"


def scan_cpp(source):
    """Comments, strings (adjacent ones joined) and the remaining code, each with its first line."""
    token = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\((.*?)\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
    texts, code, end = [], [], 0
    newlines = [m.start() for m in re.finditer("\n", source)]
    def line(position):
        return bisect.bisect_left(newlines, position) + 1
    for match in token.finditer(source):
        between = source[end:match.start()]
        code.append(between)
        word = match.group()
        end = match.end()
        code.append('""' + "\n" * word.count("\n"))
        if word[0] == "'":
            continue
        comment = word[0] == "/"
        kind = "comment" if comment else "string"
        if comment:
            text = re.sub(r"^/{2,3}<?\s?|^/\*+|\*/$", "", word)
        else:
            text = match.group(2) if word[0] == "R" else word[1:-1].replace("\\n", "\n").replace('\\"', '"')
        joined = not between.strip() and between.count("\n") < 2 and texts and texts[-1].kind == kind
        if joined and comment:
            joined = "\n" in between and bool(text.strip())
        if joined:
            texts[-1] = texts[-1]._replace(text=texts[-1].text + (" " if comment else "") + text)
        elif text.strip():
            texts.append(Text("", line(match.start()), kind, text))
    code.append(source[end:])
    return texts, "".join(code)


def scan_python(source):
    texts, last = [], None
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            text = token.string.lstrip("# ")
            if last and last[0] == token.start[0] - 1 and last[1] == token.start[1]:
                texts[-1] = texts[-1]._replace(text=texts[-1].text + " " + text)
            else:
                texts.append(Text("", token.start[0], "comment", text))
            last = token.start
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            texts.append(Text("", node.lineno, "string", node.value))
    return texts


def scan_markdown(source):
    texts, block, first, fenced = [], [], 0, False
    for n, line in enumerate([*source.splitlines(), ""], 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            line = ""
        starts = not line.strip() or re.match(r"\s*(?:[-*+|#>]|\d+\. )", line)
        if (starts or fenced) and block:
            texts.append(Text("", first, "prose", " ".join(block)))
            block = []
        if fenced or not line.strip():
            continue
        if line.startswith("|"):
            texts += [Text("", n, "cell", cell.strip()) for cell in line.strip("|").split("|") if cell.strip()]
            continue
        if not block:
            first = n
        block.append(re.sub(r"^\s*(?:[-*+>]|#+|\d+\.) *", "", line).strip())
    return texts


def scan_hashes(source):
    texts, last = [], 0
    for n, line in enumerate(source.splitlines(), 1):
        match = re.match(r"\s*#(?!!)\s?(.*)", line)
        if not match:
            continue
        if last == n - 1 and texts:
            texts[-1] = texts[-1]._replace(text=texts[-1].text + " " + match.group(1))
        else:
            texts.append(Text("", n, "comment", match.group(1)))
        last = n
    return texts


def scan_json(source):
    try:
        scene = json.loads(source)
    except ValueError:
        return []
    text = scene.get("description", "") if isinstance(scene, dict) else ""
    text = " ".join(text) if isinstance(text, list) else text
    return [Text("", 1, "prose", text)] if isinstance(text, str) and text else []


def help_texts(file, source):
    """Help of options: the last string of each call that adds one."""
    if not file.startswith("cli/"):
        return
    for match in re.finditer(r"add_(option|flag|reader)\(\s*\"(-?[^\"]*)\"", source):
        depth, position = 1, match.start() + source[match.start():].index("(") + 1
        while depth and position < len(source):
            if source[position] == '"':
                position = re.compile(r'"(?:\\.|[^"\\])*"').match(source, position).end()
                continue
            depth += {"(": 1, ")": -1}.get(source[position], 0)
            position += 1
        strings = [t for t in scan_cpp(source[match.start():position])[0] if t.kind == "string"]
        if len(strings) > 1:
            line = source.count("\n", 0, match.start()) + strings[-1].line
            yield Text(file, line, "help", strings[-1].text)


def files():
    for room in (".", *ROOMS):
        folder = SOURCE / room
        paths = folder.glob("*") if room == "." else folder.rglob("*")
        for path in sorted(paths):
            name = path.relative_to(SOURCE).as_posix()
            if path.is_file() and not re.search(r"(?:^|/)(?:build|node_modules|__pycache__|data|\.git)/", name):
                yield name, path


SCANNERS = {".py": scan_python, ".md": scan_markdown, ".json": scan_json, ".sh": scan_hashes,
            ".cmake": scan_hashes}


def faults_of_text(text):
    words = " ".join(text.text.split())
    for phrase in EXCEPTIONS:
        words = words.replace(phrase, "")
    is_question = text.kind in ("prose", "cell") and words.endswith("?")
    for place in SENTENCES.finditer(words):
        sentence = words[place.start():]
        if text.kind == "comment" and place.start() == 0:
            sentence = sentence[:1].upper() + sentence[1:]
        if START.match(sentence) and not is_question:
            yield "start", sentence[:60]
    for match in RATE.finditer(words):
        yield "per", match.group()
    for match in PRIVATE.finditer(re.sub("`[^`]*`", "", words)):
        yield "private", match.group()
    if text.kind == "help" and FUNCTION_WORDS.match(words):
        yield "help", words[:60]
    if text.kind == "cell" and re.search(r"(?<!\bsec)(?<=[a-z)])[.!?] [A-Z]", words):
        yield "width", f"more than one sentence in a cell: {words[:60]}"


def declared_names(code):
    """(line, name, text of the line) of C++ declarations named by a preposition, a pronoun or an adverb."""
    found = {}
    for pattern in DECLARATIONS:
        for match in pattern.finditer(code):
            if match.group("name") not in CPP_WORDS:
                found.setdefault(match.start("name"), match.group("name"))
    for place, name in sorted(found.items()):
        begin = code.rfind("\n", 0, place) + 1
        yield code.count("\n", 0, place) + 1, name, code[begin:].split("\n", 1)[0].strip()


def faults():
    """(rule, file, line, excerpt) of everything that a rule finds."""
    for name, path in files():
        suffix = path.suffix
        if name.endswith("CMakeLists.txt"):
            suffix = ".cmake"
        cpp = suffix in (".cpp", ".hpp", ".js") or name.endswith((".cpp.in", ".hpp.in"))
        if name in ("tests/cli/words_test.py", *GENERATED) or not (cpp or suffix in SCANNERS):
            continue
        source = path.read_text()
        if cpp:
            texts, code = scan_cpp(source)
            for n, declared, line in declared_names(code) if suffix != ".js" else ():
                if (name, declared) not in STANDARD_NAMES:
                    yield "name", name, n, f"{declared}: {line[:80]}"
            texts += help_texts(name, source)
        else:
            texts = SCANNERS[suffix](source)
        if suffix == ".md":
            for n, line in enumerate(source.splitlines(), 1):
                # Tables and commands are not wrapped.
                if len(line) > 120 and not line.startswith(("|", "    ")) and " " in line[:120].strip():
                    yield "width", name, n, f"{len(line)} characters"
        for text in texts:
            for rule, excerpt in faults_of_text(text):
                in_message = cpp and text.kind == "string" and rule in ("start", "private")
                yield "message" if in_message else rule, name, text.line, excerpt


class Words(unittest.TestCase):
    def test_texts_keep_to_the_rules(self):
        wrong = [f"{file}:{line}: {rule}: {excerpt}" for rule, file, line, excerpt in faults()]
        self.assertEqual(wrong, [], "\n".join(wrong))


    def test_each_rule_finds_a_fault_and_leaves_correct_text(self):
        for rule, kind, bad, good in (
                ("start", "comment", "Of a pour.", "A bed of a pour."),
                ("start", "prose", "It ran. What is next follows.", "What does it cost?"),
                ("per", "string", "{:.1f} steps a second", "{:.1f} steps per second"),
                ("per", "string", "one curve a waiting time, 40 taps a decade", "one curve per waiting time"),
                ("per", "string", "volume a sphere", "volume per sphere"),
                ("private", "string", "the file says so", "the file reports so"),
                ("help", "help", "Of the bootstrap (default 1)", "Seed of the bootstrap"),
                ("width", "cell", "one sentence. And another", "one sentence")):
            with self.subTest(rule=rule, bad=bad):
                self.assertIn(rule, [found for found, _ in faults_of_text(Text("", 1, kind, bad))])
                self.assertEqual(list(faults_of_text(Text("", 1, kind, good))), [])

    def test_declarations_are_found_and_uses_are_not(self):
        for code in ("int by = 1;", "const Vec3& at = r;", "std::vector<Vec3> of(int n);", "Vec3 Path::at(double s) {",
                     "for (const auto& one : all) {", "f([](const Vec3& other) {", "double a = f(1, 2), by = 3;",
                     "const Vec3 &r = a,\n           &by = b;", "const auto [n, by] = f();", "g([by = a.b] {",
                     "enum class Kind { plain, other };", "Json out{{1, 2}};", "int n = 0, at = 0;", "Shape in_;",
                     "template <class Of>\nvoid f(int n, const Of& of) {", "  std::vector<T>& into) {"):
            with self.subTest(code=code):
                self.assertEqual(len(list(declared_names(code))), 1)
        for code in ("table.at(i) = 1;", "names->of(1);", "std::ios::in | std::ios::out", "return by(a);", "f(a, by);",
                     "f({.from = 1, .to = 2});", "a = b * at(c);", "Site::other;", "if (n > at) {", "by.push_back(a);",
                     "Box::of(extent);", "while (i < n) {", "int bypass = 1;", "x = {by, at};", "delete by;"):
            with self.subTest(code=code):
                self.assertEqual(list(declared_names(code)), [])

    def test_texts_are_found_in_each_language(self):
        texts, code = scan_cpp('int by = 1;  // of a\nf("a " "b", \'"\');  /// c\n')
        self.assertEqual([(t.kind, t.text) for t in texts], [("comment", "of a"), ("string", "a b"), ("comment", "c")])
        self.assertEqual([(line, name) for line, name, _ in declared_names(code)], [(1, "by")])
        self.assertEqual([t.text for t in scan_hashes("#!/bin/sh\n# one\n# two\nx=1\n")], ["one two"])
        self.assertEqual([t.kind for t in scan_markdown("# A\n\ntext\n\n```\ncode\n```\n| a | b |\n")],
                         ["prose", "prose", "cell", "cell"])
        self.assertEqual([t.text for t in scan_python('"""A module."""\nx = 1  # a note\n')], ["a note", "A module."])


def main():
    if sys.argv[1:2] == ["--counts"]:
        counts = collections.Counter((room_of(file), rule) for rule, file, _, _ in faults())
        for room in ("root", *ROOMS):
            print(f"{room:10}", *(f"{rule} {counts[room, rule]:4}" for rule in RULES))
    elif sys.argv[1:2] == ["--list"]:
        for rule, file, line, excerpt in faults():
            if file.startswith(sys.argv[2]) and (len(sys.argv) < 4 or rule in sys.argv[3:]):
                print(f"{file}:{line}: {rule}: {excerpt}")
    else:
        unittest.main()


if __name__ == "__main__":
    main()
