"""The scene of the page: models, lights, ground and sky."""

import logging
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
import viser
from numpy.typing import NDArray

from ...sim.core import UP, ModelError
from ...sim.description import Plane, SceneChange, SceneSpec, ShownLink, ShownModel, ShownMotion
from ...sim.rendering import Look, visual_gltf
from ..controls import Panel
from .lights import add_light, rgb_bytes
from .nodes import link_node, model_node, node, place, wxyz

logger = logging.getLogger(__name__)

SKY, HORIZON = (96, 150, 210), (222, 232, 242)  # without a background of the world's own
GRID_HEIGHT = 0.004  # [m] above a ground; at 0.001 renderers draw the ground in front, by view


@dataclass
class _Shown:
    model: ShownModel
    handle: viser.FrameHandle
    links: dict[int, viser.FrameHandle]


class SceneView(Panel):
    """Shows the scene to all that look; not thread-safe.

    `click` is called with the names of model and link that are clicked on, and by whom, from any
    thread; grounds and other planes take no clicks.
    """

    def __init__(
        self, site: viser.ViserServer, click: Callable[[str, str, viser.ClientHandle], None]
    ) -> None:
        self._site, self._click = site, click
        self._models: dict[str, _Shown] = {}
        self._frames: dict[int, viser.FrameHandle] = {}
        self._lights: Mapping[str, object] = {}
        self._scene: SceneSpec | None = None
        self._look = Look.SOLID
        site.scene.configure_default_lights(enabled=False)

    def apply(self, change: SceneChange) -> None:
        """Show what has changed."""
        new = {model.name: model for model in change.models}
        kept = {
            name
            for name, model in new.items()
            if name in self._models and _looks(self._models[name].model, model)
        }
        gone = (self._models.keys() if change.reset else set(change.removed)) - kept
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
            self._frames = {
                number: frame
                for shown in self._models.values()
                for number, frame in shown.links.items()
            }

    def move(self, motion: ShownMotion) -> None:
        """Move links."""
        with self._site.atomic():
            for number, pose in motion.poses.items():
                if number in self._frames:
                    place(self._frames[number], pose)

    def draw_as(self, look: Look) -> None:
        """Draw all visuals but planes solid, transparent, or as wires."""
        if look is not self._look:
            self._look = look
            with self._site.atomic():
                for shown in self._models.values():
                    for link in shown.model.links:
                        self._add_visuals(link, shown.model.name)

    def _light(self, change: SceneChange) -> None:
        scene = self._site.scene
        if change.scene != self._scene:
            self._scene, self._lights = change.scene, {}
            ambient = change.scene.ambient[:3]
            scene.add_light_ambient(
                '/lights/ambient',
                color=rgb_bytes(ambient, max(ambient)),
                intensity=math.pi * max(ambient) / 2.0,
            )
            scene.configure_environment_map('city', environment_intensity=max(ambient) / 2.0)
            scene.set_background_image(_sky(change.scene), format='png')
        if change.lights != self._lights:
            for name in self._lights:
                if name not in change.lights:
                    scene.remove_by_name(f'/lights/{node(name)}')
            for name, light in change.lights.items():
                if self._lights.get(name) != light:
                    add_light(scene, f'/lights/{node(name)}', light, change.scene.shadows)
            self._lights = change.lights

    def _add(self, model: ShownModel) -> None:
        scene = self._site.scene
        shown = _Shown(model, scene.add_frame(model_node(model.name), show_axes=False), {})
        self._models[model.name] = shown
        for link in model.links:
            shown.links[link.number] = scene.add_frame(
                link_node(model.name, link.name),
                show_axes=False,
                position=link.pose.position,
                wxyz=wxyz(link.pose),
            )
            self._add_visuals(link, model.name)

    def _add_visuals(self, link: ShownLink, model: str) -> None:
        for number, visual in enumerate(link.visuals):
            name = f'{link_node(model, link.name)}/{number} {node(visual.name)}'
            plane = visual.geometry if isinstance(visual.geometry, Plane) else None
            try:
                content = visual_gltf(visual, self._look if plane is None else Look.SOLID)
            except ModelError as error:
                logger.warning(
                    "visual '%s' of model '%s' is not shown: %s", visual.name, model, error
                )
                continue
            shape = self._site.scene.add_glb(
                name,
                content,
                position=visual.pose.position,
                wxyz=wxyz(visual.pose),
                cast_shadow=plane is None,
            )
            if plane is None:
                shape.on_click(partial(self._clicked, model, link.name))
            elif plane.normal == UP:
                self._add_grid(f'{name}/grid', plane)

    def _clicked(
        self, model: str, link: str, event: viser.SceneNodePointerEvent[viser.GlbHandle]
    ) -> None:
        self._click(model, link, event.client)

    def _add_grid(self, name: str, plane: Plane) -> None:
        width, depth = plane.size
        self._site.scene.add_grid(
            name,
            width,
            depth,
            cell_size=1.0,
            section_size=10.0,
            cell_color=(130, 130, 130),
            section_color=(105, 105, 105),
            shadow_opacity=0.0,
            fade_distance=60.0,
            position=(0.0, 0.0, GRID_HEIGHT),
        )

    def _renumber(self, model: ShownModel) -> None:
        shown = self._models[model.name]
        frames = shown.links.values()
        shown.links = {link.number: frame for link, frame in zip(model.links, frames, strict=True)}
        shown.model = model
        for link in model.links:
            place(shown.links[link.number], link.pose)

    def _remove(self, name: str) -> None:
        if name in self._models:
            self._models.pop(name).handle.remove()


def _looks(a: ShownModel, b: ShownModel) -> bool:
    """Tell whether two models look alike, wherever they are."""
    return [(link.name, link.visuals) for link in a.links] == [
        (link.name, link.visuals) for link in b.links
    ]


def _sky(scene: SceneSpec) -> NDArray[np.uint8]:
    """Return an image (n, 1, 3) of what is behind everything, from the top."""
    if scene.background != SceneSpec().background:
        return np.full((1, 1, 3), rgb_bytes(scene.background[:3]), np.uint8)
    return np.linspace(SKY, HORIZON, 256).astype(np.uint8)[:, None]
