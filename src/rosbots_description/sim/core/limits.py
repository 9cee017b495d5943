"""Numbers beyond these limits are treated as mistakes.

No model needs more, and an engine's arithmetic loses precision beyond them.
"""

MAX_COORDINATE = 1e9  # [m, m/s or rad/s] nothing in a world is intended to go that far or fast
MIN_UPDATE_RATE = 0.001  # [Hz] of any rate other than 0; a lower one is a mistake
MAX_LENGTH = 1e7  # [m] of a size, or of a distance within a model
MIN_MASS, MAX_MASS = 1e-12, 1e12  # [kg]
MAX_INERTIA = 1e20  # [kg m^2]
