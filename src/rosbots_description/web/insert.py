"""Insert models: shapes, a light, models of the model path, robot descriptions, and files."""

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import viser

from ..sim.core import Pose, SimError, Vector
from ..sim.description import GROUND_PLANE, LightSpec, ModelSpec, ModelText, SceneChange
from .choice import Choice
from .ground_clicks import GroundClicks
from .hands import Hands
from .history import History
from .panel import Panel, attempt
from .place import Places
from .selection import Selection
from .shapes import KINDS, point_light, shape
from .site import Site

MOST = 1000  # names that are offered
LISTED = 4  # parts that a model was spawned without
LOOKS = 10  # refreshes between two looks at what can be inserted
NONE = '(none)'


class Library(Protocol):
    """What can be inserted. What returns a text raises SimError with a sentence."""

    def models(self) -> Sequence[str]:
        """Return the names of the models along the simulator's model path; [] if unknown."""

    def parameters(self) -> Sequence[str]:
        """Return the names of parameters that hold a URDF; [] if unknown."""

    def model(self, name: str) -> ModelText:
        """Return a model of the model path."""

    def parameter(self, name: str) -> ModelText:
        """Return what a parameter holds."""

    def file(self, name: str, content: bytes) -> ModelText:
        """Return a URDF, xacro or SDF; the name says which, and is in messages."""

    def shape(self, spec: ModelSpec) -> ModelText:
        """Return a model as text."""

    def light(self, spec: LightSpec) -> ModelText:
        """Return a light as text."""


class InsertPanel(Panel):
    """Controls that insert where the camera looks, or at a place that was clicked on."""

    def __init__(
        self,
        site: Site,
        library: Library,
        hands: Hands,
        selection: Selection,
        history: History,
        clicks: GroundClicks,
        complain: Callable[[str], None],
    ) -> None:
        self._library, self._hands, self._selection = library, hands, selection
        self._history, self._complain = history, complain
        self._lights: Mapping[str, LightSpec] = {}
        self._refreshes = 0
        self._look = threading.Thread()
        gui = site.gui
        self._places = Places(clicks)
        place = gui.add_button(
            'Choose the place',
            icon=viser.Icon.MAP_PIN,
            hint='by a click on the ground; else it is where the camera looks',
        )
        with gui.add_folder('Shape'):
            kind = gui.add_dropdown('Kind', KINDS)
            size = gui.add_vector3(
                'Size [m]',
                (0.5, 0.5, 0.5),
                step=0.05,
                hint='x, y, z; x is the diameter of what is round, z the length of a cylinder',
            )
            mass = gui.add_number('Shape mass [kg]', 1.0, step=0.1)
            colour = gui.add_rgb('Colour', (220, 120, 40))
            static = gui.add_checkbox('Static', False, hint='it never moves by itself')
            add_shape = gui.add_button('Insert shape', icon=viser.Icon.PLUS)
            add_light = gui.add_button('Insert light', icon=viser.Icon.BULB, hint='of that colour')
            self._light = Choice(gui, 'Light', [NONE])
            remove_light = gui.add_button('Delete light', icon=viser.Icon.BULB_OFF)
        with gui.add_folder('Model'):
            self._models = Choice(gui, 'Model path', [NONE])
            add_model = gui.add_button('Insert model', icon=viser.Icon.PLUS)
            self._parameters = Choice(gui, 'Parameter', [NONE], hint='holds a URDF')
            add_parameter = gui.add_button('Insert robot', icon=viser.Icon.PLUS)
            upload = gui.add_upload_button('Upload URDF, xacro or SDF', icon=viser.Icon.UPLOAD)
        site.on_client_disconnect(self._places.forget)

        def rgb() -> Vector:
            red, green, blue = (part / 255.0 for part in colour.value)
            return red, green, blue

        place.on_click(lambda event: self._places.choose(event.client))
        add_shape.on_click(
            lambda event: self._insert(
                event.client,
                lambda _: library.shape(
                    shape(kind.value, size.value, mass.value, rgb(), static.value)
                ),
            )
        )
        add_light.on_click(
            lambda event: self._insert(
                event.client, lambda place: library.light(point_light(place, rgb()))
            )
        )
        remove_light.on_click(lambda _: attempt(self._remove_light, complain))
        add_model.on_click(
            lambda event: self._insert(
                event.client,
                lambda _: library.model(_chosen(self._models.value, 'model on the model path')),
            )
        )
        add_parameter.on_click(
            lambda event: self._insert(
                event.client,
                lambda _: library.parameter(
                    _chosen(self._parameters.value, 'parameter with a URDF')
                ),
            )
        )
        site.receive_files(
            upload,
            lambda client, name, content: self._insert(
                client, lambda _: library.file(name, content)
            ),
        )

    def open(self) -> None:
        """Look at once."""
        self._refreshes = 0

    def apply(self, change: SceneChange) -> None:
        """Offer the lights that there are."""
        self._lights = change.lights
        _offer(self._light, tuple(change.lights))

    def refresh(self) -> None:
        """Offer what there is, now and then; a slow simulator delays nothing."""
        if self._refreshes % LOOKS == 0 and not self._look.is_alive():
            self._look = threading.Thread(target=self._look_around, daemon=True)
            self._look.start()
        self._refreshes += 1

    def _look_around(self) -> None:
        _offer(self._models, [name for name in self._library.models() if name != GROUND_PLANE.name])
        _offer(self._parameters, self._library.parameters())

    def _insert(
        self, client: viser.ClientHandle | None, read: Callable[[Vector], ModelText]
    ) -> None:
        """Insert what `read` returns for the place of a browser."""

        def insert() -> None:
            place = self._places.take(client)
            text = replace(read(place), pose=Pose(place))
            name = self._hands.insert(text, on_ground=True, beside=True)
            self._selection.expect(name)
            self._history.add(f"insert '{name}'", lambda: self._hands.delete(name))
            missing = self._hands.omissions(name)
            if missing:
                more = f' and {len(missing) - LISTED} more' if len(missing) > LISTED else ''
                self._complain(
                    f"'{name}' was spawned without {', '.join(missing[:LISTED])}{more}; "
                    'the log of the simulator says why'
                )

        attempt(insert, self._complain)

    def _remove_light(self) -> None:
        name = self._light.value
        light = self._lights.get(name)
        if light is None:
            raise SimError('there is no light')
        self._hands.delete(name)
        self._history.add(
            f"delete '{name}'", lambda: self._hands.insert(self._library.light(light))
        )


def _offer(choice: Choice, names: Sequence[str]) -> None:
    choice.offer(names[:MOST] or (NONE,))


def _chosen(name: str, what: str) -> str:
    if name in ('', NONE):
        raise SimError(f'there is no {what}')
    return name
