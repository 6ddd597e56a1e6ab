#!/usr/bin/env python3
"""Writes docs/reference/scene-keys.md from the schema on standard input; --check only compares the two."""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCHEMA = json.load(sys.stdin)
PAGE = ROOT / "docs/reference/scene-keys.md"
HEAD = """# Scene reference

This page lists every key of a scene with type, range and default. [scene.md](scene.md) explains the keys.
`./dev scene-reference` makes the page of the schema (`jostle schema`). In a path, `[]` is an element of a
list. A key without a default that is not required may be omitted. "Required in its form": the object has
several forms, and the key belongs to one of them.
"""


def resolved(schema):
    """Resolves $ref and joins allOf into the schema."""
    while "$ref" in schema:
        name = schema["$ref"].removeprefix("#/definitions/")
        schema = {**SCHEMA["definitions"][name], **{k: v for k, v in schema.items() if k != "$ref"}}
    for part in schema.get("allOf", []):
        inherited = {k: v for k, v in resolved(part).items() if k != "default"}  # it may be absent for a reason
        schema = {**inherited, **{k: v for k, v in schema.items() if k != "allOf"}}
    return schema


def variants(schema):
    """The alternatives of a value, one schema per kind; alternatives that only require keys are one kind."""
    for key in ("anyOf", "oneOf"):
        if any(set(part) != {"required"} for part in schema.get(key, [])):
            return [one for part in schema[key] for one in variants(resolved(part))]
    return [schema]


def number(value):
    exact = not isinstance(value, float) or 2**63 <= value <= 2**64  # the schema has seeds as numbers with a point
    return str(int(value)) if exact else f"{value:g}"


def limits(schema):
    low, high = schema.get("minimum"), schema.get("maximum")
    above, below = schema.get("exclusiveMinimum"), schema.get("exclusiveMaximum")
    words = []
    if low is not None and high is not None:
        words.append(f"{number(low)} to {number(high)}")
    elif low is not None:
        words.append(f"at least {number(low)}")
    if above is not None:
        words.append(f"above {number(above)}")
    if below is not None:
        words.append(f"below {number(below)}")
    if high is not None and low is None:
        words.append(f"at most {number(high)}")
    return ", ".join(words)


def elements(schema):
    """Describes the elements of a list."""
    items = schema.get("items", {})
    return [one for item in (items if isinstance(items, list) else [items]) for one in variants(resolved(item))]


def list_size(schema):
    least, most = schema.get("minItems"), schema.get("maxItems")
    if least is not None and least == most:
        return f"of {least}"
    return f"of at most {most}" if most is not None else ""


def kind(schema):
    """In words: "whole, 1 to 100", "`hcp`, `fcc`", "object"."""
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(value)}`" for value in schema["enum"])
    name = schema.get("type")
    if name in ("integer", "number"):
        return ", ".join(filter(None, ("whole" if name == "integer" else "number", limits(schema))))
    if name == "array":
        each = " or ".join(dict.fromkeys(kind(one) for one in elements(schema)))
        return " ".join(filter(None, ("list", list_size(schema), f"({each})" if each else "")))
    if name == "string" and "pattern" in schema:
        return f"string like `{schema['pattern']}`".replace("|", "\\|")
    return {"boolean": "`true`, `false`"}.get(name, name or "any value")


class Reference:
    """A row for every key, by its path."""

    def __init__(self):
        self.rows = {}
        self.described = {}  # definitions with keys of their own: their path

    def add(self, path, schema, given=""):
        """Rows for the value at `path` and all below it; `given`: "required", if it is."""
        name = definition(schema)
        schema = resolved(schema)
        kinds = variants(schema)
        row = self.rows.setdefault(path, {"kinds": [], "default": "", "said": []})
        row["default"] = row["default"] or (f"`{json.dumps(schema['default'])}`" if "default" in schema else given)
        said = (one["description"] for one in (schema, *kinds) if "description" in one)
        row["said"] = list(dict.fromkeys((*row["said"], *said)))
        if name and self.described.setdefault(name, path) != path:
            row["kinds"].append(f"as `{self.described[name]}`")
            return
        for one in kinds:
            word = kind({"type": schema.get("type"), **one})
            if not any(word in there for there in (*row["kinds"], "any value")):
                row["kinds"].append(word)
        if kinds != [schema]:
            self.add_below(path, [schema], False)
        self.add_below(path, kinds, True)

    def add_below(self, path, kinds, are_complete):
        forms = [one for one in kinds if "properties" in one]
        for one in forms:
            for name, member in one["properties"].items():
                given = ""
                if are_complete and name in one.get("required", []):
                    given = "required" if all(name in form["properties"] for form in forms) else "required in its form"
                self.add(f"{path}/{name}", member, given)
        for one in kinds:
            if one.get("type") == "array":
                for element in elements(one):
                    self.add(f"{path}[]", element)
                self.rows.pop(f"{path}[]", None)  # described by the list itself


def definition(schema):
    """The name of one that has keys of its own, where the schema is no more than that."""
    name = schema.get("$ref", "").removeprefix("#/definitions/")
    if not name and len(schema.get("allOf", [])) == 1:
        return definition(schema["allOf"][0])
    if not name:
        return None
    return name if any("properties" in one for one in variants(resolved(schema))) else definition(
        SCHEMA["definitions"][name])


def page():
    reference = Reference()
    for name, schema in SCHEMA["properties"].items():
        reference.add(f"/{name}", schema, "required" if name in SCHEMA["required"] else "")
    sections = {}
    for path, row in reference.rows.items():
        line = f"| `{path}` | {'; '.join(row['kinds'])} | {row['default']} | {' '.join(row['said'])} |\n"
        sections.setdefault(path.split("/")[1].removesuffix("[]"), []).append(line)
    alone = [lines[0] for lines in sections.values() if len(lines) == 1]
    parts = [("Single values", alone)] + [one for one in sections.items() if len(one[1]) > 1]
    return HEAD + "".join(f"\n## {name}\n\n| key | value | default | |\n|---|---|---|---|\n{''.join(lines)}"
                          for name, lines in parts)


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        if PAGE.read_text() != page():
            sys.exit("docs/reference/scene-keys.md is not what the schema makes: ./dev scene-reference")
    else:
        PAGE.write_text(page())
