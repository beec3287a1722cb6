"""A notebook shows every kind of answer: tables, and figures as images that never collide."""

from __future__ import annotations

import base64
import re
from html.parser import HTMLParser
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

import phea
from phea import _notebook
from phea._record import Answer

# What a user evaluates in a cell, by the kind of the answer; one kind twice, as users do.
CELLS = {
    "project": "hose",
    "changed project": 'hose.set({"line.length": "2 m"})',
    "check": "hose.check()",
    "size": "hose.size()",
    "linearize": "hose.linearize()",
    "sweep": 'hose.linearize(sweep="line.length=0.5 m..2 m", points=3)',
    "verify": "hose.verify()",
    "shape": 'phea.example("qft/by_hand").shaping().answer',
    "design": "servo.design()",
    "simulate": "hose.simulate()",
    "simulate again": "hose.simulate()",
    "campaign": "campaign.campaign(runs=6)",
    "run of a campaign": "campaign.campaign_run(1)",
    "bench": "hose.bench()",
    "report": "servo.report(files=True)",
}
WITH_FIGURES = ["size", "linearize", "verify", "design", "simulate", "campaign", "report"]

FIRST = """
import warnings
import phea
warnings.simplefilter("ignore")
hose, servo = phea.example("ybitu/hose"), phea.example("qft/servo")
campaign = phea.example("benchmark/campaign")
"""


