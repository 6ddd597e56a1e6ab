"""The Python API: signatures and docstrings of the public names, read from the sources without importing them."""

import ast
import html
import pathlib
import re

PATH = "docs/reference/python-api.md"


def body(package: pathlib.Path) -> str:
    parts = ["<h1>Python API</h1>", '<p>Signatures and docstrings of the package. <a href="python.md">Python</a> is '
             "the guide, with examples.</p>"]
    for module, folder in (("jostle", package), ("jostle.plot", package / "plot")):
        parts.append(f'<h2 id="{module}">{module}</h2>')
        init = ast.parse((folder / "__init__.py").read_text())
        parts.append(docstring(init))
        sources = [ast.parse(file.read_text()) for file in sorted(folder.glob("*.py"))]
        definitions = {node.name: node for source in sources for node in source.body
                       if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        public = public_names(init)
        for name in public:
            if name in definitions:
                node = definitions[name]
                inner = [definitions[base.id] for base in getattr(node, "bases", []) if isinstance(base, ast.Name)
                         and base.id in definitions and base.id not in public]
                parts.append(entry(module, node, inner))
    return "\n".join(parts)


def public_names(init: ast.Module) -> list[str]:
    for node in init.body:
        if isinstance(node, ast.Assign) and node.targets[0].id == "__all__":
            return [one.value for one in node.value.elts]
    raise ValueError("the package has no __all__")


def entry(module: str, node: ast.ClassDef | ast.FunctionDef, inner: list[ast.ClassDef]) -> str:
    """inner: bases of a class that are not public, whose members are listed as its own."""
    anchor = f"{module}.{node.name}"
    head = f'<h3 id="{anchor}">{node.name}</h3>'
    if isinstance(node, ast.FunctionDef):
        return head + signature(node, f"{module}.") + docstring(node)
    hidden = {base.name for base in inner}
    bases = ", ".join(text for base in node.bases if (text := ast.unparse(base)) not in hidden)
    parts = [head, f'<pre class="signature"><code>class {anchor}{f"({bases})" if bases else ""}</code></pre>',
             docstring(node)]
    fields = [(ast.unparse(one.target), ast.unparse(one.annotation)) for one in node.body
              if isinstance(one, ast.AnnAssign) and not ast.unparse(one.target).startswith("_")]
    if fields:
        parts.append("<ul>" + "".join(f"<li><code>{html.escape(f'{name}: {kind}')}</code></li>"
                                      for name, kind in fields) + "</ul>")
    methods = [one for part in (*inner, node) for one in part.body
               if isinstance(one, ast.FunctionDef) and not one.name.startswith("_")]
    parts += [f'<div class="member">{signature(one)}{docstring(one)}</div>' for one in methods]
    return "\n".join(parts)


def signature(node: ast.FunctionDef, prefix: str = "") -> str:
    result = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    if any(ast.unparse(one).endswith("property") for one in node.decorator_list):
        text = f"{node.name}{result}"
    else:
        arguments = re.sub(r"^self(, |$)", "", ast.unparse(node.args))
        text = f"{prefix}{node.name}({arguments}){result}"
    return f'<pre class="signature"><code>{html.escape(text)}</code></pre>'


def docstring(node: ast.AST) -> str:
    """A docstring as HTML: paragraphs, and examples, which are indented."""
    parts = []
    lines = (ast.get_docstring(node) or "").splitlines()
    # Empty lines within an example belong to it.
    for example, text in re.findall(r"(?m)((?:^    .*\n(?:\n(?=    ))*)+)|((?:^\S.*\n)+)", "\n".join([*lines, ""])):
        if example:
            code = re.sub(r"(?m)^    ", "", example.rstrip())
            parts.append(f"<pre><code>{html.escape(code)}</code></pre>")
        else:
            text = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text))
            parts.append(f"<p>{text}</p>")
    return "\n".join(parts)
