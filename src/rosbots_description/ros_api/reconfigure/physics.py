"""Physics settings for dynamic_reconfigure: rqt_reconfigure, dynparam and its Python client.

Publishes:
    ~parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    ~parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    ~set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    ~time_step and the others of `PARAMETERS`, written only: presets are overwritten.
"""

import contextlib
import logging

from dynamic_reconfigure.encoding import Config, encode_config
from dynamic_reconfigure.server import Server as ReconfigureServer
from gazebo_msgs.msg import ODEPhysics
from gazebo_msgs.srv import (
    GetPhysicsPropertiesRequest,
    GetPhysicsPropertiesResponse,
    SetPhysicsPropertiesRequest,
)
from genpy import Message
from geometry_msgs.msg import Vector3

from ..server import Server
from ..services import SERVICES, respond
from ..transport import NO_MASTER, write_parameters
from .parameters import Parameter, description

logger = logging.getLogger(__name__)

PARAMETERS = (
    Parameter('time_step', 0.001, 0.0, 10.0, 'simulated time of one step [s]'),
    Parameter('max_update_rate', 60.0, 0.0, 1000.0, 'steps per second of wall time [Hz], 0: all'),
    Parameter('gravity_x', 0.0, -100.0, 100.0, 'gravity along x [m/s^2]'),
    Parameter('gravity_y', 0.0, -100.0, 100.0, 'gravity along y [m/s^2]'),
    Parameter('gravity_z', -9.8, -100.0, 100.0, 'gravity along z [m/s^2]'),
    Parameter('auto_disable_bodies', False, False, True, 'kept, without effect here'),
    Parameter('sor_pgs_precon_iters', 0, 0, 10000, 'kept, without effect here'),
    Parameter('sor_pgs_iters', 20, 0, 10000, 'iterations of the solver in each step'),
    Parameter('sor_pgs_w', 1.3, 0.0, 5.0, 'kept, without effect here'),
    Parameter('sor_pgs_rms_error_tol', -1.0, -1.0, 10000.0, 'kept, without effect here'),
    Parameter('cfm', 0.0, 0.0, 10.0, 'kept, without effect here'),
    Parameter('erp', 0.2, 0.0, 10.0, 'kept, without effect here'),
    Parameter('contact_surface_layer', 0.001, 0.0, 10.0, 'kept, without effect here [m]'),
    Parameter('contact_max_correcting_vel', 100.0, 0.0, 1e7, 'kept, without effect here [m/s]'),
    Parameter('max_contacts', 100, 0, 10_000_000, 'kept, without effect here'),
)


def advertise_reconfigure(server: Server) -> None:
    """Advertise the settings; needs the running loop, and makes calls to the ROS master."""
    reconfigure = PhysicsReconfigure(server)
    server.physics_listeners.append(lambda: server.registrar.post(reconfigure.publish_changes))
    server.parameters.append(reconfigure.write)
    logger.info('Physics dynamic reconfigure ready.')


class PhysicsReconfigure(ReconfigureServer):  # type: ignore[misc]  # it has no types
    """Lets dynamic_reconfigure show and change the physics; called from ROS's threads."""

    config: Config

    def __init__(self, server: Server) -> None:
        self._server = server
        super().__init__(description(PARAMETERS), self._reconfigure)

    def publish_changes(self) -> None:
        """Publish settings that a service has changed."""
        with self.mutex:
            current = self._current(self.config)
            if current is not None and current != self.config:
                self.config = current
                self._copy_to_parameter_server()
                self.update_topic.publish(encode_config(current))

    def write(self) -> None:
        """Write the settings as parameters."""
        with self.mutex:
            self._copy_to_parameter_server()

    def _copy_from_parameter_server(self) -> None:
        """Do nothing: as in Gazebo, presets are overwritten by the current settings."""

    def _copy_to_parameter_server(self) -> None:
        """Write all in one call; a new master gets them later, by `write`."""
        with contextlib.suppress(*NO_MASTER):
            write_parameters({p.name: self.config[p.name] for p in PARAMETERS})

    def _reconfigure(self, config: Config, _level: int) -> Config:
        """Apply the settings that differ from those shown last; return the current settings.

        Unchanged settings are not applied: they may be out of date since a service changed them, or
        defaults of the library that the world never had.
        """
        current = self._current(config)
        if current is None:
            return self.config
        requested = {
            p.name: type(p.default)(config[p.name])
            for p in PARAMETERS
            if config[p.name] != self.config[p.name]
        }
        if any(current[name] != value for name, value in requested.items()):
            response = self._call('set_physics_properties', _set_request({**current, **requested}))
            if response.success:
                current.update(requested)
                logger.info('physics dynamics reconfigure update complete')
        logger.info('physics dynamics reconfigure complete')
        return current

    def _current(self, config: Config) -> Config | None:
        """Return a copy of `config` with the current settings; None if they are unavailable."""
        response = self._call('get_physics_properties', GetPhysicsPropertiesRequest())
        if not response.success:
            return None
        current = Config({p.name: config[p.name] for p in PARAMETERS})
        current['groups'] = config['groups']
        current.update(settings(response))
        return current

    def _call(self, name: str, request: Message) -> Message:
        return respond(self._server, SERVICES[name], request)


def settings(response: GetPhysicsPropertiesResponse) -> dict[str, float | int | bool]:
    """Return the settings by the names of the parameters."""
    gravity, ode = response.gravity, response.ode_config
    return {
        'time_step': response.time_step,
        'max_update_rate': response.max_update_rate,
        'gravity_x': gravity.x,
        'gravity_y': gravity.y,
        'gravity_z': gravity.z,
        **{field: getattr(ode, field) for field in ODEPhysics.__slots__},
    }


def _set_request(wanted: dict[str, float | int | bool]) -> SetPhysicsPropertiesRequest:
    return SetPhysicsPropertiesRequest(
        time_step=wanted['time_step'],
        max_update_rate=wanted['max_update_rate'],
        gravity=Vector3(wanted['gravity_x'], wanted['gravity_y'], wanted['gravity_z']),
        ode_config=ODEPhysics(**{field: wanted[field] for field in ODEPhysics.__slots__}),
    )
