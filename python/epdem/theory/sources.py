# SPDX-License-Identifier: GPL-2.0-or-later
"""The sources of the theory in full, by their short names. Equation numbers 8.xx are those of CHAPTER."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

# what BibTeX calls the place where an entry has appeared
PLACE = {"article": "journal", "inproceedings": "booktitle", "book": "publisher", "manual": "organization"}


@dataclass(frozen=True)
class Source:
    """A publication or program, as a line of text (`str`) and as an entry of BibTeX.

    place: journal, proceedings, or publisher. kind: of the BibTeX entry.
    """

    authors: str  # separated by commas
    title: str
    place: str
    volume: str = ""
    pages: str = ""
    year: int | None = None
    kind: str = "article"
    note: str = ""

    def __str__(self) -> str:
        if self.kind in ("article", "inproceedings"):
            return f"{self.authors}, {self.place} {self.volume}".rstrip() + f" ({self.year}) {self.pages}"
        place = f"({self.place})" if self.year is None else f"{self.place} ({self.year})"
        comma = " " if self.year is None else ", "
        return f"{self.authors}, {self.title}{comma}{place}" + (f", {self.note}" if self.note else "")

    @property
    def key(self) -> str:
        """The key of the entry: surnames of up to three authors and the year; of a program without a year its name."""
        if self.year is None:
            return self.title.split()[0]
        surnames = [name.removesuffix(" et al.").split()[-1] for name in self.authors.split(", ")]
        many = len(surnames) > 3 or self.authors.endswith("et al.")
        return (f"{surnames[0]}EtAl" if many else "".join(surnames)) + str(self.year)

    def bibtex(self) -> str:
        """The entry of BibTeX, with a newline at its end."""
        names = self.authors.replace(" et al.", ", others").replace(", ", " and ")
        fields = {
            "author": f"{{{names}}}" if self.year is None else names,  # a group has no surname
            "title": self.title,
            PLACE.get(self.kind, "howpublished"): self.place,
            "volume": self.volume,
            "pages": self.pages,
            "year": "" if self.year is None else str(self.year),
            "note": self.note,
        }
        lines = [f"  {name} = {{{text}}},\n" for name, text in fields.items() if text]
        return f"@{self.kind}{{{self.key},\n{''.join(lines)}}}\n"


CHAPTER = Source(
    "J. P. K. Seville, C.-Y. Wu",
    "Particle Technology and Engineering",
    "Butterworth-Heinemann",
    year=2016,
    kind="book",
    note="ISBN 978-0-08-098337-0, chapter 8, section 8.2",
)


def read_sources(path: Path) -> dict[str, Source]:
    """The sources of a file by their short names."""
    return {name: Source(**entry) for name, entry in tomllib.loads(path.read_text(encoding="utf-8")).items()}


SOURCES = read_sources(Path(__file__).with_name("sources.toml"))
