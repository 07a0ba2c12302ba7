"""A figure that a notebook shows without pyplot; imported only when something is drawn."""

from __future__ import annotations

from io import BytesIO

import matplotlib.figure


class Figure(matplotlib.figure.Figure):
    """A matplotlib figure outside pyplot: nothing to close, no display needed."""

    def _repr_png_(self) -> bytes:
        image = BytesIO()
        self.savefig(image, format="png", dpi=144)
        return image.getvalue()
