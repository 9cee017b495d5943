"""Which topics stand for which plugin; importing registers the adapters."""

from . import diff_drive  # noqa: F401
