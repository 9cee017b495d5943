"""The topics of the server itself."""

from .clock import advertise_clock
from .performance import advertise_performance
from .state_commands import subscribe_states
from .states import advertise_states

__all__ = ['advertise_clock', 'advertise_performance', 'advertise_states', 'subscribe_states']
