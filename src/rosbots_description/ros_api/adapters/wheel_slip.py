"""What of the wheel slip plugin is on the wire: its dynamic_reconfigure server."""

from collections.abc import Callable

from ...sim.plugins import WheelSlip
from .adapter import Adapter
from .declarations import Offers
from .registry import declare_topics


def reconfigure(adapter: Adapter, _name: str) -> Callable[[], None]:
    """Offer the slip compliances; loading the library must not keep the world waiting."""
    from ..reconfigure.wheel_slip import serve_slip

    assert isinstance(adapter.plugin, WheelSlip)
    return serve_slip(adapter.plugin, adapter.server.loop.post).close


declare_topics(WheelSlip, Offers('', reconfigure))
