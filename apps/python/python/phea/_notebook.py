"""Answers and projects in a notebook: tables, and figures as images.

A display has no script, no address but its own data, no identifier, and at most `LIMIT` bytes. Its
text has the colour of the notebook, and a figure has a light ground of its own: both are legible
in light and in dark.
"""

from __future__ import annotations

import base64
import html as markup
import re
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from phea._project import Project
    from phea._record import Answer
    from phea._shown import Shown

# Bytes of a display, all of its formats together.
LIMIT = 300_000
# Bytes of one figure as SVG and as PNG, for formats without HTML such as a printed notebook.
_FIGURE_ALONE = LIMIT // 2
# Bytes of the plain text.
_PLAIN = LIMIT // 6

_STYLE = """
div.phea{color:inherit;line-height:1.45;max-width:62rem}
div.phea h3{font-size:1.05em;font-weight:600;margin:1.2em 0 .4em}
div.phea p{margin:.4em 0}
div.phea pre,div.phea code{background:none;color:inherit;
font-family:ui-monospace,Menlo,Consolas,"DejaVu Sans Mono",monospace;font-size:.92em}
div.phea pre{line-height:1.35;margin:.4em 0;overflow-x:auto;padding:0;white-space:pre}
div.phea div.table{overflow-x:auto;margin:.5em 0 1em}
div.phea table{border:none;border-collapse:collapse;color:inherit;font-size:inherit;margin:0;
width:auto}
div.phea tr,div.phea tbody tr:nth-child(odd){background:none}
div.phea th,div.phea td{border:none;border-bottom:1px solid rgba(128,128,128,.35);color:inherit;
max-width:none;padding:.25em .9em .25em 0;text-align:left;vertical-align:top;white-space:normal}
div.phea th{border-bottom-width:2px;font-weight:600;vertical-align:bottom}
div.phea td.number,div.phea th.number{font-variant-numeric:tabular-nums;text-align:right}
div.phea td.number,div.phea .mark{white-space:nowrap}
div.phea .mark{font-weight:600}
div.phea .good .sign{color:#1b9e63}
div.phea .note .sign{color:#b57a00}
div.phea .bad .sign{color:#e0433a}
div.phea .callout{background:rgba(128,128,128,.12);border-left:4px solid #b57a00;margin:.6em 0;
padding:.4em .8em}
div.phea .callout.good-edge{border-left-color:#1b9e63}
div.phea .callout.bad-edge{border-left-color:#e0433a}
div.phea .symbol{display:inline-block;min-width:3.4em}
div.phea .equation{font-family:"STIX Two Math","Cambria Math",Cambria,"DejaVu Serif",serif}
div.phea sub,div.phea sup{line-height:0}
div.phea dl.facts{display:grid;gap:.6em;grid-template-columns:repeat(auto-fit,minmax(14rem,1fr))}
div.phea dl.facts dd{font-weight:600;margin:0}
div.phea div.figures{display:grid;gap:0 1.2em;
grid-template-columns:repeat(auto-fit,minmax(min(28rem,100%),1fr))}
div.phea figure{margin:.6em 0;max-width:46rem}
div.phea figure img{border-radius:4px;box-sizing:border-box;display:block;height:auto;
padding:4px;width:100%}
div.phea figcaption{font-size:.9em;margin-top:.3em}
""".replace("div.phea", "div.phea.phea.phea")  # more specific than the styles of notebooks

# Signs of the marks of the page, which has drawings of them.
_SIGNS = {"good": "\N{CHECK MARK}", "note": "\N{BLACK UP-POINTING TRIANGLE}", "bad": "\N{BALLOT X}"}
_MARK = re.compile(r'<span class="mark (good|note|bad)"><svg [^>]*>.*?</svg>', re.DOTALL)
_PLACED = re.compile(r"<figure>\s*(<svg\b.*?</svg>).*?</figure>", re.DOTALL)
_LABELS = re.compile(r'(?<=") aria-labelledby="[^"]*"|(?<=<title) id="[^"]*"|(?<=<desc) id="[^"]*"')


