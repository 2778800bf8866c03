"""Writes the docstrings of the compiled library into its type stubs, where editors look for them.

`python tests/stubs.py` writes `twintac/_twintac.pyi` anew from the installed package. A test checks
that it is up to date.
"""

import ast
import inspect
from pathlib import Path
from types import WrapperDescriptorType

from twintac import _twintac

STUBS = Path(__file__).parents[1] / "twintac/_twintac.pyi"


def documented(stubs: str) -> str:
    """The stubs, with the library's docstring of each class, function and property."""
    lines = stubs.splitlines()
    for node in reversed(ast.parse(stubs).body):
        if isinstance(node, ast.ClassDef):
            for member in reversed(node.body):
                if isinstance(member, ast.FunctionDef):
                    _put(lines, member, _doc(getattr(_twintac, node.name), member.name))
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            _put(lines, node, _doc(_twintac, node.name))
    return "\n".join(lines) + "\n"


def _doc(owner: object, name: str) -> str:
    """The docstring of an object of the library; empty for methods of Python, such as `__len__`,
    whose docstring does not describe this library.
    """
    found = inspect.getattr_static(owner, name)
    is_pythons = name == "__new__" or isinstance(found, WrapperDescriptorType)
    return "" if is_pythons else inspect.getdoc(getattr(owner, name)) or ""


def _put(lines: list[str], node: ast.ClassDef | ast.FunctionDef, doc: str) -> None:
    """Inserts a docstring under the heading of a class or function. It replaces the docstring or
    the `...` there.
    """
    if not doc:
        return
    body = node.body[0]
    quoted = f'"""{doc}\n"""' if "\n" in doc else f'"""{doc}"""'
    indent = " " * (node.col_offset + 4)
    text = [indent + line if line else "" for line in quoted.splitlines()]
    if isinstance(body, ast.Expr):
        heading = lines[body.lineno - 1][: body.col_offset].rstrip()
        lines[body.lineno - 1 : body.end_lineno] = [heading, *text] if heading else text
    else:
        decorators = body.decorator_list if isinstance(body, ast.FunctionDef) else []
        first = min([body.lineno, *(decorator.lineno for decorator in decorators)]) - 1
        lines[first:first] = text


if __name__ == "__main__":
    STUBS.write_text(documented(STUBS.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
