"""Batch functions of other libraries' arrays, by DLPack."""

from __future__ import annotations

import importlib.util
import subprocess
import sys

import numpy as np
import pytest

import montelux

BOX = [(0, 1), (0, 2)]


class Foreign:
    """An array that only DLPack reads, as far as its device lets it."""

    def __init__(self, array, device=(1, 0)):
        self.array, self.device = array, device

    def __dlpack__(self, **options):
        if self.device[0] != 1:
            raise BufferError("on the device")
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.device


class OfCupy(Foreign):
    def get(self):
        return self.array


class OfTorch(Foreign):
    def cpu(self):
        return Foreign(self.array)

    def detach(self):
        return self


class RecordsGradients(Foreign):
    def __dlpack__(self, **options):
        raise BufferError("use detach()")

    def detach(self):
        return Foreign(self.array)


def product(x):
    return x[:, 0] * x[:, 1]


def integral(f, **named):
    r = montelux.integrate(f, BOX, "vegas", evaluations=3000, seed=2, **named)
    return r.value, r.standard_error


@pytest.mark.parametrize(
    "kind, device", [(Foreign, (1, 0)), (OfCupy, (2, 1)), (OfTorch, (2, 0)), (RecordsGradients, (1, 0))]
)
def test_values_of_any_library(kind, device):
    assert integral(lambda x: kind(product(x), device)) == integral(product)
    assert integral(lambda x: kind(product(x), device), workers=2) == integral(product)


def test_components_of_any_library():
    def two(x):
        return np.stack([x[:, 0], product(x)], axis=-1)

    runs = [montelux.integrate(f, BOX, evaluations=2000) for f in (two, lambda x: Foreign(two(x)))]
    assert np.array_equal(runs[0].value, runs[1].value)


def test_points_of_any_library():
    seen = []

    def f(x):
        seen.append(x)
        return product(x)

    assert integral(f, array=np.from_dlpack) == integral(product)
    assert all(x.flags.c_contiguous for x in seen)  # and may be kept
    assert montelux.integrate(lambda x: x.array, (0, 1), "cubature", array=Foreign).value == pytest.approx(0.5)


@pytest.mark.parametrize(
    "f, options, sentence",
    [
        (lambda x: Foreign(product(x), (2, 3)), {}, r"'Foreign' was returned that is on the device \(2, 3\)"),
        (lambda x: Foreign(1j * product(x)), {}, "complex numbers were found"),
        (lambda x: Foreign(product(x)[:2]), {}, r"shape \(2,\) was returned for 5 points"),
        (product, {"array": 3}, "array: 3 was given; expected a function of a NumPy array"),
        (product, {"array": np.asarray, "out": True}, "array: it is for functions that get a batch"),
        (product, {"array": np.asarray, "batch": False}, "array: it is for functions that get a batch"),
    ],
)
def test_mistakes_are_answered(f, options, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        integral(f, **options)


def test_exceptions_of_dlpack_are_answered():
    class Broken(Foreign):
        def __dlpack__(self, **options):
            raise RuntimeError("no such thing")

    with pytest.raises(montelux.Error, match=r"'Broken' was returned that NumPy cannot read \(RuntimeError: no"):
        integral(lambda x: Broken(product(x)))


# Libraries, where they are installed, in a process of their own: a process with their threads must not fork.

LIBRARY = """
import numpy as np
import montelux
{imports}
def product(x):
    return x[:, 0] * x[:, 1]
def integral(f, **named):
    r = montelux.integrate(f, [(0, 1), (0, 2)], "vegas", evaluations=3000, seed=2, **named)
    return r.value, r.standard_error
{program}
"""


@pytest.mark.parametrize(
    "imports, program",
    [
        (
            "import jax; jax.config.update('jax_enable_x64', True)",
            "assert integral(jax.jit(product), array=jax.numpy.asarray) == integral(product)",
        ),
        (
            "import torch; w = torch.tensor(1.0, dtype=torch.float64, requires_grad=True)",
            "assert integral(lambda x: w * product(x), array=torch.from_dlpack) == integral(product)",
        ),
        (
            "import torch; torch.cuda.is_available() or exit(77)",
            "assert integral(product, array=lambda x: torch.from_dlpack(x).cuda()) == integral(product)",
        ),
        (
            "import cupy; cupy.cuda.is_available() or exit(77)",
            "assert integral(product, array=cupy.asarray) == integral(product)",
        ),
    ],
    ids=["jax", "torch", "torch on a GPU", "CuPy"],
)
def test_libraries(imports, program):
    library = imports.split(";")[0].removeprefix("import ")
    if importlib.util.find_spec(library) is None:
        pytest.skip(f"{library} is not installed")
    code = LIBRARY.format(imports=imports, program=program)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    if done.returncode == 77:
        pytest.skip("there is no GPU")
    assert done.returncode == 0, done.stderr
