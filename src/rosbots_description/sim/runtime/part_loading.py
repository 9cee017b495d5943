"""Load the plugins and sensors of a model that is being spawned."""

import logging
from collections.abc import Collection
from itertools import chain, count
from typing import TYPE_CHECKING

from ..core import Fault, FaultPlace, SimError, reporting_to, shortened
from ..description import PluginSpec, SensorSpec
from ..plugin_registry import (
    PAGE,
    library_name,
    library_remark,
    missing_libraries,
    plugin_class,
    sensor_class,
    sensor_plugin_class,
)
from .model import Link, Model
from .model_part import ModelPart
from .plugin import Plugin

if TYPE_CHECKING:
    from .world import World


class PartLoader:
    """Gives one model its plugins and sensors; what is left out is reported and listed."""

    def __init__(self, world: 'World', model: Model) -> None:
        self._world, self._model = world, model

    def load(self) -> None:
        """Load, start and schedule all plugins, then all sensors with theirs."""
        model = self._model
        for plugin in model.spec.plugins:
            self._load_plugin(plugin)
        for link in model.links.values():
            for sensor in link.spec.sensors:
                self._load_sensor(link, sensor)

    def _load_plugin(self, spec: PluginSpec) -> None:
        where = f"model '{self._model.name}', plugin '{spec.name}'"
        cls = plugin_class(spec.filename)
        plugin = None if cls is None else cls(self._world, self._model, spec)
        self._start_plugin(spec, plugin, where, f"plugin '{spec.filename}'")

    def _load_sensor(self, link: Link, spec: SensorSpec) -> None:
        """Give a link a sensor; what is not simulated of it is named."""
        model, kind = self._model, spec.type or 'sensor'
        called = shortened(f"{kind} '{spec.name}'", 100)
        where = f"model '{model.name}', {called} of link '{link.name}'"
        cls = sensor_class(spec.type) or sensor_class('')
        if cls is None:  # nobody has loaded any sensors
            return
        sensor = cls(self._world, link, spec)
        if not self._start(sensor, where, called):
            return
        scope = f'{link.name}::{sensor.name}'
        model.sensors[free_key(model.sensors, sensor.name, scope)] = sensor
        for inner in spec.plugins:
            plugin_cls = sensor_plugin_class(inner.filename)
            plugin = None if plugin_cls is None else plugin_cls(sensor, inner)
            self._start_plugin(inner, plugin, where, f'{called} ({inner.filename})', scope)
        if not (spec.plugins or sensor.measures):
            what = f'{where}: sensors of this type are not simulated yet'
            self._leave_out(called, Fault(what, cure=f'see {PAGE}', **sensor.place))

    def _start_plugin(
        self, spec: PluginSpec, plugin: Plugin | None, where: str, called: str, scope: str = ''
    ) -> None:
        """Load a plugin; None stands for one whose library is not here.

        Args:
            spec: of the plugin, as the rest.
            plugin: in the model, or in a sensor.
            where: it is, for messages.
            called: what it is, for messages.
            scope: of the sensor, LINK::SENSOR; '' for a plugin in the model.
        """
        if plugin is None:
            known = library_name(spec.filename) in missing_libraries()
            severity = logging.WARNING if known else logging.ERROR
            what = f'{where}: {library_remark(spec.filename)}'
            place: FaultPlace = {
                'model': self._model.name,
                'element': called,
                'line': spec.element.line,
            }
            self._leave_out(called, Fault(what, severity, cure=f'see {PAGE}', **place))
        elif self._start(plugin, where, called):
            plugins = self._model.plugins
            inner = f'{scope}::{plugin.name}' if scope else plugin.name
            plugins[free_key(plugins, plugin.name, inner)] = plugin

    def _start(self, part: ModelPart, where: str, called: str) -> bool:
        """Start and schedule a plugin or sensor; after an error the model is spawned without it."""
        try:
            with reporting_to(self._world.faults.add, **part.place):
                part.start()
        except SimError as error:
            what = f'{where}: {error}; the model is spawned without it'
            self._leave_out(called, Fault(what, logging.ERROR, **part.place))
            return False
        self._world.schedule.add(part)
        return True

    def _leave_out(self, called: str, fault: Fault) -> None:
        self._model.left_out.append(called)
        self._world.faults.add(fault)


def free_key(taken: Collection[str], name: str, scoped_name: str) -> str:
    """Return the name, or the scoped name, or this with a number: the first that is not taken."""
    if name not in taken:
        return name
    numbered = (f'{scoped_name}_{number}' for number in count(2))
    return next(key for key in chain((scoped_name,), numbered) if key not in taken)
