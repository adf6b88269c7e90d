# SPDX-License-Identifier: GPL-2.0-or-later
"""The sources of the theory in full, by their short names. Equation numbers 8.xx are those of CHAPTER."""

from dataclasses import dataclass

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
SOURCES = {
    "Bridges et al. 1984": Source(
        "F. G. Bridges, A. Hatzes, D. N. C. Lin",
        "Structure, stability and evolution of Saturn's rings",
        "Nature",
        "309",
        "333",
        1984,
    ),
    "Bryant and Keer 1982": Source(
        "M. D. Bryant, L. M. Keer",
        "Rough contact between elastically and geometrically identical curved bodies",
        "J. Appl. Mech.",
        "49",
        "345",
        1982,
    ),
    "Hamilton 1983": Source(
        "G. M. Hamilton",
        "Explicit equations for the stresses beneath a sliding spherical contact",
        "Proc. Inst. Mech. Eng.",
        "197C",
        "53",
        1983,
    ),
    "Hamilton and Goodman 1966": Source(
        "G. M. Hamilton, L. E. Goodman",
        "The stress field created by a circular sliding contact",
        "J. Appl. Mech.",
        "33",
        "371",
        1966,
    ),
    "Hertz 1882": Source(
        "H. Hertz", "Ueber die Beruehrung fester elastischer Koerper", "J. reine angew. Math.", "92", "156", 1882
    ),
    "Hunter 1957": Source(
        "S. C. Hunter", "Energy absorbed by elastic waves during impact", "J. Mech. Phys. Solids", "5", "162", 1957
    ),
    "Hutchings 1979": Source(
        "I. M. Hutchings", "Energy absorbed by elastic waves during plastic impact", "J. Phys. D", "12", "1819", 1979
    ),
    "Jackson and Green 2005": Source(
        "R. L. Jackson, I. Green",
        "A finite element study of elasto-plastic hemispherical contact against a rigid flat",
        "J. Tribol.",
        "127",
        "343",
        2005,
    ),
    "Jaeger 1993": Source(
        "J. Jaeger", "Elastic contact of equal spheres under oblique forces", "Arch. Appl. Mech.", "63", "402", 1993
    ),
    "Johnson 1985": Source("K. L. Johnson", "Contact Mechanics", "Cambridge University Press", year=1985, kind="book"),
    "Johnson and Jefferis 1963": Source(
        "K. L. Johnson, J. A. Jefferis",
        "Plastic flow and residual stresses in rolling and sliding contact",
        "Symp. Rolling Contact, Inst. Mech. Eng.",
        "",
        "54",
        1963,
        "inproceedings",
    ),
    "Johnson, Kendall and Roberts 1971": Source(
        "K. L. Johnson, K. Kendall, A. D. Roberts",
        "Surface energy and the contact of elastic solids",
        "Proc. R. Soc. A",
        "324",
        "301",
        1971,
    ),
    "Luding 2008": Source(
        "S. Luding", "Cohesive, frictional powders: contact models for tension", "Granular Matter", "10", "235", 2008
    ),
    "Maw, Barber and Fawcett 1976": Source(
        "N. Maw, J. R. Barber, J. N. Fawcett", "The oblique impact of elastic spheres", "Wear", "38", "101", 1976
    ),
    "Mesarovic and Johnson 2000": Source(
        "S. Dj. Mesarovic, K. L. Johnson",
        "Adhesive contact of elastic-plastic spheres",
        "J. Mech. Phys. Solids",
        "48",
        "2009",
        2000,
    ),
    "Miller and Pursey 1955": Source(
        "G. F. Miller, H. Pursey",
        "On the partition of energy between elastic waves in a semi-infinite solid",
        "Proc. R. Soc. A",
        "233",
        "55",
        1955,
    ),
    "Popov and Hess 2015": Source(
        "V. L. Popov, M. Hess",
        "Method of Dimensionality Reduction in Contact Mechanics and Friction",
        "Springer",
        year=2015,
        kind="book",
    ),
    "Tabor 1977": Source(
        "D. Tabor", "Surface forces and surface interactions", "J. Colloid Interface Sci.", "58", "2", 1977
    ),
    "Thakur et al. 2014": Source(
        "S. C. Thakur, J. P. Morrissey, J. Sun, J. F. Chen, J. Y. Ooi",
        "Micromechanical analysis of cohesive granular materials using the discrete element method with an adhesive "
        "elasto-plastic contact model",
        "Granular Matter",
        "16",
        "383",
        2014,
    ),
    "Thornton and Ning 1998": Source(
        "C. Thornton, Z. Ning",
        "A theoretical model for the stick/bounce behaviour of adhesive, elastic-plastic spheres",
        "Powder Technol.",
        "99",
        "154",
        1998,
    ),
    "Thornton 1997": Source(
        "C. Thornton",
        "Coefficient of restitution for collinear collisions of elastic-perfectly plastic spheres",
        "J. Appl. Mech.",
        "64",
        "383",
        1997,
    ),
    "Tsuji, Tanaka and Ishida 1992": Source(
        "Y. Tsuji, T. Tanaka, T. Ishida",
        "Lagrangian numerical simulation of plug flow of cohesionless particles in a horizontal pipe",
        "Powder Technol.",
        "71",
        "239",
        1992,
    ),
    "Wu et al. 2003": Source(
        "C.-Y. Wu, L.-Y. Li, C. Thornton",
        "Rebound behaviour of spheres for plastic impacts",
        "Int. J. Impact Eng.",
        "28",
        "929",
        2003,
    ),
    "Zunker and Kamrin 2024": Source(
        "W. Zunker, K. Kamrin",
        "A mechanically-derived contact model for adhesive elastic-perfectly plastic particles, Part I: Utilizing the "
        "method of dimensionality reduction",
        "J. Mech. Phys. Solids",
        "183",
        "105492",
        2024,
    ),
}
