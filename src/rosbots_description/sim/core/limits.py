"""Beyond these limits a number is taken for a fault.

No model needs more, and the arithmetic of an engine cannot hold it beside other models.
"""

LARGEST = 1e9  # [m, m/s or rad/s] nothing in a world goes that far or fast on purpose
SLOWEST_RATE = 0.001  # [Hz] of anything that is not 0; what is rarer is a mistake
LONGEST = 1e7  # [m] a size or a distance within a model
LIGHTEST, HEAVIEST = 1e-12, 1e12  # [kg]
MOST_INERT = 1e20  # [kg m^2]
