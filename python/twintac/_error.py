"""What can go wrong."""


class Error(ValueError):
    """What is wrong, where, and what to do."""

    file: str | None
    """The file, as it was named."""
    line: int | None
    """Line, from 1."""
    field: str | None
    """The field, the column or the argument."""

    def __init__(
        self, text: str, file: str | None = None, line: int | None = None, field: str | None = None
    ) -> None:
        super().__init__(text)
        self.file = file
        self.line = line
        self.field = field
