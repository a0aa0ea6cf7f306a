"""What tests of scenes and renders begin with."""

from __future__ import annotations

import pytest

import montelux
from small_scene import TEXT


@pytest.fixture
def scene():
    return montelux.parse(TEXT)
