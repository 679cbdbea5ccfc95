"""The errors of a channel: spectrum of the residuals against the estimated one, and what whitening leaves."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from diagnosis.errors.summary import ChannelErrors
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, is_narrow, new_panels


def plot_errors(channel: ChannelErrors, *, width: float = WIDE, palette: Palette = PAPER) -> tuple[Axes, Axes]:
    """Draw the spectral density of one channel's residuals in the windows, and the autocorrelation after whitening."""
    columns = 1 if is_narrow(width) else 2
    left, right = new_panels([2.8] * (3 - columns), width, palette, columns=columns, below=0.5)
    spectrum = channel.spectrum
    frequency = np.asarray(spectrum.frequency)
    left.loglog(frequency, spectrum.found, color=palette.faint, linewidth=1.4, label="residuals")
    left.loglog(frequency, spectrum.estimated, color=palette.accent, linewidth=1.8, label="estimated errors")
    left.set_xlabel("frequency [Hz]")
    left.set_ylabel(f"density [({channel.unit})²/Hz]")
    left.legend(frameon=False)
    right.axhspan(-spectrum.bound, spectrum.bound, color=palette.faint, alpha=0.3, linewidth=0.0)
    right.vlines(spectrum.lag[1:], 0.0, spectrum.correlation[1:], color=palette.accent, linewidth=1.8)
    right.set_xlabel("lag [s]")
    right.set_ylabel("autocorrelation")
    return left, right