class Elements(HTMLParser):
    """Elements of a page, their attributes, and the text that a reader sees."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.names: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.text = ""
        self._hidden = False
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.names.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]
        self._hidden = tag == "style"
        # a reader sees a gap before what is not part of a line
        self.text += "" if tag in {"b", "code", "em", "span", "sub", "sup"} else " "

    def handle_endtag(self, tag: str) -> None:
        self._hidden = False

    def handle_data(self, data: str) -> None:
        self.text += "" if self._hidden else data

    def values(self, *names: str) -> list[str]:
        """Values of the attributes of these names."""
        return [value for name, value in self.attributes if name in names]


def pictures(page: str) -> list[str]:
    """The drawings of a page, as SVG."""
    addresses = Elements(page).values("src")
    svg = "data:image/svg+xml;base64,"
    return [base64.b64decode(one[len(svg) :]).decode() for one in addresses if one.startswith(svg)]


@pytest.fixture(scope="module")
def shown() -> dict[str, dict[str, str]]:
    """What a notebook shows, by cell and format."""
    notebook = nbformat.v4.new_notebook()  # type: ignore[no-untyped-call]
    for text in (FIRST, *CELLS.values()):
        cell = nbformat.v4.new_code_cell(text)  # type: ignore[no-untyped-call]
        notebook.cells.append(cell)
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    found = {}
    for name, cell in zip(CELLS, notebook.cells[1:], strict=True):
        (output,) = (one for one in cell.outputs if one.output_type == "execute_result")
        found[name] = dict(output.data)
    return found


def assert_harmless(page: str) -> None:
    """No script, nothing fetched, no drawing inside the page."""
    elements = Elements(page)
    assert not {"script", "svg", "iframe", "object", "embed", "link", "base"} & set(elements.names)
    assert not [name for name, _ in elements.attributes if name.startswith("on")]
    addresses = elements.values("src", "href", "srcset", "data", "action", "poster", "xlink:href")
    assert all(one.startswith("data:image/") for one in addresses)
    assert "url(" not in page.lower() and "@import" not in page.lower()
    for picture in pictures(page):
        inside = Elements(picture)
        assert inside.names[0] == "svg" and "script" not in inside.names
        assert not inside.values("href", "xlink:href", "src") and "url(" not in picture


@pytest.mark.parametrize("name", CELLS)
def test_every_display_is_small_and_harmless(shown: dict[str, dict[str, str]], name: str) -> None:
    formats = shown[name]
    assert sum(len(part.encode()) for part in formats.values()) <= 300_000
    assert_harmless(formats["text/html"])


def test_no_two_equal_identifiers(shown: dict[str, dict[str, str]]) -> None:
    formats = [one for display in shown.values() for one in display.items()]
    pages = [page for name, page in formats if name != "image/png"]
    identifiers = [one for page in pages for one in Elements(page).values("id")]
    assert len(set(identifiers)) == len(identifiers)
    # what an identifier would be referred to by
    assert not [one for page in pages for one in Elements(page).values("aria-labelledby", "for")]


@pytest.mark.parametrize("name", [name for name in CELLS if "project" not in name])
def test_text_and_page_have_the_same_words(shown: dict[str, dict[str, str]], name: str) -> None:
    text, page = shown[name]["text/plain"], Elements(shown[name]["text/html"]).text
    words = set(re.findall(r"[A-Za-z]{4,}", text)) - {"warning", "event"}
    assert len(words) > 3
    # a page prints the equations of `check` with subscripts
    assert name == "check" or not words - set(re.findall(r"[A-Za-z]{4,}", page))
    numbers = set(re.findall(r"(?<![\w.])\d+\.\d+(?![\w.])", text))
    assert not {one for one in numbers if one not in page}


@pytest.mark.parametrize("name", WITH_FIGURES)
def test_figures_are_images_with_title_and_caption(
    shown: dict[str, dict[str, str]], name: str
) -> None:
    formats = shown[name]
    elements = Elements(formats["text/html"])
    assert elements.names.count("figure") == elements.names.count("img") > 1
    titles = elements.values("alt")
    assert all(titles) and len(titles) == elements.names.count("img")
    assert all(title in elements.text for title in titles)
    assert all("#fff" in style for style in elements.values("style"))
    assert base64.b64decode(formats["image/png"]).startswith(b"\x89PNG")
    assert Elements(formats["image/svg+xml"]).names[:2] == ["svg", "title"]


@pytest.mark.parametrize("name", ["check", "shape", "bench"])
def test_an_answer_without_figures_has_no_image(
    shown: dict[str, dict[str, str]], name: str
) -> None:
    formats = shown[name]
    assert "image/png" not in formats and "image/svg+xml" not in formats
    assert "img" not in Elements(formats["text/html"]).names


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
def test_a_project_shows_its_file_and_settings(shown: dict[str, dict[str, str]]) -> None:
    changed = Elements(shown["changed project"]["text/html"]).text
    rig = phea.example("ybitu/hose")
    assert rig.title in changed and rig.text in changed and "line.length=2 m" in changed


def drawn(title: str, size: int, caption: str = "A line.") -> bytes:
    """SVG of about so many bytes."""
    path = "M0 0" + "L1 1" * (size // 4)
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 2 2" aria-labelledby="a-title">'
        f'<title id="a-title">{title}</title><desc id="a-description">{caption}</desc>'
        f'<path d="{path}"/></svg>'
    ).encode()


def answer(text: str, files: dict[str, bytes], native: Any = None) -> Answer:
    """An answer with this text and these files."""
    return Answer(("{}", text, True), files, native)


def test_the_smallest_figures_are_shown_and_the_others_named() -> None:
    sizes = {"first": 150_000, "second": 20_000, "third": 100_000, "fourth": 1_000}
    files = {f"{name}.svg": drawn(name, size) for name, size in sizes.items()}
    page = _notebook.html(answer("a table", files))
    assert Elements(page).values("alt") == ["second", "third", "fourth"]
    assert "omitted" in Elements(page).text and "<code>first</code>" in page
    assert "<code>second</code>" not in page and len(page.encode()) <= _notebook.LIMIT


@pytest.mark.parametrize("count", [1, 30])
@pytest.mark.parametrize("size", [40, 7_000, 200_000])
@pytest.mark.parametrize("lines", [1, 3_000, 100_000])
@pytest.mark.parametrize("letters", ["abc ", "<&>\"", "Ωβ"])
def test_no_display_is_larger_than_allowed(lines: int, letters: str, size: int, count: int) -> None:
    files = {f"{index}.svg": drawn(f"figure {index}", size) for index in range(count)}
    files |= {f"{index}.png": b"\x89PNG" + bytes(size // 2) for index in range(count)}
    many = answer("\n".join([letters * 10] * lines) + "\n", files)
    assert len(_notebook.html(many).encode()) <= _notebook.LIMIT
    bundle = _notebook.mimebundle(many)
    assert sum(len(part.encode()) for part in bundle.values()) <= _notebook.LIMIT
    assert letters * 10 in bundle["text/plain"]
    assert letters * 10 in Elements(bundle["text/html"]).text


def test_words_of_a_project_are_no_markup() -> None:
    evil = '"><script>alert(1)</script><img src=http://x/>'
    caption = evil.replace("<", "&lt;").replace(">", "&gt;")
    page = _notebook.html(answer(evil, {f"{evil}.svg": drawn(caption, 40, caption)}))
    assert_harmless(page)
    assert Elements(page).text.count(evil) == 3
    text = phea.example("qft/servo").text.replace('title = "', 'title = "<script>x</script> ')
    assert_harmless(_notebook.html(phea.loads(text)))


def test_a_document_is_shown_with_its_figures_in_their_places() -> None:
    class Native:
        def html(self) -> str:
            mark = '<svg viewBox="0 0 16 16" aria-hidden="true"><path d="M1"></path></svg>'
            figure = drawn("Bode &amp; co", 40).decode()
            return (
                f'<h3>Verdict</h3><span class="mark bad">{mark}violated</span>'
                f"<figure>{figure}<figcaption><b>Bode</b></figcaption></figure><p>after</p>"
            )

    page = _notebook.html(answer("text", {"bode.svg": drawn("Bode &amp; co", 40)}, Native()))
    assert_harmless(page)
    elements = Elements(page)
    assert elements.values("alt") == ["Bode & co"]
    assert elements.text.split()[:4] == ["Verdict\N{BALLOT X}", "violated", "Bode", "&"]
    assert elements.text.endswith("after")
    assert page.index("Verdict") < page.index("<img") < page.index("after")


def test_formats_as_the_notebook_asks_for_them() -> None:
    simulated = answer("a table", {"a.svg": drawn("a", 40), "a.png": b"\x89PNG"})
    everything = {"text/html", "text/plain", "image/svg+xml", "image/png"}
    assert set(_notebook.mimebundle(simulated)) == everything
    assert set(_notebook.mimebundle(simulated, include={"text/plain"})) == {"text/plain"}
    assert set(_notebook.mimebundle(simulated, exclude={"image/png"})) == everything - {"image/png"}
    assert _notebook.mimebundle(simulated)["text/plain"] == "a table"
