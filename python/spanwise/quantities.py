"""The responses there are: what each is called, its unit and signs, and how it is shown.

Attributes of runs, checks of arguments, heads of files, rows of summaries and axes of figures all
follow from these rows. A response that the core learns is one more row here, and nothing else.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias, TypeVar

from spanwise._checks import named
from spanwise._keys import alike

T = TypeVar("T")
Axis: TypeAlias = Literal["section", "support", "clamp", "axle"]
Sense: TypeAlias = Literal["positive", "negative", "either"]
Side: TypeAlias = Literal["max", "min"]

#: Units of tables and figures, and how many of them there are to one in SI.
SHOWN: Final = {"m": ("mm", 1e3), "rad": ("mrad", 1e3), "N m": ("kN m", 1e-3), "N": ("kN", 1e-3)}


@dataclass(frozen=True)
class Factor:
    """An impact factor: the largest dynamic value of one sense by the largest static one.

    Attributes
    ----------
    name : str
        Of the attribute that has it.
    sense : {"positive", "negative", "either"}
        Whether of positive values, of negative ones, or of the larger magnitude.
    title : str
        In figures.
    """

    name: str
    sense: Sense
    title: str

    @property
    def noun(self) -> str:
        """The name of one."""
        return _one(self.name)


@dataclass(frozen=True)
class Response:
    """One row: a response of the bridge, or the load of an axle.

    Attributes
    ----------
    name : str
        Of the attribute that has it, as in files and for the core.
    unit : str
        In SI.
    axis : {"section", "support", "clamp", "axle"}
        There is a value for each of these.
    signs : pair of str
        What positive and negative values are called; empty if nothing in particular.
    title : str
        In figures, with the direction in which it is drawn.
    downward : bool
        Whether figures draw positive values downward.
    sided : bool
        Whether the left and the right of a section differ.
    influence : bool
        Whether there are influence lines of it.
    reported : tuple of {"positive", "negative", "either"}
        The extremes that summaries show always; others only where they are worth it.
    factors : tuple of Factor
        Impact factors that there are of it.
    usual : bool
        Whether ensembles look at it unless told what to look at.
    also : tuple of str
        Other names, which arguments may have.
    """

    name: str
    unit: str
    axis: Axis
    signs: tuple[str, str]
    title: str
    downward: bool = False
    sided: bool = False
    influence: bool = True
    reported: tuple[Sense, ...] = ("either",)
    factors: tuple[Factor, ...] = ()
    usual: bool = True
    also: tuple[str, ...] = ()

    @property
    def noun(self) -> str:
        """The name of one."""
        return _one(self.name)

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of what the core has of it: left and right of the sections, or itself."""
        return (f"{self.name}_left", f"{self.name}_right") if self.sided else (self.name,)

    @property
    def lines(self) -> tuple[str, ...]:
        """Names of its influence lines."""
        parts = self.parts if self.influence else ()
        return tuple(_one(each).replace(" ", "-") for each in parts)

    @property
    def shown(self) -> tuple[str, float]:
        """Unit in tables and figures, and how many of them there are to one in SI."""
        return SHOWN.get(self.unit, (self.unit, 1.0))

    def label(self, side: str = "", per: str = "") -> str:
        """What is written on an axis: title, side or load, and unit."""
        lines = [f"{self.title}{side and f' on the {side}'}", *filter(None, [per])]
        return f"{(',' + chr(10)).join(lines)} [{self.shown[0]}]"

    def called(self, sense: Sense) -> str:
        """Its values of one sense in words: ``moment, sagging``."""
        sign = {"positive": self.signs[0], "negative": self.signs[1]}.get(sense)
        return f"{self.noun}, {sign}" if sign else self.noun


def _one(name: str) -> str:
    """A name in words, in the singular."""
    return name.replace("_", " ").removesuffix("s")


