"""Insert models: shapes, a light, models of the model path, robot descriptions, and files."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Protocol

import viser

from ...sim.core import Pose, SimError, Vector
from ...sim.description import LightSpec, ModelSpec, ModelText, SceneChange
from ..controls import Choice, Panel, attempt
from ..scene import GroundClicks, Selection
from ..site import Site
from .editor import Editor
from .history import History
from .inspector import States
from .shapes import KINDS, point_light, shape

MOST = 1000  # names that are offered
LISTED = 4  # parts that a model was spawned without
NONE = '(none)'
MODEL, PARAMETER = 'model on the model path', 'parameter with a URDF'
ASK_PLACE = 'Click on the ground where the next model is to appear.'


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
        client: viser.ClientHandle,
        site: Site,
        library: Library,
        offered: Callable[[], tuple[Sequence[str], Sequence[str]]],
        editor: Editor,
        states: States,
        selection: Selection,
        history: History,
        clicks: GroundClicks,
        complain: Callable[[str], None],
    ) -> None:
        """Add the controls; `offered` returns models of the model path, and parameters."""
        self._client, self._library, self._offered, self._editor = client, library, offered, editor
        self._states, self._selection, self._history = states, selection, history
        self._clicks, self._complain = clicks, complain
        self._place: Vector | None = None  # that was clicked on for the next model
        self._lights: Mapping[str, LightSpec] = {}
        gui = client.gui
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

        def rgb() -> Vector:
            red, green, blue = (part / 255.0 for part in colour.value)
            return red, green, blue

        def solid() -> ModelSpec:
            return shape(kind.value, size.value, mass.value, rgb(), static.value)

        def inserting(read: Callable[[Vector], ModelText]) -> Callable[[object], None]:
            return lambda _event: self._insert(read)

        place.on_click(lambda _: clicks.ask(client, ASK_PLACE, self._keep_place))
        add_shape.on_click(inserting(lambda _: library.shape(solid())))
        add_light.on_click(inserting(lambda place: library.light(point_light(place, rgb()))))
        remove_light.on_click(lambda _: attempt(self._remove_light, complain))
        add_model.on_click(inserting(lambda _: library.model(_chosen(self._models, MODEL))))
        add_parameter.on_click(
            inserting(lambda _: library.parameter(_chosen(self._parameters, PARAMETER)))
        )
        site.receive_files(
            upload, lambda _, name, content: self._insert(lambda _: library.file(name, content))
        )

    def apply(self, change: SceneChange) -> None:
        """Offer the lights that there are."""
        self._lights = change.lights
        _offer(self._light, tuple(change.lights))

    def refresh(self) -> None:
        """Offer what there is."""
        models, parameters = self._offered()
        _offer(self._models, models)
        _offer(self._parameters, parameters)

    def _insert(self, read: Callable[[Vector], ModelText]) -> None:
        """Insert what `read` returns for the place of the browser."""

        def insert() -> None:
            place = self._take_place()
            text = replace(read(place), pose=Pose(place))
            name = self._editor.insert(text, on_ground=True, beside=True)
            self._selection.expect(name)
            self._history.add(f"insert '{name}'", partial(self._editor.delete, name))
            missing = self._states.omissions(name)
            if missing:
                more = f' and {len(missing) - LISTED} more' if len(missing) > LISTED else ''
                self._complain(
                    f"'{name}' was spawned without {', '.join(missing[:LISTED])}{more}; "
                    'the log of the simulator says why'
                )

        with self._history.turn:
            attempt(insert, self._complain)

    def _keep_place(self, client: viser.ClientHandle, point: Vector) -> None:
        self._place = point
        self._clicks.mark(client, point)

    def _take_place(self) -> Vector:
        """Return the place that was clicked on, once; else the one that the camera looks at [m]."""
        place, self._place = self._place, None
        if place is not None:
            self._clicks.unmark(self._client)
            return place
        x, y, _ = self._client.camera.look_at
        return float(x), float(y), 0.0

    def _remove_light(self) -> None:
        with self._history.turn:
            name = self._light.value
            light = self._lights.get(name)
            if light is None:
                raise SimError('there is no light')
            text = self._library.light(light)
            self._editor.delete(name)
            self._lights = {one: self._lights[one] for one in self._lights if one != name}
            self._history.add(f"delete '{name}'", partial(self._editor.insert, text))


def _offer(choice: Choice, names: Sequence[str]) -> None:
    choice.offer(names[:MOST] or (NONE,))


def _chosen(choice: Choice, what: str) -> str:
    name = choice.value
    if name in ('', NONE):
        raise SimError(f'there is no {what}')
    return name
