"""Tables are replaced and removed in every form of TOML; everything else stays, byte by byte."""

from __future__ import annotations

import tomllib

import pytest

import phea
from phea.control._text import removed, replaced

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

LAW = ["numerator", "denominator", "gain", "zeros", "poles", "domain", "elements"]
NEW = [("gain", "2"), ("poles", "[0]")]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            'a = "[controller]"\n[controller]  # G\n# the old law\nnumerator = "s"  # old\n# why\n'
            "delay = \"1 ms\"\ndenominator = '''\ns'''\n\n[x]\ngain = 1\n",
            'a = "[controller]"\n[controller]\ngain = 2\npoles = [0]\n# why\n'
            'delay = "1 ms"\n\n[x]\ngain = 1\n',
        ),
        (
            '[controller]\nelements = [\n  { kind = "gain", value = 1 }, # ]\n]\ndelay = 1\n',
            "[controller]\ngain = 2\npoles = [0]\ndelay = 1\n",
        ),
        (
            "[controller]\ndelay = 1\n[[controller.elements]]\nvalue = 1\n"
            '[[controller . "elements"]]\nkind = "integrator"\n[x]\nelements = 1\n',
            "[controller]\ngain = 2\npoles = [0]\ndelay = 1\n[x]\nelements = 1\n",
        ),
        (
            'controller.numerator = "1"\ncontroller.delay = 1\n[x]\n',
            "controller.gain = 2\ncontroller.poles = [0]\ncontroller.delay = 1\n[x]\n",
        ),
        (
            'controller = { numerator = "1, 2", delay = 1, zeros = [1, [2, 3]] } # c\n[x]\n',
            "controller = { gain = 2, poles = [0], delay = 1 }\n[x]\n",
        ),
        ("[x]\ny = 1", "[x]\ny = 1\n\n[controller]\ngain = 2\npoles = [0]\n"),
        ("[x]\r\ny = 1\r\n", "[x]\r\ny = 1\r\n\r\n[controller]\r\ngain = 2\r\npoles = [0]\r\n"),
        (
            '\ufeff[controller] # sampled\ndelay = "a # b"\n',
            '\ufeff[controller] # sampled\ngain = 2\npoles = [0]\ndelay = "a # b"\n',
        ),
        (
            "[controller.q]\ngain = 1\n",
            "[controller.q]\ngain = 1\n\n[controller]\ngain = 2\npoles = [0]\n",
        ),
    ],
)
def test_a_table_is_replaced_in_every_form_of_toml(text: str, expected: str) -> None:
    assert replaced(text, "controller", LAW, NEW) == expected


@pytest.mark.parametrize("name", phea.examples())
def test_removal_leaves_the_other_tables_of_every_example(name: str) -> None:
    text = phea.example(name).text
    tables = tomllib.loads(text)
    for table in tables:
        found = removed(text, [table])
        assert tomllib.loads(found) == {one: value for one, value in tables.items() if one != table}
