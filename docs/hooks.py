"""Hooks of MkDocs: they insert the parts of the reference that are generated from the sources,
formulas, and links to files outside of the book.

A page has a line for each part:

- `<!-- commands -->`: the help of the installed program
- `<!-- file: PATH -->`: a file of the checkout
- `<!-- fields: PATH TYPE -->`: the fields of a Rust type, with the documentation of its source

Where `cargo xtask web` has made the page on which a gel is pressed, it is part of the book, and the
picture of it on the first page has a button that starts it.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import griffe
from latex2mathml.converter import convert

DOCS = Path(__file__).parent
ROOT = DOCS.parent
PRESSED = ROOT / "target" / "web" / "twintac.html"
START = """<div class="pressed">PICTURE
<button type="button" class="md-button md-button--primary">Press it here</button></div>
<script>
document.querySelector(".pressed button").addEventListener("click", ({ target }) => {
  const frame = document.createElement("iframe");
  frame.src = "twintac.html";
  frame.title = "A gel to press";
  target.parentElement.replaceChildren(frame);
  frame.focus();
});
</script>
"""


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """The Markdown of a page, with all parts inserted."""
    text = re.sub(r"^<!-- commands -->$", lambda _: "\n".join(commands([])), markdown, flags=re.M)
    text = re.sub(r"^<!-- file: (\S+) -->$", lambda found: file(found[1]), text, flags=re.M)
    text = re.sub(r"^<!-- fields: (\S+) (\w+) -->$", lambda found: fields(found[1], found[2]), text, flags=re.M)
    text = re.sub(r"\$\$(.+?)\$\$", lambda found: convert(found[1].strip(), display="block"), text, flags=re.S)
    folder = (DOCS / page.file.src_uri).parent
    return re.sub(r"\]\(([^):#]+)(#[^)]*)?\)", lambda found: link(found, folder, config["repo_url"]), text)


def on_page_content(html: str, page: Any, config: Any, files: Any) -> str:
    """The HTML of a page: pictures after the first are loaded when they come near the window.

    On the first page, the picture of the gel becomes the gel at a click.
    """
    first, *others = html.split("<img ")
    html = "<img ".join([first, *others[:1], *(f'loading="lazy" {other}' for other in others[1:])])
    if page.file.src_uri != "index.md" or not PRESSED.exists():
        return html
    start, found = re.subn(r'<p>(<img [^>]*src="browser\.png"[^>]*>)</p>', lambda found: START.replace("PICTURE", found[1]), html)
    if found != 1:
        raise ValueError("docs/index.md has no picture browser.png of its own, where the gel starts")
    return start


def on_post_build(config: Any) -> None:
    """Adds the page on which a gel is pressed, if there is one."""
    if PRESSED.exists():
        shutil.copy(PRESSED, config["site_dir"])


def link(found: "re.Match[str]", folder: Path, repository: str) -> str:
    """A link. A link to a file outside of the book leads to the repository."""
    target = Path(os.path.normpath(folder / found[1]))
    if target.is_relative_to(DOCS) or not target.is_relative_to(ROOT):
        return found[0]
    kind = "tree" if target.is_dir() else "blob"
    return f"]({repository}/{kind}/main/{target.relative_to(ROOT).as_posix()}{found[2] or ''})"


def file(path: str) -> str:
    """A file of the checkout, as a code block."""
    text = (ROOT / path).read_text().rstrip()
    return f'```{Path(path).suffix[1:]} title="{path}"\n{text}\n```'


def commands(words: list[str]) -> Iterator[str]:
    """The program's help for a command and its subcommands."""
    program = Path(sys.executable).with_name("twintac")
    asked = [str(program), "help", *words]
    said = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    if words:
        yield f"## twintac {' '.join(words)}\n"
    description, usage = said.split("\nUsage: ", 1)
    yield description.strip() + "\n"
    line, *parts = re.split(r"\n\n(?=[A-Z]\w+:\n)", usage.strip())
    yield f"```text\n{line}\n```\n"
    below = []
    for title, part in (part.split(":\n", 1) for part in parts):
        rows = described(part)
        below += [name for name in rows if title == "Commands" and name != "help"]
        yield f"| {title.lower()} | |\n|---|---|"
        yield "\n".join(f"| `{name}` | {cell(meaning)} |" for name, meaning in rows.items()) + "\n"
    for name in below:
        yield from commands([*words, name])


def described(part: str) -> dict[str, str]:
    """The names in a part of the help, with their descriptions, on the same line or below."""
    rows: dict[str, str] = {}
    for line in part.splitlines():
        if begin := re.fullmatch(r" {2,6}(\S.*?)(?: {2,}(.*))?", line):
            rows[begin[1]] = begin[2] or ""
        elif line.strip():
            name = list(rows)[-1]
            rows[name] = f"{rows[name]} {line.strip()}".strip()
    return rows


