"""From a plan to an overturning map in ten lines; run it in a notebook or as a script."""

from pathlib import Path

import rocking

report = rocking.run(Path(__file__).with_name("first_map.toml"))
cube = rocking.open_study(report.folder)
print(cube.rocking.overturning_map(x="aspect_ratio", y="top_mass"))

from study.figures import plot_overturning_map, save_figure  # noqa: E402

save_figure(lambda: plot_overturning_map(cube, x="aspect_ratio", y="top_mass"), report.folder / "first_map.png")
