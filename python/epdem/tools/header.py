# SPDX-License-Identifier: GPL-2.0-or-later
"""Our models as sources for a LIGGGHTS tree: each file self-contained, made from the plugin's own sources."""

import re
from pathlib import Path

from ..base import __version__, paths
from ..base.files import write_texts
from ..errors import CaseError

NAME = "normal_model_ep"
PFM = "pfm"  # folder of the sources for LIGGGHTS-PFM, whose contact models have another interface
# What keeps a tree from being built with GCC 12 and make 4.3, or from being built with our files: file, what is in it,
# what to do.
_OBSTACLES = (
    (
        "MAKE/Makefile.auto",
        r"\\#(include|if)",
        r"make 4.3 and newer read \# literally, and MPI and more is not found; write # for each \#",
    ),
    (
        "utils.h",
        r"^[ \t]*return static_cast<\s*std::ostringstream",
        "newer compilers refuse this cast; write 'return std::to_string(a);'",
    ),
    (
        "finish.cpp",
        r"^[ \t]*if \(neighbor->lists\[m\]->numneigh > 0\)",
        "newer compilers refuse to compare a pointer with > 0; leave '> 0' out",
    ),
    (
        "dump_mesh_vtk.cpp",
        r"\A(?!(?s:.)*LAMMPS_VTK)(?=(?s:.)*#include <vtk)",
        "it needs VTK; without VTK remove dump_mesh_vtk.cpp and dump_mesh_vtk.h",
    ),
    ("CMakeLists.txt", r"-std=c\+\+(98|03|0x|11|14)\b", "for a build by CMake write -std=c++17 in its place"),
)
_INCLUDE = re.compile(r'\s*#include "([^"]+)"')
_OPTIONS = re.compile(r'set_source_files_properties\((\S+) PROPERTIES COMPILE_OPTIONS\s+"([^"]+)"\)')
# REUSE-IgnoreStart
_TOP = """\
// SPDX-License-Identifier: GPL-2.0-or-later AND BSD-3-Clause
// epdem {version}: elastic-plastic contact models for LIGGGHTS. Made by `epdem export liggghts`; changes here are lost.
// Copy every {name}* into the folder src of a LIGGGHTS tree and build as usual.
#if __cplusplus < 201703L
#error "epdem needs C++17: add -std=c++17 to the compiler flags of this tree, in place of an older standard"
#endif
{condition}
#pragma GCC diagnostic ignored "-Wclass-memaccess"  // of LIGGGHTS's own headers
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wpsabi"
#if defined __GNUC__ && !defined __clang__
#pragma GCC optimize("O3", "no-math-errno", "no-trapping-math", "fp-contract=off")
{target}#endif
#define EPDEM_VERSION "{version}"
"""
_LICENCE = re.compile(r"// SPDX-License-Identifier: (\S+)")
# REUSE-IgnoreEnd


def files(pfm: bool = False) -> dict[str, str]:
    """Names and texts of the files; one for the models, one for each set of instructions that is compiled apart.

    The first is for the processor that the tree is built for. For LIGGGHTS-PFM (`pfm`) it is the only one, because the
    pair loop does not run there; beside it is a header with two commands of decks that are unknown there. The last file
    is the licence of the physics; a tree has its own copy of the other. Raises EngineError if the sources are not
    installed.
    """
    host, laws = paths.beside("cpp_contact/liggghts"), paths.beside(paths.LAWS)
    kernels, roots = host.parent / "kernels", (host, laws, host.parent)
    if pfm:
        sources = [host / PFM / "models.cpp", host / "materials.cpp", host / "cohesion.cpp"]
        commands = (host / PFM / "commands.h").read_text(encoding="utf-8")
        return {f"{NAME}.cpp": _together(sources, roots), f"{NAME}.h": commands, **_licence()}
    apart = dict(_OPTIONS.findall((kernels / "CMakeLists.txt").read_text(encoding="utf-8")))
    common = [f for f in sorted(host.rglob("*.cpp")) if f.name != "main.cpp" and f.parent.name != PFM]
    common += [f for f in sorted(kernels.glob("*.cpp")) if f.name not in apart]
    found = {f"{NAME}.cpp": _together(common, roots)}
    for name, options in apart.items():
        source = kernels / name
        found[f"{NAME}_{source.stem}.cpp"] = _together([source], roots, options)
    return found | _licence()


