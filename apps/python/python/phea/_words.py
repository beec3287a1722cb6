"""Messages of the command in the words of Python: options as arguments."""

from __future__ import annotations

# Options whose arguments have other names or values in Python.
_ARGUMENTS = {
    "no-repair": "repair=False",
    "no-figures": "figures=False",
    "table": "format",
    "certificate": "prove",
}


def python_words(text: str) -> str:
    """A message with the arguments of Python in place of the options of the command.

    Examples
    --------
    >>> python_words("--gain 3 m: expected a gain in V/N")
    'gain 3 m: expected a gain in V/N'
    >>> python_words('`--set identify.use="nothing"` keeps it; `--on-machine` tries more')
    "`set({'identify.use': 'nothing'})` keeps it; `on_machine=True` tries more"
    """
    if "--" not in text:
        return text
    import re

    # settings: as the place of an error, as a whole text, and quoted in a sentence
    text = text.replace("--> --pass ", "--> ").removeprefix("--pass ")
    text = re.sub(r"(?m)^( *--> |)--set ([^=\n]+)=(.*?)((?::\d+:\d+)?)$", _of_setting, text)
    text = re.sub(r"(`)--set ([^=`]+)=([^`]*)(`)", _of_setting, text)
    # options: with a value or as a flag in quotes, and at the beginning of a message or a place
    text = re.sub(r"`--([a-z][a-z-]*) ([^`]+)`", lambda m: f'`{_argument(m[1])}="{m[2]}"`', text)
    text = re.sub(r"`--([a-z][a-z-]*)`", lambda m: f"`{_flag(m[1])}`", text)
    return re.sub(r"(?m)^( *--> |)--([a-z][a-z-]*)", lambda m: m[1] + _argument(m[2]), text)


def _of_setting(found: object) -> str:
    import re

    assert isinstance(found, re.Match)
    before, path, value, after = found.groups()
    if value[:1] == value[-1:] == '"' and len(value) > 1:
        value = value[1:-1]
    try:
        float(value)
        written = value
    except ValueError:
        written = repr(value)
    return f"{before}set({{{path!r}: {written}}}){after}"


def _argument(option: str) -> str:
    return _ARGUMENTS.get(option, option.replace("-", "_"))


def _flag(option: str) -> str:
    argument = _argument(option)
    return argument if "=" in argument else f"{argument}=True"
