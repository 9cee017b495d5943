"""A world with one robot as an environment of Gymnasium."""

import importlib.util
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.core import RenderFrame

from ..sim import Model, Pose, SimError, World
from ..sim.rendering import Figure
from .actions import Action, Limits
from .parent_watch import end_with_parent
from .placement import Place, Range
from .randomisation import Randomisation
from .stage import Setting, Stage

if TYPE_CHECKING:
    from ..viewer import Window

ROSBOTS = 'package://rosbots_description/urdf/rosbots.xacro'
_ABOVE = Pose((0.0, 0.0, 0.5))

Observation = dict[str, Any]
Info = dict[str, Any]


class SimEnv(gymnasium.Env[Observation, Any]):
    """A robot in a simulated world, driven in exact control periods of simulated time.

    An action is what the robot's plugins are told, as shares of the limits; an observation is a
    dict of what its sensors read at the end of the period. A subclass defines its task by `begin`,
    `observe`, `score` and `truth`. The same seed and actions give the same observations, bit for
    bit, in any process and after any other episodes.
    """

    metadata: dict[str, Any] = {'render_modes': ['rgb_array', 'web'], 'render_fps': 10}  # noqa: RUF012

    def __init__(
        self,
        world: str | os.PathLike[str] = 'empty',
        robot: str | os.PathLike[str] = ROSBOTS,
        *,
        pose: Pose = _ABOVE,
        arguments: Mapping[str, str] | None = None,
        actions: Limits | None = None,
        sensors: Sequence[str] | None = None,
        more: Mapping[str, spaces.Space[Any]] | None = None,
        period: float = 0.1,
        settle: float = 1.0,
        randomise: Randomisation | None = None,
        render_mode: str | None = None,
        web_port: int = 0,
        package_path: Sequence[str | os.PathLike[str]] = (),
        model_path: Sequence[str | os.PathLike[str]] = (),
        controllers: Mapping[str, object] | None = None,
    ) -> None:
        """Load the world and the robot, and let them come to rest.

        Args:
            world: an SDF file, or the name of one that is included, such as 'room'.
            robot: a URDF, xacro or SDF: path, package:// or model:// address, or text.
            pose: at which the robot is spawned.
            arguments: for a xacro file, such as {'laser': 'true'}.
            actions: the limits of each command, by the name of its plugin or controller [as it
                takes them], or of a joint whose effort is to be set [N m or N]; by default those of
                all plugins and controllers, 1.
            sensors: names of sensors, or 'odometry'; by default all that can be observed.
            more: spaces of what `observe` adds.
            period: of control [s, simulated], a multiple of the world's step size.
            settle: time before the first episode, in which the robot comes to rest [s, simulated].
            randomise: what differs between episodes; by default only the noise of sensors.
            render_mode: 'rgb_array', 'web' or None; see `render`.
            web_port: of the page, 0 for any that is free.
            package_path: folders to search for package:// addresses.
            model_path: folders to search for model:// addresses.
            controllers: of ros_control, to be started: the parameters in the robot's namespace,
                nested as in YAML.
        Raises:
            SimError: the world or the robot cannot be loaded, or has no such sensor, plugin or
                controller.
            ValueError: a number is out of range.
        """
        self._require_mode(render_mode)
        end_with_parent()
        self.render_mode = render_mode
        if not isinstance(randomise, Randomisation | None):
            raise ValueError(f'randomise is {randomise!r}; it takes a Randomisation, or None')
        self._randomise = randomise or Randomisation()
        self._stage = Stage(
            Setting(
                world,
                robot,
                pose,
                dict(arguments or {}),
                actions,
                sensors,
                settle,
                package_path,
                model_path,
                dict(controllers or {}),
            )
        )
        try:
            self._randomise.require(self.world, self.robot)
            self._steps = self._stage.whole_steps(period)
            self._window = open_window(self.world, web_port) if render_mode == 'web' else None
        except BaseException:
            self._stage.close()
            raise
        parts = {one.name: one.space for one in self._stage.observed}
        self.observation_space = spaces.Dict({**parts, **(more or {})})
        self.action_space = self._stage.actions.space
        modes = [mode for mode in self.metadata['render_modes'] if mode != 'web' or has_window()]
        self.metadata = {
            **self.metadata,
            'render_modes': modes,
            'render_fps': max(1, round(1.0 / period)),
        }
        self._ready = False

    def __repr__(self) -> str:
        """Return what Gymnasium calls it: its class, and its name there."""
        return str(self)

    def _require_mode(self, render_mode: str | None) -> None:
        modes = self.metadata['render_modes']
        if render_mode is not None and render_mode not in modes:
            raise ValueError(
                f"render_mode is '{render_mode}'; it is one of {', '.join(modes)}, or None"
            )

    # What a task defines.

    def begin(self, options: Mapping[str, Any]) -> None:
        """Prepare an episode: place the robot and draw goals by `self.np_random`.

        The world has just been restored. By default nothing is changed.

        Args:
            options: as given to `reset`.
        """

    def observe(self) -> Observation:
        """Return the observation of the world as it is now; a task adds the parts in `more`."""
        return {one.name: one.read() for one in self._stage.observed}

    def score(self, observation: Observation, action: Action) -> tuple[float, bool]:
        """Return the reward of a control period, and whether it ended the episode.

        Args:
            observation: at the end of the period.
            action: during it.
        """
        raise NotImplementedError(
            f'{type(self).__name__} needs a method score(observation, action)'
            ' that returns the reward and whether the episode has ended'
        )

    def truth(self) -> Info:
        """Return what is true of the world now, for `info`: time [s], pose (x, y, yaw) [m, rad]."""
        return {'time': self._stage.time, 'pose': np.array(self.pose)}

    def figures(self) -> Sequence[Figure]:
        """Return what pictures show besides the world, such as a goal; by default nothing."""
        return ()

    # What a task can ask.

    @property
    def world(self) -> World:
        """Return the world of this episode."""
        return self._stage.world

    @property
    def robot(self) -> Model:
        """Return the robot of this episode."""
        return self._stage.robot

    @property
    def pose(self) -> Place:
        """Return the robot's true x, y [m] and yaw [rad]."""
        return self._stage.pose

    def place(self, x: float, y: float, yaw: float) -> None:
        """Move the robot to x, y [m] and a yaw [rad]; height, roll and pitch stay."""
        self._stage.place((x, y, yaw))

    def place_freely(self, xs: Range, ys: Range) -> Place:
        """Move the robot to a random place, with any yaw, where it overlaps nothing; return it.

        Args:
            xs, ys: least and greatest x and y [m].
        Raises:
            SimError: no free place was found.
        """
        return self._stage.place_freely(self.np_random, xs, ys)

    def bumps(self) -> bool:
        """Tell whether the robot touches a model that it did not touch at rest."""
        return self._stage.bumps()

    # What Gymnasium defines.

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start an episode, and return its first observation and info.

        In info, `faults` are those of the descriptions, and new ones.

        Args:
            seed: decides everything that is drawn at random, until the next seed.
            options: of the task.
        """
        super().reset(seed=seed)
        self._stage.restore()
        drawn = self._randomise.apply(self.world, self.robot, self.np_random)
        self.begin(options or {})
        self._ready = True
        if self._window is not None:
            self._window.show(self.world)
        faults = (*self._stage.found, *self._stage.new_faults())
        return self.observe(), {**self.truth(), 'randomised': drawn, 'faults': faults}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, Info]:
        """Drive for a control period.

        Returns:
            observation, reward, whether the task has ended, whether the episode is truncated
            because numbers of the world were no longer finite, and info, with a tuple of new
            `faults`.

        Raises:
            ValueError: the action has the wrong shape, or a number in it is not finite.
            gymnasium.error.ResetNeeded: there was no `reset` yet.
        """
        if not self._ready:
            raise gymnasium.error.ResetNeeded('call reset() before step()')
        self._stage.actions.give(action)
        advance = self.world.run if self._window is None else self._window.run
        advance(self._steps)
        observation = self.observe()
        reward, terminated = self.score(observation, action)
        return (
            observation,
            float(reward),
            bool(terminated),
            self._stage.has_diverged,
            {**self.truth(), 'faults': self._stage.new_faults()},
        )

    def render(self) -> RenderFrame | list[RenderFrame] | None:
        """Return what `render_mode` asks for.

        By 'rgb_array' a picture (480, 640, 3) of the robot in its world, and of `figures`. By 'web'
        the address of a page on this machine, which shows every step; while a browser is connected,
        time runs at the speed that is chosen there. None otherwise.

        Raises:
            SimError: nothing can be drawn on this machine.
        """
        if self._window is not None:
            return self._window.address
        if self.render_mode != 'rgb_array':
            return None
        return self._stage.pictures.take(self.figures() if self._ready else ())

    def close(self) -> None:
        """Free the world; idempotent."""
        self._ready = False
        self._stage.close()
        if self._window is not None:
            self._window.close()
            self._window = None


def has_window() -> bool:
    """Tell whether what a page needs is installed."""
    return importlib.util.find_spec('viser') is not None


def open_window(world: World, port: int) -> 'Window':
    """Return a page that shows a world.

    Raises:
        SimError: viser is not installed, or the port is in use.
    """
    if not has_window():
        raise SimError(
            "render_mode 'web' needs the Python package viser; "
            "pip install 'rosbots_description[web]' installs it"
        )
    from ..viewer import Window

    return Window(world, port)