class _Figure(NamedTuple):
    """Figure as the bytes of one image."""

    name: str
    title: str
    caption: str
    kind: str
    data: bytes

    def html(self) -> str:
        """The figure with its caption."""
        words = f"<b>{markup.escape(self.title)}.</b> {markup.escape(self.caption)}"
        caption = f"<figcaption>{words}</figcaption>" if self.title else ""
        address = f"data:image/{self.kind};base64,{_base64(self.data)}"
        name = markup.escape(self.title or self.name)
        image = f'<img src="{address}" alt="{name}" style="background:#fff">'
        return f"<figure>{image}{caption}</figure>"


Part: TypeAlias = str | _Figure


def html(value: Shown) -> str:
    """Answer or project as HTML: its tables, and its figures as images.

    Parameters
    ----------
    value
        Answer of a command, or a project.

    Returns
    -------
    str
        A fragment of at most `LIMIT` bytes, without script, identifiers and foreign addresses. Of
        figures that do not fit, the smallest are shown, and a sentence names the others.

    Examples
    --------
    >>> import phea
    >>> shown = html(phea.example("ybitu/hose").check())
    >>> "hydraulic" in shown, "<script" in shown, len(shown.encode()) <= LIMIT
    (True, False, True)
    """
    return _html(value, LIMIT)


def mimebundle(
    value: Shown,
    include: Collection[str] | None = None,
    exclude: Collection[str] | None = None,
) -> dict[str, str]:
    """Answer or project in all formats of a notebook.

    Parameters
    ----------
    value
        Answer of a command, or a project.
    include, exclude
        Formats that are wanted or not, as IPython gives them.

    Returns
    -------
    dict of str
        Data by format, together at most `LIMIT` bytes: HTML, plain text with the same tables, and
        of an answer with figures one of them as SVG and as PNG (in base64).

    Examples
    --------
    >>> import phea
    >>> shown = mimebundle(phea.example("ybitu/hose").check())
    >>> sorted(shown), sum(len(part.encode()) for part in shown.values()) <= LIMIT
    (['text/html', 'text/plain'], True)
    """
    from phea._record import Answer

    if isinstance(value, Answer):
        bundle = {"text/plain": _cut(value.text, _PLAIN), **_one_figure(value.figures)}
    else:
        bundle = {"text/plain": repr(value)}
    bundle["text/html"] = _html(value, LIMIT - sum(len(part.encode()) for part in bundle.values()))
    wanted = set(bundle) & set(include) if include else set(bundle)
    return {name: bundle[name] for name in sorted(wanted - set(exclude or ()))}


def _html(value: Shown, limit: int) -> str:
    """The fragment of at most ``limit`` bytes."""
    from phea._project import Project
    from phea._record import Answer

    if isinstance(value, Project):
        return _project(value, limit)
    if not isinstance(value, Answer):
        raise TypeError(f"a project or an answer is shown, not {value!r}")
    drawn = _figures(value.figures)
    named = {figure.title: figure for figure in drawn}
    parts = _parts(_document(value))
    placed = {part.title for part in parts if isinstance(part, _Figure)}
    # in its place, a figure has the smaller of its formats too
    parts = [named.get(part.title, part) if isinstance(part, _Figure) else part for part in parts]
    below: list[Part] = [figure for figure in drawn if figure.title not in placed]
    parts += ['<div class="figures">', *below, "</div>"] if below else []
    if _size(parts) > limit:
        figures: list[Part] = [part for part in parts if isinstance(part, _Figure)]
        parts = [_preformatted(value.text, limit - _size(figures)), *figures]
    return _written(parts, _chosen(parts, limit))


def _document(answer: Answer) -> str:
    """The text of an answer as HTML."""
    document = getattr(answer._native, "html", None)
    if document is None:
        return f"<pre>{markup.escape(answer.text)}</pre>"
    return str(document())


def _project(project: Project, limit: int) -> str:
    """A project: its title, what is set, and its file."""
    path, title = markup.escape(project.path), markup.escape(project.title)
    settings = "".join(f"<li><code>{markup.escape(one)}</code></li>" for one in project.settings)
    above = f"<h3>{title}</h3>" + (f"<p>Settings</p><ul>{settings}</ul>" if settings else "")
    above += f"<details><summary>{path}</summary>"
    text = _preformatted(project.text, limit - _size([above, "</details>"]))
    return _written([above, text, "</details>"])


