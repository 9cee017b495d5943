"""What of the wheel slip plugin is on the wire: its dynamic_reconfigure server."""

from ...sim.plugins.wheel_slip import WheelSlip
from ..names import topic_name
from ..server import Server
from .registry import Adapter, adapter


@adapter(WheelSlip)
class WheelSlipAdapter(Adapter):
    """Offers the slip compliances of a `WheelSlip` to dynamic_reconfigure."""

    def __init__(self, server: Server, plugin: WheelSlip) -> None:
        super().__init__(server, plugin)
        self._reconfigure = None
        topic_name('', plugin.namespace)  # it must be a name

    def open(self) -> None:
        """Offer them; loading the library must not keep the world waiting."""
        from ..slip_reconfigure import SlipReconfigure  # noqa: PLC0415

        self._reconfigure = SlipReconfigure(self.plugin, self.server.loop.post)

    def close(self) -> None:
        """Offer them no more."""
        if self._reconfigure is not None:
            self._reconfigure.close()
        super().close()
