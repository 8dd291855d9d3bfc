"""What can go wrong."""


class ModelError(ValueError):
    """A complaint about a model: where, what was found, what would be allowed.

    `file` is the file, or what stands in its place; `line` counts from 1, and is None where there is no file or the complaint is
    about no line of it; `field` is the dotted path of the field, or None.
    """

    __module__ = "corner_impact"

    file: str
    line: int | None
    field: str | None

    def __init__(self, message: str, file: str = "", line: int | None = None, field: str | None = None) -> None:
        super().__init__(message)
        self.file, self.line, self.field = file, line, field
