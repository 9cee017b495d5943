"""The world for scripts: models from files and texts, plugins, time, forces."""

import importlib.util
import math
import os
from collections.abc import Callable, Collection, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Self, SupportsIndex

from .. import controllers, plugins, runtime, sensors  # noqa: F401  register what is loaded
from ..core import (
    NANOSECONDS,
    NotFoundError,
    Pose,
    Receiver,
    SimError,
    Vector,
    compose,
    from_rpy,
    reporting_to,
)
from ..description import ModelSpec, PhysicsSettings
from ..formats import open_world, sdf_of_world
from ..mapping import OccupancyGrid, occupancy_grid, write_map
from ..physics import CompiledModel, EngineFactory, make_engine
from ..resources import find_world, model_names, path_directories, write_world
from ..runtime import Joint, Link, Model, add_empty_world, describe, populate
from .descriptions import Description, Descriptions, Paths

if TYPE_CHECKING:
    from ...viewer import Recording, Viewer

_LIBRARY = Path(__file__).resolve().parents[2]  # holds worlds/
_NO_VECTOR: Vector = (0.0, 0.0, 0.0)


class World(runtime.World):
    """A simulated world: models, their plugins and time; for a `with` statement, or `close` it.

    One thread owns it: no method may be called from another. Time advances by `step` and `run`
    only. The same calls in the same order give the same numbers, bit for bit.
    """

    def __init__(
        self,
        physics: PhysicsSettings | None = None,
        *,
        package_path: Paths = (),
        model_path: Paths = (),
        make_engine: EngineFactory = make_engine,
        on_fault: Receiver | None = None,
    ) -> None:
        """Open an empty world, without even a ground.

        Args:
            physics: step size [s], gravity [m/s^2] and the rest; by default 1 ms and -9.8 along z.
            package_path: folders to search for package:// addresses, before ROS_PACKAGE_PATH and
                after the package that a description's own file lies in.
            model_path: folders to search for model:// addresses, before GAZEBO_MODEL_PATH.
            make_engine: makes the physics engine.
            on_fault: called with each `Fault` when it is reported, on the thread that reports; by
                default it is logged. `faults` has them all, each once.
        """
        self._closed = False
        self._run: Callable[[int], int] = super().run
        self._descriptions = Descriptions(package_path, model_path)
        super().__init__(physics, make_engine, on_fault)

    @classmethod
    def empty(
        cls,
        physics: PhysicsSettings | None = None,
        *,
        package_path: Paths = (),
        model_path: Paths = (),
        make_engine: EngineFactory = make_engine,
        on_fault: Receiver | None = None,
    ) -> Self:
        """Return Gazebo's empty world: a ground plane at z = 0, and the sun.

        The arguments are those of `World`.
        """
        world = cls(
            physics,
            package_path=package_path,
            model_path=model_path,
            make_engine=make_engine,
            on_fault=on_fault,
        )
        add_empty_world(world)
        return world

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        package_path: Paths = (),
        model_path: Paths = (),
        seed: int = 0,
        make_engine: EngineFactory = make_engine,
        on_fault: Receiver | None = None,
    ) -> Self:
        """Return the world that an SDF file describes.

        A model that cannot be simulated is left out, which is an error in `faults`.

        Args:
            path: of the file; or the name of one along GAZEBO_RESOURCE_PATH or among our own:
                'empty', 'maze', 'room', 'shapes'.
            package_path: see `World`.
            model_path: see `World`.
            seed: of the noise of sensors.
            make_engine: see `World`.
            on_fault: see `World`.
        Raises:
            NotFoundError: there is no such file.
            ModelError: it is not SDF with a <world>, or a number of the world is not valid.
        """
        places = [*path_directories(os.environ.get('GAZEBO_RESOURCE_PATH', '')), str(_LIBRARY)]
        file = find_world(os.fspath(path), places)
        world = cls(
            package_path=package_path,
            model_path=model_path,
            make_engine=make_engine,
            on_fault=on_fault,
        )
        world.seed = seed
        try:
            with reporting_to(world.faults.add):
                spec = open_world(
                    file,
                    find_model=world._descriptions.find_model,
                    find_package=world._descriptions.packages(os.fspath(file)),
                    find_file=world._descriptions.find_file,
                )
            populate(world, spec)
        except BaseException:
            world.close()
            raise
        return world

    def __enter__(self) -> Self:
        """Return the world."""
        return self

    def __repr__(self) -> str:
        """Return its time and models."""
        return f'<World at {self.clock.now} s with {", ".join(self.models) or "no model"}>'

    def __exit__(self, *_exception: object) -> None:
        """Close the world."""
        self.close()

    def close(self) -> None:
        """Free the world's resources; it cannot be used afterwards. Idempotent."""
        if not self._closed:
            self._closed = True
            super().close()

    @property
    def time(self) -> float:
        """Return the simulated time [s]."""
        return self.clock.now

    def spawn(
        self,
        model: Description | ModelSpec | CompiledModel,
        name: str = '',
        pose: Pose | None = None,
        *,
        x: float = 0.0,
        y: float = 0.0,
        z: float = 0.0,
        yaw: float = 0.0,
        arguments: Mapping[str, str] | None = None,
    ) -> Model:
        """Spawn a model and load its plugins.

        A plugin that fails is an error in `faults`, and the model is spawned without it.

        Args:
            model: a URDF, xacro or SDF: the path of a file, its package:// or model:// address, or
                the text itself. A file whose name ends with .xacro is expanded. Or the result of
                `compile`, which saves time for repeated spawns.
            name: of the model in this world; '' for the one in the description.
            pose: of the model's frame in the world, in place of x, y, z and yaw.
            x: position of the model's frame in the world [m].
            y: the same.
            z: the same; 0 puts the frame's origin on the ground.
            yaw: of the model's frame about z, counter-clockwise [rad].
            arguments: for a xacro file, as in `NAME:=VALUE`.
        Raises:
            ModelError: the description cannot be read or simulated, the name is taken, or the pose
                is too far away. The message says where and why.
            ValueError: a number is not finite, or both `pose` and one of x, y, z, yaw are given.
        """
        self._require_open()
        if pose is None:
            pose = Pose((x, y, z), from_rpy(0.0, 0.0, yaw))
        elif any((x, y, z, yaw)):
            raise ValueError('spawn takes either pose or x, y, z and yaw, not both')
        _require_finite('the pose', (*pose.position, *pose.orientation))
        if isinstance(model, ModelSpec):
            return super().spawn(model, name or model.name, pose)
        if isinstance(model, CompiledModel):
            return super().spawn(model, name or model.spec.name, pose)
        spec, own_pose = self.read_model(model, name, arguments=arguments)
        return super().spawn(spec, spec.name, compose(pose, own_pose))

    def read_model(
        self, model: Description, name: str = '', *, arguments: Mapping[str, str] | None = None
    ) -> tuple[ModelSpec, Pose]:
        """Return the description of a model for `spawn`, and the pose that its text gives it.

        Args:
            model: as in `spawn`; name: '' for the one in the description.
            arguments: for a xacro file.
        Raises:
            ModelError: it cannot be read or simulated.
        """
        with reporting_to(self.faults.add):
            return self._descriptions.read(model, name, arguments or {})

    def available_models(self) -> list[str]:
        """Return the names of the models along `model_path` and GAZEBO_MODEL_PATH."""
        return model_names(self._descriptions.find_model)

    def show(self, *, port: int = 0, height: int = 600) -> 'Viewer':
        """Show this world on a page in the browser; in a notebook, below the cell.

        From now on `run` keeps to the pace of the page while a browser is connected. In a notebook
        the world runs between two cells, too, once Play is clicked on.

        Args:
            port: of the page on this machine; 0 for any that is free.
            height: of the page in a notebook [pixels].
        Returns:
            the page; its `serve` runs the world until Ctrl-C.

        Raises:
            SimError: the port is in use, or viser is not installed.
        """
        self._require_open()
        _require_viser('World.show')
        from ...viewer import show

        return show(self, port, height)

    def recording(self, path: str | os.PathLike[str] | None = None) -> 'Recording':
        """Record what moves from now on, as a page that plays in any browser; for `with`.

        Args:
            path: of the file that is written at the end, such as 'drive.html'; without one the
                recording is in `html`, and a notebook shows it.
        Raises:
            SimError: viser is not installed.
        """
        self._require_open()
        _require_viser('World.recording')
        from ...viewer import Recording

        return Recording(self, path)

    def run_by(self, run: Callable[[int], int] | None) -> None:
        """Let `run` advance by that function from now on: steps -> steps made; None: by itself."""
        self._run = super().run if run is None else run

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> tuple[str, ...]:
        """Write the world as it stands as a world file, for `from_file`.

        There every pose is the same to the last bit, and the motion goes on. Plugins and sensors
        begin anew: odometry, noise and commands are not in the file. Saving moves models by
        rounding errors, to poses that can be restored.

        Args:
            path: ends in .world or .sdf.
            overwrite: whether there may be a file already.
        Returns:
            what else of the world is not in the file, a few words each.

        Raises:
            SimError: the path ends otherwise, the file exists or cannot be written.
        """
        self._require_open()
        spec = describe(self)
        write_world(os.path.abspath(path), sdf_of_world(spec), overwrite)
        return spec.faults

    def occupancy_grid(
        self,
        height: float,
        resolution: float = 0.05,
        *,
        without: Collection[str] = (),
        margin: float = 1.0,
    ) -> OccupancyGrid:
        """Return the map of a horizontal section through the world; see `sim.mapping`.

        Args:
            height: of the section, z in the world [m].
            resolution: edge of a cell [m].
            without: models to leave out besides those with joints, as robots are.
            margin: free space around everything [m].
        Raises:
            NotFoundError: there is no model of a name in `without`.
            SimError: the map would be too large, or a mesh cannot be read.
            ValueError: a number is out of range.
        """
        self._require_open()
        return occupancy_grid(self, height, resolution, without=without, margin=margin)

    def save_map(
        self,
        path: str | os.PathLike[str],
        height: float,
        resolution: float = 0.05,
        *,
        without: Collection[str] = (),
        margin: float = 1.0,
        overwrite: bool = False,
    ) -> OccupancyGrid:
        """Write that map as NAME.pgm and NAME.yaml, for map_server; return it.

        Args:
            path: NAME or NAME.yaml.
            height: see `occupancy_grid`, as for all but the last.
            resolution: [m]
            without: names of models.
            margin: [m]
            overwrite: whether there may be files already.
        Raises:
            SimError: a file exists or cannot be written; or as `occupancy_grid`.
        """
        grid = self.occupancy_grid(height, resolution, without=without, margin=margin)
        write_map(grid, os.fspath(path), overwrite)
        return grid

    def model(self, name: str) -> Model:
        """Return the model of that name.

        Raises:
            NotFoundError: there is none; the message lists the models that exist.
        """
        if name not in self.models:
            raise NotFoundError(
                f"there is no model '{name}' in this world; its models: "
                f'{", ".join(self.models) or "none"}'
            )
        return self.models[name]

    def step(self, steps: int = 1) -> int:
        """Advance by `steps`; see `run`."""
        return self.run(steps)

    def run(self, steps: int | None = None, *, seconds: float | None = None) -> int:
        """Advance simulated time, as fast as the computer can.

        Args:
            steps: how many, at least 0.
            seconds: or how long [s], rounded to whole steps.
        Returns:
            the number of steps made: all, or fewer where time ends after 136 years.

        Raises:
            ValueError: a number is negative or not finite, `steps` is a fraction, or not exactly
                one of both is given.
        """
        self._require_open()
        if seconds is not None and steps is None:
            _require_finite('seconds', (seconds,))
            steps = round(seconds * NANOSECONDS / self.clock.step_ns)
        elif steps is None or seconds is not None:
            raise ValueError('run takes either a number of steps or seconds=')
        elif not isinstance(steps, SupportsIndex):
            raise ValueError(
                f'run takes a whole number of steps, not {steps}; for a time give seconds={steps}'
            )
        if steps < 0:
            raise ValueError(f'time goes forward only; {steps} steps cannot be made')
        return self._run(steps)

    def apply_wrench(
        self,
        link: Link,
        force: Vector = _NO_VECTOR,
        torque: Vector = _NO_VECTOR,
        *,
        seconds: float = math.inf,
    ) -> None:
        """Apply a wrench to a link from the next step on, added to all other forces.

        Args:
            link: of a model in this world.
            force: (x, y, z) [N] in world axes, at the link's centre of mass.
            torque: (x, y, z) [N m] in world axes.
            seconds: how long [s, simulated]; by default until `clear_forces`.
        Raises:
            ValueError: a number is not finite, or `seconds` is negative.
        """
        _require_finite('force and torque', (*force, *torque))
        self.external_forces.add(
            link, partial(link.apply_wrench, force, torque), 0, _duration_ns(seconds)
        )

    def apply_effort(self, joint: Joint, effort: float, *, seconds: float = math.inf) -> None:
        """Apply an effort to a joint from the next step on, added to its motor's; limits hold.

        Args:
            joint: of a model in this world.
            effort: [N m or N], positive along the joint's axis.
            seconds: how long [s, simulated]; by default until `clear_forces`.
        Raises:
            ValueError: a number is not finite, or `seconds` is negative.
        """
        _require_finite('effort', (effort,))
        self.external_forces.add(
            joint, partial(joint.apply_effort, effort), 0, _duration_ns(seconds)
        )

    def clear_forces(self, target: Link | Joint) -> None:
        """End all forces of `apply_wrench` or `apply_effort` on a link or joint."""
        self.external_forces.cancel(lambda one: one is target)

    def _require_open(self) -> None:
        if self._closed:
            raise SimError('this world is closed; open another one')


def _require_viser(what: str) -> None:
    if importlib.util.find_spec('viser') is None:
        raise SimError(
            f'{what} needs the Python package viser; '
            "pip install 'rosbots_description[web]' installs it"
        )


def _require_finite(what: str, numbers: tuple[float, ...]) -> None:
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f'{what} takes finite numbers; it got {numbers}')


def _duration_ns(seconds: float) -> int:
    """Return a duration [ns], negative for an infinite one."""
    if math.isnan(seconds) or seconds < 0.0:
        raise ValueError(f'seconds is {seconds}; a force is applied for at least 0 s')
    return -1 if math.isinf(seconds) else round(seconds * NANOSECONDS)
