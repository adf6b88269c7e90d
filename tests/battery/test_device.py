# SPDX-License-Identifier: GPL-2.0-or-later
"""The headers as code for GPUs, by NVRTC, which needs no GPU: neither heap nor exceptions nor virtual calls."""

import ctypes
import re
from pathlib import Path

import pytest

from epdem.base.declarations import declarations

ROOT = Path(__file__).parents[2]
nvidia = pytest.importorskip("nvidia", reason="pip install nvidia-cuda-nvrtc-cu12 nvidia-cuda-cccl-cu12")
FOLDER = Path(next(iter(nvidia.__path__)))
# NVRTC has no standard headers; docs/embed.md names these
STANDARD = ("cmath", "cstddef", "cstdint", "iterator", "limits", "type_traits", "utility")
HEADERS = {name: f"#include <cuda/std/{name}>\nnamespace std {{ using namespace cuda::std; }}" for name in STANDARD}
HEADERS["cstring"] = ""
OPTIONS = (
    "-std=c++17",
    "-default-device",
    "--fmad=false",
    "-arch=compute_75",
    "-diag-suppress=1097",
)  # GCC's attributes


def device_code(source):
    """(messages, PTX) of a program; PTX is empty where it does not compile."""
    nvrtc = ctypes.CDLL(str(next((FOLDER / "cuda_nvrtc/lib").glob("libnvrtc.so.*"))))

    def text(of):
        size = ctypes.c_size_t()
        getattr(nvrtc, f"nvrtcGet{of}Size")(program, ctypes.byref(size))
        room = ctypes.create_string_buffer(size.value + 1)
        getattr(nvrtc, f"nvrtcGet{of}")(program, room)
        return room.value.decode()

    def words(strings):
        return (ctypes.c_char_p * len(strings))(*[s.encode() for s in strings])

    program, includes = ctypes.c_void_p(), [ROOT / "cpp_contact/include", FOLDER / "cuda_cccl/include"]
    shims = len(HEADERS), words(HEADERS.values()), words(HEADERS)
    assert nvrtc.nvrtcCreateProgram(ctypes.byref(program), source.encode(), b"device.cu", *shims) == 0
    options = words([*OPTIONS, *(f"-I{folder}" for folder in includes)])
    failed = nvrtc.nvrtcCompileProgram(program, len(options), options)
    return text("ProgramLog"), "" if failed else text("PTX")


def foreign(ptx):
    """Calls of functions that the program does not contain, and calls through a pointer."""
    return re.findall(r"\.extern \.func.*?(\w+)\s*\n?\(|(\.callprototype)", ptx)


@pytest.mark.slow
@pytest.mark.packaging
def test_every_law_and_model_is_device_code_of_its_own():
    messages, ptx = device_code((ROOT / "tests/battery/device.cu").read_text())
    assert ptx and not re.search("warning|error", messages), messages
    entries = re.findall(r"\.entry (\w+)", ptx)
    for law in declarations():
        name = law.title().replace("_", "")
        assert len([e for e in entries if f"{len(name)}{name}I" in e]) == (3 if law == "cavity" else 2), name
    assert foreign(ptx) == [] and "call" not in ptx


@pytest.mark.parametrize(
    "line",
    [
        "*x = *new double[int(*x)];",
        "struct B { virtual double f() { return 1; } }; struct C : B { double f() { return 2; } }; "
        "B b; C c; B* p = *x > 0 ? &b : &c; *x = p->f();",
    ],
)
def test_the_heap_and_virtual_calls_would_be_found(line):
    messages, ptx = device_code('extern "C" __global__ void f(double* x) { ' + line + " }")
    assert ptx, messages
    assert "call" in ptx and foreign(ptx)


def test_exceptions_do_not_compile():
    assert device_code('extern "C" __global__ void f(double* x) { if (*x > 0) throw 1; }')[1] == ""