_ROWS: Final = (
    Response(
        "deflection",
        unit="m",
        axis="section",
        signs=("down", "up"),
        title="Deflection, down",
        downward=True,
        reported=("positive",),
        factors=(Factor("deflection", "positive", "Deflection"),),
    ),
    Response(
        "moment",
        unit="N m",
        axis="section",
        signs=("sagging", "hogging"),
        title="Bending moment,\nsagging drawn down",
        downward=True,
        reported=("positive", "negative"),
        factors=(
            Factor("sagging", "positive", "Sagging moment"),
            Factor("hogging", "negative", "Hogging moment"),
        ),
    ),
    Response(
        "shear",
        unit="N",
        axis="section",
        signs=("positive", "negative"),
        title="Shear force",
        sided=True,
        factors=(Factor("shear", "either", "Shear force"),),
    ),
    Response(
        "reactions",
        unit="N",
        axis="support",
        signs=("up", "uplift"),
        title="Reaction, up",
        reported=("positive",),
        factors=(Factor("reactions", "either", "Reaction"),),
    ),
    Response(
        "clamp_moments",
        unit="N m",
        axis="clamp",
        signs=("positive", "negative"),
        title="Clamp moment,\nsagging drawn down",
        downward=True,
    ),
    Response(
        "slope",
        unit="rad",
        axis="section",
        signs=("down to the right", "up to the right"),
        title="Slope of the deflection",
        usual=False,
        also=("rotation",),
    ),
    Response(
        "velocity",
        unit="m/s",
        axis="section",
        signs=("down", "up"),
        title="Deck velocity, down",
        downward=True,
        influence=False,
        usual=False,
    ),
    Response(
        "acceleration",
        unit="m/s2",
        axis="section",
        signs=("down", "up"),
        title="Deck acceleration, down",
        downward=True,
        influence=False,
        usual=False,
    ),
    Response(
        "axle_loads",
        unit="N",
        axis="axle",
        signs=("", ""),
        title="Axle load",
        reported=("positive",),
        factors=(Factor("axle_loads", "positive", "Axle load"),),
    ),
)

#: All by name, in the order of the core.
RESPONSES: Final = {each.name: each for each in _ROWS}


def of_bridges() -> list[Response]:
    """Those of the bridge itself: all but axle loads."""
    return [each for each in RESPONSES.values() if each.axis != "axle"]


def factors() -> dict[str, tuple[Response, Factor]]:
    """All impact factors by name, with what they are factors of."""
    return {each.name: (of, each) for of in RESPONSES.values() for each in of.factors}


def parts(*, whole: bool = False) -> dict[str, Response]:
    """Names of what there is a value of: each side by itself, beside both together if `whole`."""
    found: dict[str, Response] = {}
    for each in RESPONSES.values():
        names = (each.name, *each.parts) if whole else each.parts
        found |= dict.fromkeys(names, each)
    return found


def influence_lines() -> dict[str, Response]:
    """Influence lines by name."""
    return {name: each for each in of_bridges() for name in each.lines}


def response(quantity: str) -> Response:
    """The response that is meant, with hyphens or underscores, in singular or plural."""
    return RESPONSES[asked("quantity", quantity, RESPONSES)]


def asked(key: str, quantity: object, options: Iterable[str]) -> str:
    """The one of several responses that is meant, under another name of it too."""
    others = {name: each.name for each in RESPONSES.values() for name in each.also}
    known = [*options]
    meant = alike(quantity, [*known, *others])
    if isinstance(meant, str) and meant not in known:
        meant = others.get(meant, meant)
    return str(named(key, meant, known))


def there_are(missing: Sequence[str], *, clamps: bool) -> list[Response]:
    """Those of a bridge that was given without some lines, and may have clamps."""
    known = [each for each in of_bridges() if not any(line in missing for line in each.lines)]
    return [each for each in known if clamps or each.axis != "clamp"]


def telling(target: T) -> T:
    """Let a docstring name them all where it says ``{responses}``, ``{parts}`` or ``{factors}``."""
    units = {
        "responses": {each.name: f" [{each.unit}]" for each in RESPONSES.values()},
        "bridge": {each.name: f" [{each.unit}]" for each in of_bridges()},
        "parts": {name: f" [{each.unit}]" for name, each in parts(whole=True).items()},
        "factors": dict.fromkeys(factors(), ""),
    }

    def filled(found: re.Match[str]) -> str:
        text = ", ".join(f'``"{name}"``{unit}' for name, unit in units[found[2]].items()) + "."
        return textwrap.fill(text, 100, initial_indent=found[1], subsequent_indent=found[1])

    target.__doc__ = re.sub(r"^( *)\{(\w+)\}$", filled, target.__doc__ or "", flags=re.MULTILINE)
    return target
