"""Contacts and forces in a packing of grains."""

from __future__ import annotations

import dataclasses

import h5py
import numpy as np

from .text import text


@dataclasses.dataclass(frozen=True)
class Contacts:
    """The contacts with force of one packing, each once. first, second: [contact], spheres; or second is
    n_spheres + w, wall w of `walls`. overlap: [contact], diameters. normal: [contact, 3], unit vector from
    second to first. normal_force: [contact], m g, positive where they press on each other.
    tangential_force: [contact, 3], on first, m g. diameters: [sphere]; m is the mass of a sphere of diameter 1 and
    density 1."""

    n_spheres: int
    walls: tuple[str, ...]
    first: np.ndarray
    second: np.ndarray
    overlap: np.ndarray
    normal: np.ndarray
    normal_force: np.ndarray
    tangential_force: np.ndarray
    diameters: np.ndarray

    def __len__(self) -> int:
        return len(self.first)

    def forces(self) -> np.ndarray:
        """[contact, 3], m g: the whole force on first; that on second, where it is a sphere, is opposite."""
        return self.normal_force[:, None] * self.normal + self.tangential_force

    def force_moments(self) -> np.ndarray:
        """[sphere, 3, 3], m g d: of every sphere the sum over its contacts of arm (x) force, the arm from
        the contact to its centre; the contact of two spheres divides the line of their centres as their radii do.
        Over a volume it is the stress, positive under pressure. The sum over spheres is `force_moment` of the
        snapshot."""
        of_two = self.second < self.n_spheres
        radii = np.append(0.5 * self.diameters, 0.0)
        first, second = radii[self.first], radii[np.minimum(self.second, self.n_spheres)]
        share = 1 - self.overlap / (first + second)  # share of each radius
        each = (share[:, None] * self.normal)[:, :, None] * self.forces()[:, None, :]
        moments = np.zeros((self.n_spheres, 3, 3))
        np.add.at(moments, self.first, first[:, None, None] * each)
        np.add.at(moments, self.second[of_two], (second[:, None, None] * each)[of_two])
        return moments


def contacts_of(group: h5py.Group, diameters: np.ndarray, tap: int) -> Contacts:
    """Those of a realization's group /particles/..., after a tap that it keeps."""
    n_spheres = len(diameters)
    if "contacts" not in group:  # no snapshot has any
        return Contacts(n_spheres, (), *(np.zeros(0, np.int64) for _ in range(2)), np.zeros(0),
                        np.zeros((0, 3)), np.zeros(0), np.zeros((0, 3)), diameters)
    kept = group["contacts"]
    ends = [*kept["offset"][()].tolist(), len(kept["first"])]
    frame = kept["step"][()].tolist().index(tap)
    here = slice(ends[frame], ends[frame + 1])
    return Contacts(n_spheres, tuple(text(wall) for wall in kept["second"].attrs["walls"]),
                    *(kept[name][here].astype(np.int64) for name in ("first", "second")),
                    *(kept[name][here] for name in ("overlap", "normal", "normal_force",
                                                    "tangential_force")),
                    diameters)
