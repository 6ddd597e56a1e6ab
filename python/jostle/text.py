"""Text in HDF5 files, UTF-8 of any length, and numbers within texts for people."""

from __future__ import annotations

import math
from typing import Any

import h5py
import numpy as np


def text(value: Any) -> str:
    """Text of a scalar dataset, an attribute or an element."""
    if isinstance(value, h5py.Dataset):
        value = value[()]
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def finite_text(value: float, form: str) -> str:
    """A number within a text for people, by a format as ".3g"; "\u2013" where it is not finite."""
    return format(value, form) if math.isfinite(value) else "\u2013"


def texts(values: Any) -> list[str]:
    """Texts of a dataset or an attribute of one dimension."""
    return [text(value) for value in np.asarray(values)]


def attribute(item: h5py.Group | h5py.Dataset, name: str) -> str:
    """"" where there is none."""
    return text(item.attrs[name]) if name in item.attrs else ""
