"""Tests that the stubs have the docstrings of the compiled library, which editors show."""

from inspect import getdoc, isclass
from types import WrapperDescriptorType

from stubs import STUBS, documented

from twintac import _twintac


def test_stubs_have_the_doc_strings_of_the_library() -> None:
    stubs = STUBS.read_text(encoding="utf-8")
    assert documented(stubs) == stubs, "run python/tests/stubs.py"


def test_everything_public_has_a_doc_string() -> None:
    for name in _twintac.__all__:
        owner = getattr(_twintac, name)
        assert getdoc(owner), name
        members = vars(owner).items() if isclass(owner) else ()
        for member, value in members:
            is_pythons = isinstance(value, WrapperDescriptorType) or member in ("__new__", "__doc__", "__module__", "__hash__")
            assert is_pythons or getdoc(value), f"{name}.{member}"