def _licence() -> dict[str, str]:
    file = paths.beside("LICENSES") / "BSD-3-Clause.txt"
    return {f"{NAME}_{file.name}": file.read_text(encoding="utf-8")}


def write(folder: Path) -> list[Path]:
    """Write the files into a folder, the `src` of a LIGGGHTS tree; those for LIGGGHTS-PFM if it is one.

    Raises CaseError if the folder does not exist.
    """
    if not folder.is_dir():
        raise CaseError(f"--out {folder}: there is no such folder; name the folder src of a LIGGGHTS tree")
    return write_texts(folder, files(is_pfm(folder)))


def is_pfm(folder: Path) -> bool:
    """Whether the contact models in the `src` of a tree have the interface collision/noCollision."""
    models = folder / "contact_models.h"
    return models.is_file() and "noCollision" in _text(models)


def check(folder: Path) -> list[str]:
    """Missing parts of a LIGGGHTS tree for a build with our models: a sentence each, with file, line and what to do.

    `folder` is the tree's `src`. Raises CaseError for another folder, or contact models with another interface.
    """
    models = folder / "contact_models.h"
    if not models.is_file():
        raise CaseError(f"--check {folder}: contact_models.h is not there; name the folder src of a LIGGGHTS tree")
    pfm = is_pfm(folder)
    if not pfm and "surfacesIntersect" not in _text(models):
        raise CaseError(
            f"--check {models}: its models have neither the interface surfacesIntersect nor collision/noCollision; "
            "take a tree of LIGGGHTS-PUBLIC 3.8, LIGGGHTS-INL 4.0 or LIGGGHTS-PFM 24.01"
        )
    found = []
    for name, text in files(pfm).items():
        if not (folder / name).is_file():
            found.append(f"{folder / name} is not there; run 'epdem export liggghts --out {folder}'")
        elif _text(folder / name) != text:
            found.append(f"{folder / name} is of another version of epdem; run 'epdem export liggghts --out {folder}'")
    for name, pattern, advice in _OBSTACLES:
        text = _text(folder / name) if (folder / name).is_file() else ""
        if text and (match := re.search(pattern, text, re.MULTILINE)):
            found.append(f"{folder / name}:{text.count(chr(10), 0, match.start()) + 1}: {advice}")
    return found


def _text(file: Path) -> str:
    return file.read_text(encoding="utf-8", errors="replace")


def _together(sources: list[Path], roots: tuple[Path, ...], options: str = "") -> str:
    """The sources with each of our headers once, at its first inclusion; `options` name instructions of x86."""
    sets = [word.removeprefix("-m") for word in options.split(";") if word]
    # GCC below 13 takes the pragma as a whole, but does not define what -m... would
    macros = [f"__{word.upper()}__" for word in ["avx", *sets] if word.startswith("avx")]
    target = "".join(f"#ifndef {m}\n#define {m} 1\n#endif\n" for m in macros)
    target = f'#pragma GCC target("{",".join(sets)}")\n{target}' if sets else ""
    condition = "#if defined __x86_64__ && defined __GNUC__ && !defined __clang__" if sets else "#if 1"
    seen: set[Path] = set()
    body = [line for source in sources for line in _lines(source, roots, seen)]
    top = _TOP.format(version=__version__, name=NAME, target=target, condition=condition)
    return top + "\n".join(body) + "\n\n#endif\n"


def _lines(file: Path, roots: tuple[Path, ...], seen: set[Path]) -> list[str]:
    """The lines of a file with our headers in place of their inclusion; headers of LIGGGHTS stay included."""
    seen.add(file)
    name = next(file.relative_to(r) for r in roots if file.is_relative_to(r))
    first, *lines = file.read_text(encoding="utf-8").splitlines()
    licence = _LICENCE.match(first)
    found = ["", f"// {name}" + (f", {licence[1]}" if licence else "")]
    for line in lines if licence else [first, *lines]:
        match = _INCLUDE.match(line)
        ours = [p for p in (folder / match[1] for folder in (file.parent, *roots)) if p.is_file()] if match else []
        if ours:
            found += [] if ours[0].resolve() in seen else _lines(ours[0].resolve(), roots, seen)
        elif not line.startswith("#pragma once"):
            found.append(line)
    return found
