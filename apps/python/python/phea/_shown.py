"""Display of a value in a notebook."""

from __future__ import annotations

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any


class Shown:
    """Value that a notebook shows with its tables and figures."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        from phea._notebook import html

        return html(self)

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        from phea._notebook import mimebundle

        return mimebundle(self, include, exclude)
