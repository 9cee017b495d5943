"""The scene of the page: models, lights, ground and sky."""

import logging
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
import viser

from ..sim.core import UP, ModelError, Pose, Vector, compose
from ..sim.description import (
    Box,
    Cylinder,
    Mesh,
    Plane,
    SceneChange,
    SceneSpec,
    ShownLink,
    ShownModel,
    ShownMotion,
    Sphere,
    Visual,
)
from ..sim.meshes import read_mesh
from ..sim.rendering import visual_gltf
from .lights import add_light, rgb_bytes
from .panel import Panel

logger = logging.getLogger(__name__)

SKY, HORIZON = (96, 150, 210), (222, 232, 242)  # without a background of the world's own
GRID_HEIGHT = 0.001  # [m] above a ground
STILL = 1e-6  # [m, and of a quaternion] what nobody sees


@dataclass
class _Shown:
    model: ShownModel
    handle: viser.FrameHandle
    links: dict[int, viser.FrameHandle]


class SceneView(Panel):
    """Shows the scene to all that look; not thread-safe."""

    def __init__(self, site: viser.ViserServer) -> None:
        self._site = site
        self._models: dict[str, _Shown] = {}
        self._frames: dict[int, viser.FrameHandle] = {}
        self._lights: Mapping[str, object] = {}
        self._scene: SceneSpec | None = None
        site.scene.configure_default_lights(enabled=False)

    def apply(self, change: SceneChange) -> None:
        """Show what has changed."""
        new = {model.name: model for model in change.models}
        kept: set[str] = set()
        gone: Iterable[str] = change.removed
        if change.reset:
            kept = {name for name, model in new.items()
                    if name in self._models and _looks(self._models[name].model, model)}
            gone = self._models.keys() - kept
        with self._site.atomic():
            self._light(change)
            for name in gone:
                self._remove(name)
            for name, model in new.items():
                if name in kept:
                    self._renumber(model)
                else:
                    self._remove(name)
                    self._add(model)
            self._frames = {number: frame for shown in self._models.values()
                            for number, frame in shown.links.items()}

    def move(self, motion: ShownMotion) -> None:
        """Move links."""
        with self._site.atomic():
            for number, pose in motion.poses.items():
                if number in self._frames:
                    _place(self._frames[number], pose)

    def start_view(self) -> tuple[Vector, Vector]:
        """Return eye and target [m] of a view of everything, from ahead at the right."""
        low, high = self._bounds()
        middle, extent = (low + high) / 2.0, float(np.linalg.norm(high - low))
        eye = middle + max(0.95 * extent, 1.0) * np.array([0.66, -0.62, 0.42])
        return (eye[0], eye[1], eye[2]), (middle[0], middle[1], middle[2])

    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the lowest and highest corner of all but grounds [m]."""
        corners = []
        for shown in self._models.values():
            for link in shown.model.links:
                if link.number in shown.links:
                    frame = shown.links[link.number]
                    pose = _pose(frame)
                    corners += [compose(pose, compose(visual.pose, Pose(corner))).position
                                for visual in link.visuals for corner in _corners(visual)]
        if not corners:
            return np.full(3, -1.0), np.full(3, 1.0)
        return np.min(corners, axis=0), np.max(corners, axis=0)

    def _light(self, change: SceneChange) -> None:
        scene = self._site.scene
        if change.scene != self._scene:
            self._scene, self._lights = change.scene, {}
            ambient = change.scene.ambient[:3]
            scene.add_light_ambient('/lights/ambient', color=rgb_bytes(ambient, max(ambient)),
                                    intensity=math.pi * max(ambient) / 2.0)
            scene.configure_environment_map('city', environment_intensity=max(ambient) / 2.0)
            scene.set_background_image(_sky(change.scene), format='png')
        if change.lights != self._lights:
            for name in self._lights:
                if name not in change.lights:
                    scene.remove_by_name(f'/lights/{_node(name)}')
            for name, light in change.lights.items():
                if self._lights.get(name) != light:
                    add_light(scene, f'/lights/{_node(name)}', light, change.scene.shadows)
            self._lights = change.lights

    def _add(self, model: ShownModel) -> None:
        root = f'/models/{_node(model.name)}'
        shown = _Shown(model, self._site.scene.add_frame(root, show_axes=False), {})
        self._models[model.name] = shown
        for link in model.links:
            if link.visuals:
                path = f'{root}/{_node(link.name)}'
                frame = self._site.scene.add_frame(path, show_axes=False)
                _place(frame, link.pose)
                shown.links[link.number] = frame
                self._add_visuals(path, link, model.name)

    def _add_visuals(self, path: str, link: ShownLink, model: str) -> None:
        for number, visual in enumerate(link.visuals):
            name = f'{path}/{number} {_node(visual.name)}'
            try:
                content = visual_gltf(visual)
            except ModelError as error:
                logger.warning("visual '%s' of model '%s' is not shown: %s", visual.name, model,
                               error)
                continue
            position, wxyz = visual.pose.position, _wxyz(visual.pose)
            plane = visual.geometry if isinstance(visual.geometry, Plane) else None
            self._site.scene.add_glb(name, content, position=position, wxyz=wxyz,
                                     cast_shadow=plane is None)
            if plane is not None and plane.normal == UP:
                self._add_grid(f'{name}/grid', plane)

    def _add_grid(self, name: str, plane: Plane) -> None:
        width, depth = plane.size
        self._site.scene.add_grid(
            name, width, depth, cell_size=1.0, section_size=10.0, cell_color=(130, 130, 130),
            section_color=(105, 105, 105), shadow_opacity=0.0, fade_distance=60.0,
            position=(0.0, 0.0, GRID_HEIGHT))

    def _renumber(self, model: ShownModel) -> None:
        shown = self._models[model.name]
        frames = iter(shown.links.values())
        shown.links = {link.number: next(frames) for link in model.links if link.visuals}
        shown.model = model
        for link in model.links:
            if link.number in shown.links:
                _place(shown.links[link.number], link.pose)

    def _remove(self, name: str) -> None:
        if name in self._models:
            self._models.pop(name).handle.remove()


def _looks(a: ShownModel, b: ShownModel) -> bool:
    """Tell whether two models look alike, wherever they are."""
    return [(link.name, link.visuals) for link in a.links] == [
        (link.name, link.visuals) for link in b.links]


def _place(frame: viser.FrameHandle, pose: Pose) -> None:
    wxyz = _wxyz(pose)
    if np.abs(np.subtract(frame.position, pose.position)).max() > STILL:
        frame.position = pose.position
    if np.abs(np.subtract(frame.wxyz, wxyz)).max() > STILL:
        frame.wxyz = wxyz


def _wxyz(pose: Pose) -> tuple[float, float, float, float]:
    x, y, z, w = pose.orientation
    return w, x, y, z


def _node(name: str) -> str:
    """Return a name as one of viser's scene tree, in which / separates levels."""
    return name.replace('/', '\u2215') or ' '


def _pose(frame: viser.FrameHandle) -> Pose:
    w, x, y, z = frame.wxyz
    return Pose(tuple(frame.position), (x, y, z, w))


def _corners(visual: Visual) -> list[Vector]:
    """Return the corners of a box around a visual, in its frame [m]; none for a plane."""
    match visual.geometry:
        case Box(size):
            high = np.divide(size, 2.0)
        case Sphere(radius):
            high = np.full(3, radius)
        case Cylinder(radius, length):
            high = np.array([radius, radius, length / 2.0])
        case Mesh(path, scale):
            try:
                vertices, _ = read_mesh(path).triangles()
            except ModelError:  # it is not shown
                return []
            ends = np.multiply([vertices.min(axis=0), vertices.max(axis=0)], scale)
            return list(product(*ends.T.tolist()))
        case Plane():
            return []
    return list(product(*np.stack([-high, high], axis=1).tolist()))


def _sky(scene: SceneSpec) -> np.ndarray:
    """Return an image (n, 1, 3) of what is behind everything, from the top."""
    if scene.background != SceneSpec().background:
        return np.full((1, 1, 3), rgb_bytes(scene.background[:3]), np.uint8)
    return np.linspace(SKY, HORIZON, 256).astype(np.uint8)[:, None]
