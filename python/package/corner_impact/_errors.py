"""Errors of the package."""


class ModelError(ValueError):
    """Error in a model: its place, what was found, and what is allowed.

    `file` is the file, or the name that stands for it. `line` counts from 1; it is None without a file, or if the error belongs to no
    line. `field` is the dotted path of the field, or None.
    """

    __module__ = "corner_impact"

    file: str
    line: int | None
    field: str | None

    def __init__(self, message: str, file: str = "", line: int | None = None, field: str | None = None) -> None:
        super().__init__(message)
        self.file, self.line, self.field = file, line, field
