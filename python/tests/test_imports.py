"""Tests that the files of the package have no circular imports."""

import ast
from pathlib import Path

import twintac

ROOT = Path(__file__).parents[1] / "twintac"


def module_of(file: Path) -> str:
    parts = ["twintac", *file.relative_to(ROOT).with_suffix("").parts]
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported(tree: ast.Module) -> set[str]:
    """Modules and names that a file imports, at once or later; `twintac.a.b` for
    `from twintac.a import b`.
    """
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            found.update(f"{node.module}.{alias.name}" for alias in node.names)
    return found


def circles(imports: dict[str, set[str]]) -> set[str]:
    """Files that import themselves, directly or through others."""

    def reached(start: str) -> set[str]:
        found: set[str] = set()
        pending = [start]
        while pending:
            for name in imports[pending.pop()] - found:
                found.add(name)
                pending.append(name)
        return found

    return {name for name in imports if name in reached(name)}


def test_no_file_imports_itself_by_others() -> None:
    files = {module_of(file): file for file in ROOT.rglob("*.py")}
    assert "twintac.gymnasium._vector" in files
    imports: dict[str, set[str]] = {}
    for name, file in files.items():
        names = {found for own in imported(ast.parse(file.read_text(encoding="utf-8"))) for found in (own, own.rpartition(".")[0])}
        # A name that `twintac/__init__.py` passes on is not an import of that file.
        front = {"twintac"} if name.startswith("twintac.") else set()
        imports[name] = {found for found in names - front - {name} if found in files}
    assert circles(imports) == set()
    assert twintac.__name__ in imports


def test_a_circle_is_found() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == {"b", "c"}
