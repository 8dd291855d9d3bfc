"""Import of packages that only some users need."""

from importlib import import_module
from typing import Any


def need(module: str, extra: str) -> Any:
    """Import a module of an optional package. Raises ImportError with the extra that installs it."""
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f"{package} is missing: pip install 'corner-impact[{extra}]'", name=package) from error