def _parts(document: str) -> list[Part]:
    """Text and figures of a document in their order, the drawings of its marks as signs."""
    text = _MARK.sub(
        lambda mark: f'<span class="mark {mark[1]}"><span class="sign">{_SIGNS[mark[1]]}</span> ',
        document,
    )
    parts: list[Part] = []
    begin = 0
    for figure in _PLACED.finditer(text):
        parts += [text[begin : figure.start()], _drawing(figure[1])]
        begin = figure.end()
    return [*parts, text[begin:]]


def _figures(files: Mapping[str, bytes]) -> list[_Figure]:
    """Figures among files, each in the smaller of its formats."""
    figures = []
    for name, data in files.items():
        stem, _, end = name.rpartition(".")
        if end != "svg":
            continue
        drawing = _drawing(data.decode())._replace(name=stem)
        picture = files.get(f"{stem}.png")
        if picture is not None and len(picture) < len(drawing.data):
            drawing = drawing._replace(kind="png", data=picture)
        figures.append(drawing)
    return figures


def _drawing(svg: str) -> _Figure:
    """Figure of an SVG: title and caption are among its elements."""
    elements = ("title", "desc")
    found = (re.search(f"<{name}[^>]*>(.*?)</{name}>", svg, re.DOTALL) for name in elements)
    title, caption = (markup.unescape(text[1]) if text else "" for text in found)
    return _Figure(title, title, caption, "svg+xml", svg.encode())


def _one_figure(files: Mapping[str, bytes]) -> dict[str, str]:
    """The first figure that fits as SVG and as PNG, if need be with half of the pixels."""
    for name, data in files.items():
        picture = files.get(name.removesuffix("svg") + "png")
        if not name.endswith(".svg") or picture is None:
            continue
        svg, png = _LABELS.sub("", data.decode()), _base64(picture)
        if len(svg.encode()) + len(png) > _FIGURE_ALONE:
            from phea import _native

            png = _base64(_native.picture_of(data, 1.0))
        if len(svg.encode()) + len(png) <= _FIGURE_ALONE:
            return {"image/svg+xml": svg, "image/png": png}
    return {}


def _chosen(parts: Sequence[Part], limit: int) -> set[Part]:
    """Figures that fit, the smallest first."""
    figures = [part for part in parts if isinstance(part, _Figure)]
    # with every figure omitted the sentence on them is longest
    room = limit - _size(parts)
    chosen: set[Part] = set()
    for figure in sorted(figures, key=lambda figure: len(figure.html())):
        room -= len(figure.html().encode())
        if room < 0:
            break
        chosen.add(figure)
    return chosen


def _size(parts: Sequence[Part]) -> int:
    """Bytes of a fragment without its figures."""
    return len(_written(parts).encode())


def _written(parts: Sequence[Part], chosen: Collection[Part] = ()) -> str:
    """The fragment with some of its figures, and a sentence on the others."""
    body, omitted = [], []
    for part in parts:
        if isinstance(part, str):
            body.append(part)
        elif part in chosen:
            body.append(part.html())
        else:
            omitted.append(f"<code>{markup.escape(part.name)}</code>")
    if omitted:
        reason = f"since a display has at most {LIMIT // 1000} kB"
        body.append(f"<p>Figures omitted, {reason}: {', '.join(omitted)}.</p>")
    return f'<div class="phea"><style>{_STYLE}</style>{"".join(body)}</div>'


def _preformatted(text: str, room: int) -> str:
    """Text in columns, without the lines that do not fit into so many bytes."""
    return f"<pre>{_cut(markup.escape(text), room - len('<pre></pre>'))}</pre>"


def _cut(text: str, room: int) -> str:
    """The first lines of a text, as many as fit into so many bytes."""
    data = text.encode()
    if len(data) <= room:
        return text
    end = "... (cut: the whole text is in `text`)\n"
    whole = data[: max(room - len(end), 0)].decode(errors="ignore")
    return whole[: whole.rfind("\n") + 1] + end


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
