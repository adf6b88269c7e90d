# SPDX-License-Identifier: GPL-2.0-or-later
"""The sources that docstrings of the theory name, in full. Equation numbers 8.xx are those of CHAPTER."""

CHAPTER = (
    "J. P. K. Seville, C.-Y. Wu, Particle Technology and Engineering, Butterworth-Heinemann (2016), "
    "ISBN 978-0-08-098337-0, chapter 8, section 8.2"
)
SOURCES = {
    "Bridges et al. 1984": "F. G. Bridges, A. Hatzes, D. N. C. Lin, Nature 309 (1984) 333",
    "Bryant and Keer 1982": "M. D. Bryant, L. M. Keer, J. Appl. Mech. 49 (1982) 345",
    "Hamilton 1983": "G. M. Hamilton, Proc. Inst. Mech. Eng. 197C (1983) 53",
    "Hamilton and Goodman 1966": "G. M. Hamilton, L. E. Goodman, J. Appl. Mech. 33 (1966) 371",
    "Hertz 1882": "H. Hertz, J. reine angew. Math. 92 (1882) 156",
    "Hunter 1957": "S. C. Hunter, J. Mech. Phys. Solids 5 (1957) 162",
    "Hutchings 1979": "I. M. Hutchings, J. Phys. D 12 (1979) 1819",
    "Jackson and Green 2005": "R. L. Jackson, I. Green, J. Tribol. 127 (2005) 343",
    "Jaeger 1993": "J. Jaeger, Arch. Appl. Mech. 63 (1993) 402",
    "Johnson 1985": "K. L. Johnson, Contact Mechanics, Cambridge University Press (1985)",
    "Johnson and Jefferis 1963": "K. L. Johnson, J. A. Jefferis, Symp. Rolling Contact, Inst. Mech. Eng. (1963) 54",
    "Johnson, Kendall and Roberts 1971": "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301",
    "Luding 2008": "S. Luding, Granular Matter 10 (2008) 235",
    "Maw, Barber and Fawcett 1976": "N. Maw, J. R. Barber, J. N. Fawcett, Wear 38 (1976) 101",
    "Mesarovic and Johnson 2000": "S. Dj. Mesarovic, K. L. Johnson, J. Mech. Phys. Solids 48 (2000) 2009",
    "Miller and Pursey 1955": "G. F. Miller, H. Pursey, Proc. R. Soc. A 233 (1955) 55",
    "Popov and Hess 2015": "V. L. Popov, M. Hess, Method of Dimensionality Reduction, Springer (2015)",
    "Tabor 1977": "D. Tabor, J. Colloid Interface Sci. 58 (1977) 2",
    "Thakur et al. 2014": "S. C. Thakur, J. P. Morrissey, J. Sun, J. F. Chen, J. Y. Ooi, Granular Matter 16 (2014) 383",
    "Thornton and Ning 1998": "C. Thornton, Z. Ning, Powder Technol. 99 (1998) 154",
    "Thornton 1997": "C. Thornton, J. Appl. Mech. 64 (1997) 383",
    "Tsuji, Tanaka and Ishida 1992": "Y. Tsuji, T. Tanaka, T. Ishida, Powder Technol. 71 (1992) 239",
    "Wu et al. 2003": "C.-Y. Wu, L.-Y. Li, C. Thornton, Int. J. Impact Eng. 28 (2003) 929",
    "Zunker and Kamrin 2024": "W. Zunker, K. Kamrin, J. Mech. Phys. Solids 183 (2024) 105492",
}
