"""The exception of the package."""


class Error(ValueError):
    """An error in a file or an argument. The message says what is wrong, where, and what to do."""

    file: str | None
    """The file, as the caller named it; `None` if the error is not about a file."""
    line: int | None
    """The line of the file, from 1."""
    field: str | None
    """The field, the column or the argument."""

    def __init__(
        self, text: str, file: str | None = None, line: int | None = None, field: str | None = None
    ) -> None:
        super().__init__(text)
        self.file = file
        self.line = line
        self.field = field
