"""The errors in an engineer's words."""

from __future__ import annotations

from diagnosis.errors.summary import CLEARLY, ChannelErrors, ErrorModel

COLOURS = {
    "white": "white noise of {}",
    "low": "noise of {} that is stronger at low frequencies",
    "filtered": "noise of {} without its high frequencies, as a filter leaves it",
}
FILTERED = "noise of {} that a filter weakens above {:.0f} Hz"
"""Where that shows."""


def error_lines(errors: ErrorModel) -> list[str]:
    """Sentences about the recordings' errors, the most important first."""
    found = []
    scatter = errors.scatter
    if scatter is not None and scatter.at_limit:
        found.append(
            f"{scatter.events.capitalize()} scatter by {scatter.estimate:.1%} or more, which is the most that is taken "
            "for scatter: their law may differ from the model's; check the base and the edges."
        )
    elif scatter is not None and scatter.clear:
        found.append(
            f"{scatter.events.capitalize()} repeat to {scatter.estimate:.1%} "
            f"(95 % interval {scatter.low95:.1%} to {scatter.high95:.1%})."
        )
    elif scatter is not None:
        found.append(f"No scatter of the {scatter.events} shows: at most {scatter.high95:.1%}.")
    for channel in errors.channels:
        found.append(_channel(channel))
    if errors.base_drift is not None and max(errors.base_noise) > 0.0:
        found.append(_base(errors.base_noise))
    if errors.base_drift:
        found.append(f"base_acceleration_x: its zero drifts by {errors.base_drift:.1%} of the peak, or the base tilts.")
    left = errors.inadequacy
    if not left.judged:
        found.append("No stretch is still, so noise of the sensors and errors of the model are not told apart.")
    elif left.large:
        found.append(
            f"The model leaves a smooth error {left.ratio:.1f} times the variance of the sensors' noise below 15 Hz."
        )
    return found


def _base(noise: tuple[float, ...]) -> str:
    """``noise`` (m s-2) by recording."""
    low, high = f"{min(noise):.2g}", f"{max(noise):.2g}"
    level = high if low == high else f"{low} to {high}"
    return f"base_acceleration_x: noise of {level} m s-2, that of its quietest tenth, taken to be white."


def _channel(channel: ChannelErrors) -> str:
    noise = f"{channel.noise:.2g} {channel.unit}"
    told = COLOURS[channel.colour] if channel.corner_hz is None else FILTERED
    parts = [told.format(noise, channel.corner_hz)]
    if channel.drift > CLEARLY * channel.noise:
        parts.append(f"drift of {channel.drift:.2g} {channel.unit}")
    parts += [f"hum at {line.frequency:.1f} Hz of {line.amplitude:.2g} {channel.unit}" for line in channel.hum]
    if channel.growing > CLEARLY * channel.noise:
        parts.append(f"noise that grows with the signal to {channel.growing:.2g} {channel.unit} at its peak")
    return f"{channel.channel}: {', '.join(parts)}."
