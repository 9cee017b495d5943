"""Beyond these limits a number is taken for a fault."""

LARGEST = 1e9  # [m, m/s or rad/s] nothing in a world goes that far or fast on purpose
