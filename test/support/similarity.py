"""How alike two pictures are, as people see it."""

import numpy as np

WINDOW = 8  # [pixels]
C1, C2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2  # keep the quotient finite in dark or even windows


def structural_similarity(first, second):
    """Return the mean structural similarity (Wang et al., 2004) of two grey pictures, -1 to 1.

    Args:
        first: rows by columns of 0..255; second: of the same shape.
    """
    (a, b) = (_windows(picture) for picture in (first, second))
    mean_a, mean_b = a.mean(-1), b.mean(-1)
    covariance = (a * b).mean(-1) - mean_a * mean_b
    likeness = (
        (2.0 * mean_a * mean_b + C1)
        * (2.0 * covariance + C2)
        / ((mean_a**2 + mean_b**2 + C1) * (a.var(-1) + b.var(-1) + C2))
    )
    return float(likeness.mean())


def _windows(picture):
    """Return the pixels of each window of a picture, overlapping by half."""
    views = np.lib.stride_tricks.sliding_window_view(np.asarray(picture, float), (WINDOW, WINDOW))[
        :: WINDOW // 2, :: WINDOW // 2
    ]
    return views.reshape(*views.shape[:2], -1)