def fields(path: str, name: str) -> str:
    """A table of a Rust type's fields, or of an enumeration's variants and their fields."""
    source = (ROOT / path).read_text()
    found = re.search(rf"^pub(?:\(crate\))? (struct|enum) {name}\b[^{{]*\{{\n(.*?)^\}}", source, flags=re.M | re.S)
    if not found:
        raise ValueError(f"{path} has no struct or enum `{name}` with fields")
    rows = ["| field | type | meaning |", "|---|---|---|"]
    meaning: list[str] = []
    attributes = ""
    is_enum = found[1] == "enum"
    container = re.findall(r"(?:^#\[.*\]\n)*\Z", source[: found.start()], flags=re.M)[0]
    all_optional = re.search(r"#\[serde\([^\]]*\bdefault\b", container) is not None
    for line in map(str.strip, found[2].splitlines()):
        field = re.fullmatch(r"(?:pub(?:\(crate\))? )?(\w+): (.+),", line)
        variant = re.fullmatch(r"(\w+)(?: \{|\((\w+)\),|,)", line)
        if line.startswith("///"):
            meaning.append(line[3:].strip())
        elif line.startswith("#["):
            attributes += line
        elif field or (variant and is_enum):
            label = renamed(attributes) or (field[1] if field else kebab(variant[1] if variant else ""))
            kind = toml_type(field[2], all_optional or "default" in attributes) if field else "kind"
            indent = "&emsp;" if field and is_enum else ""
            rows.append(f"| {indent}`{label}` | {kind} | {markdown_of(' '.join(meaning))} |")
        if not line.startswith(("///", "#[")):
            meaning, attributes = [], ""
    return "\n".join(rows) + "\n"


def renamed(attributes: str) -> str:
    """The name in files that an attribute gives a field; empty if there is none."""
    found = re.search(r'rename = "(\w+)"', attributes)
    return found[1] if found else ""


def kebab(name: str) -> str:
    """A variant's name in files."""
    return re.sub(r"(?<!^)(?=[A-Z])", "-", name).lower()


TOML_TYPES = {"f64": "number", "f32": "number", "String": "text", "PathBuf": "path", "bool": "true or false", "char": "character", "DVec3": "three numbers", "Pose": "pose"}


def toml_type(rust: str, can_be_left_out: bool) -> str:
    """The description of a Rust type in a TOML file."""
    if inner := re.fullmatch(r"Option<(.+)>", rust):
        return toml_type(inner[1], can_be_left_out=True)
    optional = ", optional" if can_be_left_out else ""
    if inner := re.fullmatch(r"Vec<(.+)>", rust):
        return f"list of {toml_type(inner[1], False)}{optional}"
    if inner := re.fullmatch(r"\[(\w+); (\d+)\]", rust):
        return f"{inner[2]} {toml_type(inner[1], False)}s{optional}"
    if re.fullmatch(r"[ui](8|16|32|64|size)", rust):
        return f"integer{optional}"
    name = re.sub(r"^(?:\w+::)*(\w+).*", r"\1", rust)
    return TOML_TYPES.get(name, f"`{name}`") + optional


def markdown_of(doc: str) -> str:
    """A doc comment without Rust's links to types."""
    text = re.sub(r"\[`(?:\w+::)*([A-Z]\w+)::([a-z]\w+)`\](?:\([^)]*\))?", r"`\2` of `\1`", doc)
    text = re.sub(r"\[`(?:\w+::)*(\w+)`\](?:\([^)]*\))?", r"`\1`", text)
    return cell(text)


def cell(text: str) -> str:
    """Text, escaped for a table."""
    return text.replace("|", "\\|").replace("[[", "&#91;&#91;").replace("<", "&lt;")


ALIASES = {
    "_Path": "path",
    "_Provenance": "provenance",
    "_Simulated": "provenance",
    "_Float": "NDArray[float64]",
    "_Single": "NDArray[float32]",
    "_Bool": "NDArray[bool]",
    "_Floats": "ArrayLike",
    "_Integers": "ArrayLike",
    "_Number": "float",
}


class LibraryDocstrings(griffe.Extension):
    """Improves the stubs of the compiled library: adds the library's docstrings where the stubs
    have none, and replaces private names of types.
    """

    def on_instance(self, *, obj: Any, **_: Any) -> None:
        """Called by griffe for each object."""
        if obj.is_module or not str(obj.filepath).endswith("_twintac.pyi"):
            return
        parameters = obj.parameters if obj.is_function else []
        annotations = [parameter.annotation for parameter in parameters]
        annotations += [getattr(obj, "annotation", None), getattr(obj, "returns", None)]
        for annotation in annotations:
            for part in annotation.iterate(flat=True) if isinstance(annotation, griffe.Expr) else []:
                if isinstance(part, griffe.ExprName):
                    part.name = ALIASES.get(part.name, part.name)
        said = obj.name != "__new__" and of_library(obj.path)
        if said and not obj.docstring:
            obj.docstring = griffe.Docstring(said, parent=obj, parser="google")


def of_library(path: str) -> str:
    """The docstring of a class or a member in the compiled library."""
    member: Any = import_module("twintac._twintac")
    for name in path.removeprefix("twintac._twintac.").split("."):
        member = getattr(member, name, None)
    return getattr(member, "__doc__", None) or ""
