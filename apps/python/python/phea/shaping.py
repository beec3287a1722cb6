"""Shaping by hand as values: elements, changes, and the margins after each of them."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, ClassVar, TypeAlias

if TYPE_CHECKING:
    from phea._project import Project
    from phea.answers import ShapeAnswer, ShapedElementAnswer

Quantity: TypeAlias = str | float


def _number(value: Quantity) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(float(value))


@dataclass(frozen=True)
class Element:
    """Element of a controller or prefilter; its fields are the keys of the project file.

    A frequency is in rad/s where no unit is given, a time in s.
    """

    kind: ClassVar[str]

    def toml(self) -> str:
        """The element as it is written in a project file.

        Examples
        --------
        >>> Lead(5, 50).toml()
        '{ kind = "lead", zero_frequency = 5.0, pole_frequency = 50.0 }'
        """
        named = ((field.name, getattr(self, field.name)) for field in fields(self))
        given = [f"{name} = {_number(value)}" for name, value in named if value is not None]
        return "{ " + ", ".join([f'kind = "{self.kind}"', *given]) + " }"


@dataclass(frozen=True)
class Gain(Element):
    """The gain ``value``."""

    kind = "gain"
    value: Quantity


@dataclass(frozen=True)
class Integrator(Element):
    """1/s."""

    kind = "integrator"


@dataclass(frozen=True)
class Differentiator(Element):
    """s."""

    kind = "differentiator"


@dataclass(frozen=True)
class Zero(Element):
    """1 + s/w with ``frequency`` w."""

    kind = "zero"
    frequency: Quantity


@dataclass(frozen=True)
class Pole(Element):
    """1/(1 + s/w) with ``frequency`` w."""

    kind = "pole"
    frequency: Quantity


@dataclass(frozen=True)
class ComplexZeros(Element):
    """1 + 2 zeta s/w + s^2/w^2."""

    kind = "complex_zeros"
    frequency: Quantity
    damping_ratio: float


@dataclass(frozen=True)
class ComplexPoles(Element):
    """1/(1 + 2 zeta s/w + s^2/w^2)."""

    kind = "complex_poles"
    frequency: Quantity
    damping_ratio: float


@dataclass(frozen=True)
class Lead(Element):
    """(1 + s/z)/(1 + s/p) with the zero z below the pole p."""

    kind = "lead"
    zero_frequency: Quantity
    pole_frequency: Quantity


@dataclass(frozen=True)
class Lag(Element):
    """(1 + s/z)/(1 + s/p) with the zero z above the pole p."""

    kind = "lag"
    zero_frequency: Quantity
    pole_frequency: Quantity


@dataclass(frozen=True)
class Notch(Element):
    """(s^2 + 2 zeta_z w s + w^2)/(s^2 + 2 zeta_p w s + w^2); zeta_z is the numerator's."""

    kind = "notch"
    frequency: Quantity
    damping_ratio: float
    numerator_damping_ratio: float


@dataclass(frozen=True)
class RollOff(Element):
    """1/(1 + 2 zeta s/w + s^2/w^2) above the bandwidth of the loop."""

    kind = "roll_off"
    frequency: Quantity
    damping_ratio: float | None = None


@dataclass(frozen=True)
class ProportionalIntegral(Element):
    """K_p + K_i/s."""

    kind = "pi"
    proportional_gain: Quantity
    integral_gain: Quantity


@dataclass(frozen=True)
class ProportionalIntegralDerivative(Element):
    """K_p + K_i/s + K_d s/(1 + T_f s)."""

    kind = "pid"
    proportional_gain: Quantity
    integral_gain: Quantity
    derivative_gain: Quantity
    filter_time: Quantity


@dataclass(frozen=True)
class Shaping:
    """Controller or prefilter that is changed element by element.

    Each change returns another value; elements are numbered from 1, in the list as changed so far.
    A change that is not possible raises `phea.ProjectError` or `phea.NoAnswer`.

    Examples
    --------
    >>> import phea
    >>> loop = phea.example("qft/servo").shaping()
    >>> changed = loop.add(phea.Lead(5, 50))
    >>> len(changed.elements) - len(loop.elements), changed.undo() == loop
    (1, True)
    """

    project: Project
    prefilter: bool = False
    changes: tuple[tuple[str, str], ...] = ()

    @property
    def answer(self) -> ShapeAnswer:
        """Elements and margins after the changes: the answer of `phea shape`."""
        return _answer(self)

    @property
    def elements(self) -> tuple[ShapedElementAnswer, ...]:
        """The elements after the changes, in order."""
        return tuple(self.answer.elements)

    def _and(self, option: str, text: str) -> Shaping:
        changed = Shaping(self.project, self.prefilter, (*self.changes, (option, text)))
        _ = changed.answer  # a change that is not possible is an error now
        return changed

    def add(self, element: Element) -> Shaping:
        """Adds an element at the end."""
        return self._and("add", _text(element))

    def remove(self, number: int) -> Shaping:
        """Removes an element."""
        return self._and("remove", str(number))

    def replace(self, number: int, element: Element) -> Shaping:
        """Puts another element in place of one."""
        return self._and("replace", f"{number}={_text(element)}")

    def enable(self, number: int) -> Shaping:
        """Lets an element act."""
        return self._and("enable", str(number))

    def disable(self, number: int) -> Shaping:
        """Keeps an element without letting it act."""
        return self._and("disable", str(number))

    def move(self, number: int, to: int) -> Shaping:
        """Moves an element to another place."""
        return self._and("move", f"{number}={to}")

    def through(
        self,
        kind: str,
        *,
        at: Quantity,
        db: float | None = None,
        deg: float | None = None,
        number: int | None = None,
        **fixed: Quantity,
    ) -> Shaping:
        """Adds an element that is solved so that the loop passes a point of the chart.

        Parameters
        ----------
        kind
            Kind of the element, such as ``"lead"``.
        at
            Frequency of the point, rad/s where no unit is given.
        db, deg
            Magnitude in dB and phase in degrees of the point; one may be free.
        number
            Element in whose place it is put.
        fixed
            Values of the element that are given, such as ``damping_ratio=0.5``.
        """
        if db is None and deg is None:
            raise TypeError("through() needs a point: db, deg, or both")
        place = f"{number}=" if number is not None else ""
        given = "".join(f" with {name} {value}" for name, value in fixed.items())
        point = [f"{value} {unit}" for value, unit in ((db, "dB"), (deg, "deg")) if value is not None]
        frequency = at if isinstance(at, str) else f"{at} rad/s"
        return self._and("pass", f"{place}{kind}{given} through {', '.join(point)} at {frequency}")

    def undo(self) -> Shaping:
        """The value before the last change."""
        if not self.changes:
            raise IndexError("there is no change to undo")
        return Shaping(self.project, self.prefilter, self.changes[:-1])

    def save(self) -> Project:
        """The project with the changed elements; everything else of its text stays, byte for byte.

        Settings of the project stay settings.
        """
        return self.project.with_laws_of(self.answer.files["shaped.toml"])


def _text(element: Element) -> str:
    if not isinstance(element, Element):
        raise TypeError(f"an element such as phea.Lead(5, 50) is needed, not {element!r}")
    return element.toml()


def _answer(shaping: Shaping) -> ShapeAnswer:
    from phea.answers import ShapeAnswer, ShapedElementAnswer

    options = {"prefilter": shaping.prefilter, "changes": list(shaping.changes)}
    return shaping.project._ask(ShapeAnswer, "shape", options, False)
