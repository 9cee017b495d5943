"""A world with one robot as an environment of Gymnasium."""

import os
from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from ..sim import Model, Pose, SimError, World, yaw_of
from .actions import Actions, Limits
from .observations import observed
from .parent_watch import end_with_parent
from .pictures import Pictures
from .placement import Place, Range, move, move_freely
from .randomisation import Randomisation

ROSBOTS = 'package://rosbots_description/urdf/rosbots.xacro'
_ABOVE = Pose((0.0, 0.0, 0.5))
_NANOSECONDS = 1_000_000_000

Observation = dict[str, Any]
Info = dict[str, Any]


class SimEnv(gymnasium.Env[Observation, Any]):
    """A robot in a simulated world, driven in exact control periods of simulated time.

    An action is what the robot's plugins are told, as shares of the limits; an observation is a
    dict of what its sensors read at the end of the period. A subclass defines its task by `begin`,
    `observe`, `score` and `truth`. The same seed and actions give the same observations, bit for
    bit, in any process and after any other episodes.
    """

    metadata: dict[str, Any] = {'render_modes': ['rgb_array'], 'render_fps': 10}  # noqa: RUF012

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
        package_path: Sequence[str | os.PathLike[str]] = (),
        model_path: Sequence[str | os.PathLike[str]] = (),
    ) -> None:
        """Load the world and the robot, and let them come to rest.

        Args:
            world: an SDF file, or the name of one that is included, such as 'room'.
            robot: a URDF, xacro or SDF: path, package:// or model:// address, or text.
            pose: at which the robot is spawned.
            arguments: for a xacro file, such as {'laser': 'true'}.
            actions: the limits of each command, by the name of its plugin [as it takes them], or of
                a joint whose effort is to be set [N m or N]; by default those of all plugins, 1.
            sensors: names of sensors, or 'odometry'; by default all that can be observed.
            more: spaces of what `observe` adds.
            period: of control [s, simulated], a multiple of the world's step size.
            settle: time before the first episode, in which the robot comes to rest [s, simulated].
            randomise: what differs between episodes; by default only the noise of sensors.
            render_mode: one of the metadata's, or None.
            package_path: folders to search for package:// addresses.
            model_path: folders to search for model:// addresses.
        Raises:
            SimError: the world or the robot cannot be loaded, or has no such sensor or plugin.
            ValueError: a number is out of range.
        """
        if render_mode is not None and render_mode not in self.metadata['render_modes']:
            raise ValueError(f"render_mode is '{render_mode}'; it is one of "
                             f"{', '.join(self.metadata['render_modes'])}, or None")
        end_with_parent()
        self.render_mode = render_mode
        self._opened = lambda: World.from_file(
            world, package_path=package_path, model_path=model_path)
        self._spawned = robot, pose, dict(arguments or {})
        self._limits, self._sensors, self._settle = actions, sensors, settle
        self._randomise = randomise or Randomisation()
        self.world: World = self._opened()
        try:
            self._load()
            self._steps = _whole_steps(period, self.world)
            parts = {one.name: one.space for one in self._parts}
            self.observation_space = spaces.Dict({**parts, **(more or {})})
        except BaseException:
            self.world.close()
            raise
        self.period = period
        self.metadata = {**self.metadata, 'render_fps': max(1, round(1.0 / period))}

    def _load(self) -> None:
        """Spawn the robot, let it come to rest, and save the state that episodes start from."""
        robot, pose, arguments = self._spawned
        self.robot: Model = self.world.spawn(robot, pose=pose, arguments=arguments)
        self._actions = Actions(self.world, self.robot, self._limits)
        self.action_space = self._actions.space
        self._pictures = Pictures(self.world, self.robot)
        self._parts = observed(self.robot, self._sensors)
        self._randomise.require(self.world, self.robot)
        self.world.run(seconds=self._settle)
        self._floor = frozenset(self.world.touching(self.robot))
        self._start = self.world.save_state()
        self._started_ns = self.world.clock.now_ns
        self._ready = False

    # What a task defines.

    def begin(self, options: Mapping[str, Any]) -> None:
        """Prepare an episode: place the robot and draw goals by `self.np_random`.

        The world has just been restored. By default nothing is changed.

        Args:
            options: as given to `reset`.
        """

    def observe(self) -> Observation:
        """Return the observation of the world as it is now; a task adds the parts in `more`."""
        return {one.name: one.read() for one in self._parts}

    def score(self, observation: Observation, action: Any) -> tuple[float, bool]:  # noqa: ANN401
        """Return the reward of a control period, and whether it ended the episode.

        Args:
            observation: at the end of the period.
            action: during it.
        """
        raise NotImplementedError(f'{type(self).__name__} needs a method score(observation, action)'
                                  ' that returns the reward and whether the episode has ended')

    def truth(self) -> Info:
        """Return what is true of the world now, for `info`: time [s], pose (x, y, yaw) [m, rad]."""
        return {'time': (self.world.clock.now_ns - self._started_ns) / _NANOSECONDS,
                'pose': np.array(self.pose)}

    # What a task can ask.

    @property
    def pose(self) -> tuple[float, float, float]:
        """Return the robot's true x, y [m] and yaw [rad]."""
        (x, y, _), orientation = self.robot.pose
        return x, y, yaw_of(orientation)

    def place(self, x: float, y: float, yaw: float) -> None:
        """Move the robot to x, y [m] and a yaw [rad]; height, roll and pitch stay."""
        move(self.robot, (x, y, yaw))

    def place_freely(self, xs: Range, ys: Range) -> Place:
        """Move the robot to a random place, with any yaw, where it overlaps nothing; return it.

        Args:
            xs, ys: least and greatest x and y [m].
        Raises:
            SimError: no free place was found.
        """
        return move_freely(self.world, self.robot, self._floor, self.np_random, xs, ys)

    def bumps(self) -> bool:
        """Tell whether the robot touches a model that it did not touch at rest."""
        return any(name not in self._floor for name in self.world.touching(self.robot))

    # What Gymnasium defines.

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start an episode, and return its first observation and info.

        Args:
            seed: decides everything that is drawn at random, until the next seed.
            options: of the task.
        """
        super().reset(seed=seed)
        self._require_open()
        self.world.restore(self._start)
        drawn = self._randomise.apply(self.world, self.robot, self.np_random)
        self.begin(options or {})
        self._ready = True
        return self.observe(), {**self.truth(), 'randomised': drawn}

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, Info]:  # noqa: ANN401
        """Drive for a control period.

        Returns:
            observation, reward, whether the task has ended, whether the episode is truncated, info.

        Raises:
            ValueError: the action has the wrong shape, or a number in it is not finite.
            gymnasium.error.ResetNeeded: there was no `reset` yet.
        """
        if not self._ready:
            raise gymnasium.error.ResetNeeded('call reset() before step()')
        self._actions.give(action)
        self.world.run(self._steps)
        observation = self.observe()
        reward, terminated = self.score(observation, action)
        return observation, float(reward), bool(terminated), False, self.truth()

    def render(self) -> Any:  # noqa: ANN401
        """Return a picture (480, 640, 3) of the robot in its world, with render_mode 'rgb_array'.

        Raises:
            SimError: nothing can be drawn on this machine.
        """
        self._require_open()
        return self._pictures.take() if self.render_mode == 'rgb_array' else None

    def close(self) -> None:
        """Free the world; idempotent."""
        self._ready = False
        self.world.close()

    def _require_open(self) -> None:
        if getattr(self.world, '_closed', False):
            raise SimError('this environment is closed; make another one')


def _whole_steps(period: float, world: World) -> int:
    """Return the steps of a control period."""
    step_ns = world.clock.step_ns
    steps = round(period * _NANOSECONDS / step_ns) if 0.0 < period < np.inf else 0
    if steps < 1 or abs(steps * step_ns - period * _NANOSECONDS) > 0.5:
        raise ValueError(f'period is {period} s; it must be a multiple of the step size of the '
                         f'world, {step_ns / _NANOSECONDS:g} s')
    return steps
