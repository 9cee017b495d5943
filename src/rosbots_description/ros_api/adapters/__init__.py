"""Which topics stand for which plugin; importing registers the adapters."""

from . import drives  # noqa: F401
